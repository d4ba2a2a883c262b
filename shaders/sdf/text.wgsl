// A text: its outlines between two faces, as `sdf_extrusion`.

#include "sdf/extrusion.wgsl"

fn sdf_text(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    return sdf_extrusion(p, a, b, data);
}

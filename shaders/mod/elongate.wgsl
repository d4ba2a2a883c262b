// Elongate: cuts the content at the origin and moves the parts apart.

#include "generated/params/ElongateParams.wgsl"

fn mod_elongate_point(p: vec3f, k: u32, q: ElongateParams) -> vec3f {
    return p - clamp(p, -q.half, q.half);
}

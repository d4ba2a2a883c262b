// Leaves of a specialized pipeline: transforms between the component's space and the leaf's own.

#include "common/lookahead.wgsl"
#include "common/scene.wgsl"
#include "sdf/op.wgsl"

// The component's rows; a specialized pipeline knows the first row of each leaf.
@group(1) @binding(3) var<uniform> rows: array<vec4f, ROW_COUNT>;

fn placed(p: vec3f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}

// The same for a leaf that is only translated.
fn placed_moved(p: vec3f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return p + vec3f(x.w, y.w, z.w);
}

// Transforms derivatives along the leaf's own axes to those of the component.
fn placed_gradient(d: vec4f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return x.xyz * d.x + y.xyz * d.y + z.xyz * d.z;
}

// The same for a leaf that is only translated.
fn placed_gradient_moved(d: vec4f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return d.xyz;
}

// Lower bound of the field of a group, or of each operand of a run; see `ParamRow` on the CPU.
// Within the bounds it is unknown.
fn placed_bounds(p: vec3f, blend_params: vec4f, center: vec4f, half: vec4f) -> f32 {
    let least = blend_params.y * length(max(abs(p - center.xyz) - half.xyz, vec3f(0.0)));
    return select(-3e38, least, least > 0.0);
}

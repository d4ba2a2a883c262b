// Leaves of a specialized pipeline: where the point stands in the leaf's own space.

#include "common/lookahead.wgsl"
#include "common/scene.wgsl"
#include "sdf/op.wgsl"

// The component's rows; a specialized pipeline knows at which of them each leaf begins.
@group(1) @binding(3) var<uniform> rows: array<vec4f, ROW_COUNT>;

fn placed(p: vec3f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return vec3f(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}

// The same where the leaf is only moved.
fn placed_moved(p: vec3f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return p + vec3f(x.w, y.w, z.w);
}

// Derivatives along the leaf's own axes, turned to those of the component.
fn placed_gradient(d: vec4f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return x.xyz * d.x + y.xyz * d.y + z.xyz * d.z;
}

// The same where the leaf is only moved.
fn placed_gradient_moved(d: vec4f, x: vec4f, y: vec4f, z: vec4f) -> vec3f {
    return d.xyz;
}

// The least that the field of a group, or of each operand of a run, can be: see `Row` on the CPU.
// Nothing is known of it within the bounds.
fn placed_bounds(p: vec3f, blend_params: vec4f, center: vec4f, half: vec4f) -> f32 {
    let least = blend_params.y * length(max(abs(p - center.xyz) - half.xyz, vec3f(0.0)));
    return select(-3e38, least, least > 0.0);
}

// Pass `mesh`: draws triangles into the shared targets. The hardware's depth buffer (reversed,
// without far plane) resolves meshes against each other, the depth target resolves them against
// fields.

#include "common/view.wgsl"
#include "common/depth.wgsl"

struct Instance {
    // Rows of the matrix from the mesh's space to world space, relative to the eye or to the point
    // that `ray_origin_depth` gives.
    eye_from_local_x: vec4f,
    eye_from_local_y: vec4f,
    eye_from_local_z: vec4f,
    // Rows of the matrix for normals.
    normal_x: vec4f,
    normal_y: vec4f,
    normal_z: vec4f,
    // Factor of the vertex colors and of their opacity.
    color: vec4f,
    // Rows of the matrix from the vertices' texture coordinates to those of the texture.
    texture_x: vec4f,
    texture_y: vec4f,
    base_color: vec3f,
    visibility: u32,
    // 1: `base_color` replaces the mesh's own colors. Their cutouts remain.
    overridden: u32,
    // 1: the transform mirrors the mesh, which reverses the order of a triangle's corners.
    mirrored: u32,
    // Fragments with less opacity are discarded.
    alpha_cutoff: f32,
    // Positions are relative to the point at this depth before the eye on the view axis; see
    // `common/ray.wgsl`.
    ray_origin_depth: f32,
}

@group(1) @binding(0) var<uniform> instance: Instance;
@group(2) @binding(0) var base_color: texture_2d<f32>;
@group(2) @binding(1) var base_sampler: sampler;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) uv: vec2f,
}

struct Varying {
    @builtin(position) clip: vec4f,
    // Relative to the point at `ray_origin_depth` before the eye.
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) uv: vec2f,
}

struct Written {
    @location(0) depth: f32,
    @location(1) visibility: u32,
    @location(2) normal: vec4f,
    @location(3) base_color: vec4f,
}

// The near limit is a distance along the ray, but the hardware clips by the depth along the view
// axis. That depth is less, toward a corner of any picture by no more than this factor. A power of
// two, so that it changes no bit of any depth.
const NEAR_SHARE: f32 = 1.0 / 16777216.0;

@vertex
fn mesh_vertex(vertex: Vertex) -> Varying {
    let p = vec4f(vertex.position, 1.0);
    let position = vec3f(
        dot(instance.eye_from_local_x, p),
        dot(instance.eye_from_local_y, p),
        dot(instance.eye_from_local_z, p),
    );
    let n = vertex.normal;
    let normal = vec3f(dot(instance.normal_x.xyz, n), dot(instance.normal_y.xyz, n), dot(instance.normal_z.xyz, n));
    // `right` and `up` span half the picture at distance 1; their squares cancel these lengths.
    let depth = dot(position, view.forward) + instance.ray_origin_depth;
    let jitter = view.jitter / vec2f(f32(view.width), f32(view.height)) * (2.0 * depth);
    let clip = vec4f(
        dot(position, view.right) / dot(view.right, view.right) - jitter.x,
        dot(position, view.up) / dot(view.up, view.up) + jitter.y,
        view.near * NEAR_SHARE,
        depth,
    );
    let uv = vec3f(vertex.uv, 1.0);
    let place = vec2f(dot(instance.texture_x.xyz, uv), dot(instance.texture_y.xyz, uv));
    return Varying(clip, position, normal, vertex.color, place);
}

// Distance from the eye to a point on a triangle. Far away, its excess over the depth along the
// view axis is small and is rounded separately.
fn mesh_distance(position: vec3f) -> f32 {
    let beyond = dot(position, view.forward);
    let aside = position - view.forward * beyond;
    let depth = instance.ray_origin_depth + beyond;
    let more = dot(aside, aside) / (depth + length(vec2f(depth, length(aside))));
    return select(length(position), depth + more, instance.ray_origin_depth > 0.0);
}

@fragment
fn mesh_fragment(in: Varying, @builtin(front_facing) front: bool) -> Written {
    let color = instance.color * in.color * textureSample(base_color, base_sampler, in.uv);
    let t = mesh_distance(in.position);
    if t < view.near || t > view.far || color.a < instance.alpha_cutoff {
        discard;
    }
    let length_of_normal = length(in.normal);
    let away = in.position + view.forward * instance.ray_origin_depth;
    var normal = select(-away / t, in.normal / max(length_of_normal, 1e-30), length_of_normal > 0.0);
    // Both sides are visible. The triangle decides which side faces the eye: near an outline the
    // interpolated normal may point away although the triangle faces the eye.
    normal = select(normal, -normal, front == (instance.mirrored == 1u));
    let shown = select(color.rgb, instance.base_color, instance.overridden == 1u);
    return Written(t, instance.visibility, vec4f(normal, 0.0), vec4f(shown, 1.0));
}

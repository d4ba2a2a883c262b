// Pass `mesh`: triangles into the shared targets. They meet each other in the hardware's depth buffer
// (reversed, without far plane) and everything else in the depth target.

#include "common/view.wgsl"
#include "common/depth.wgsl"

struct Instance {
    // Rows of world space, relative to the eye or to what `ray_origin_depth` says, from the mesh's space.
    eye_from_local_x: vec4f,
    eye_from_local_y: vec4f,
    eye_from_local_z: vec4f,
    // Rows of the matrix for normals.
    normal_x: vec4f,
    normal_y: vec4f,
    normal_z: vec4f,
    // Factor of the vertices' colors and of their opacity.
    color: vec4f,
    // Rows of the texture's coordinates from those of the vertices.
    texture_x: vec4f,
    texture_y: vec4f,
    albedo: vec3f,
    visibility: u32,
    // 1: `albedo` stands for the mesh's own colors. What these cut out stays cut out.
    overridden: u32,
    // 1: the placement turns left into right, and so the order of a triangle's corners.
    mirrored: u32,
    // Where the opacity is less, there is no surface.
    alpha_cutoff: f32,
    // Positions are relative to the point that this puts before the eye on the view axis: see `common/ray.wgsl`.
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
    // Relative to the point that `ray_origin_depth` puts before the eye.
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

// The near limit is a distance along the ray. Clipped is by the depth along the view axis, which is less, by no more than this
// toward any corner of a picture: a power of two, so that it changes no bit of any depth.
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
    // `right` and `up` are half the picture at distance 1, so their squares undo their lengths.
    let clip = vec4f(
        dot(position, view.right) / dot(view.right, view.right),
        dot(position, view.up) / dot(view.up, view.up),
        view.near * NEAR_SHARE,
        dot(position, view.forward) + instance.ray_origin_depth,
    );
    let uv = vec3f(vertex.uv, 1.0);
    let place = vec2f(dot(instance.texture_x.xyz, uv), dot(instance.texture_y.xyz, uv));
    return Varying(clip, position, normal, vertex.color, place);
}

// How far from the eye a place on a triangle is. Far off, what it is more than the depth along the view axis is little, and
// rounded for itself.
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
    // Both sides are shown. The triangle decides which one is seen: near an outline the mixed normal may
    // point away though the triangle faces the eye.
    normal = select(normal, -normal, front == (instance.mirrored == 1u));
    let albedo = select(color.rgb, instance.albedo, instance.overridden == 1u);
    return Written(t, instance.visibility, vec4f(normal, 0.0), vec4f(albedo, 1.0));
}

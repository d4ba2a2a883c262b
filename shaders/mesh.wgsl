// Pass `mesh`: draws triangles into the shared targets. The hardware's depth buffer (reversed,
// without far plane) resolves meshes against each other, the depth target resolves them against
// fields.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/mesh_look.wgsl"
#include "common/mesh_place.wgsl"
#include "common/coverage.wgsl"
#include "common/tangent.wgsl"

@group(2) @binding(0) var base_color: texture_2d<f32>;
@group(2) @binding(1) var base_sampler: sampler;
@group(2) @binding(2) var metal_rough_map: texture_2d<f32>;
@group(2) @binding(3) var metal_rough_sampler: sampler;
@group(2) @binding(4) var normal_map: texture_2d<f32>;
@group(2) @binding(5) var normal_sampler: sampler;
@group(2) @binding(6) var occlusion_map: texture_2d<f32>;
@group(2) @binding(7) var occlusion_sampler: sampler;
@group(2) @binding(8) var emissive_map: texture_2d<f32>;
@group(2) @binding(9) var emissive_sampler: sampler;

struct Vertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    // Two texture coordinates.
    @location(3) uv: vec4f,
}

struct Varying {
    @builtin(position) clip: vec4f,
    // Relative to the point at `ray_origin_depth` before the eye.
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    // In the base color texture.
    @location(3) place: vec2f,
    // Its first vertex tells a triangle from others.
    @location(6) @interpolate(flat) vertex: u32,
}

// The varying of surfaces with further textures.
struct MappedVarying {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) place: vec2f,
    @location(4) uv: vec4f,
    // In the world. The last number is the sign of the bitangent, or 0 if the file has no tangents.
    @location(5) tangent: vec4f,
    @location(6) @interpolate(flat) vertex: u32,
}

struct Written {
    @location(0) depth: f32,
    @location(1) visibility: u32,
    @location(2) normal: vec4f,
    @location(3) base_color: vec4f,
    @location(4) material: vec4u,
}

// The near limit is a distance along the ray, but the hardware clips by the depth along the view
// axis. That depth is less, toward a corner of any picture by no more than this factor. A power of
// two, so that it changes no bit of any depth.
const NEAR_SHARE: f32 = 1.0 / 16777216.0;

@vertex
fn mesh_vertex(vertex: Vertex, @builtin(vertex_index) index: u32) -> Varying {
    return mesh_placed(vertex, index);
}

@vertex
fn mesh_copy_vertex(vertex: Vertex, copy: MeshCopy, @builtin(vertex_index) index: u32) -> Varying {
    return mesh_copy_placed(vertex, copy, index);
}

fn mesh_placed(vertex: Vertex, index: u32) -> Varying {
    let position = mesh_part_place(vec4f(vertex.position, 1.0));
    let n = vertex.normal;
    let normal = vec3f(dot(instance.normal_x.xyz, n), dot(instance.normal_y.xyz, n), dot(instance.normal_z.xyz, n));
    return mesh_projected(vertex, position, normal, index);
}

fn mesh_copy_placed(vertex: Vertex, copy: MeshCopy, index: u32) -> Varying {
    let position = mesh_copy_place(copy, vec4f(vertex.position, 1.0));
    let n = vertex.normal;
    let normal = vec3f(dot(copy.normal_x.xyz, n), dot(copy.normal_y.xyz, n), dot(copy.normal_z.xyz, n));
    return mesh_projected(vertex, position, normal, index);
}

fn mesh_projected(vertex: Vertex, position: vec3f, normal: vec3f, index: u32) -> Varying {
    // `right` and `up` span half the picture at distance 1; their squares cancel these lengths.
    let depth = dot(position, view.forward) + instance.ray_origin_depth;
    let jitter = view.jitter / vec2f(f32(view.width), f32(view.height)) * (2.0 * depth);
    let clip = vec4f(
        dot(position, view.right) / dot(view.right, view.right) - jitter.x,
        dot(position, view.up) / dot(view.up, view.up) + jitter.y,
        view.near * NEAR_SHARE,
        depth,
    );
    let place = mesh_place(instance.texture_x, instance.texture_y, vertex.uv);
    return Varying(clip, position, normal, vertex.color, place, index);
}

@vertex
fn mesh_mapped_vertex(
    vertex: Vertex, @location(4) tangent: vec4f, @builtin(vertex_index) index: u32,
) -> MappedVarying {
    return mesh_mapped(mesh_placed(vertex, index), vertex, mesh_part_place(vec4f(tangent.xyz, 0.0)), tangent);
}

@vertex
fn mesh_mapped_copy_vertex(
    vertex: Vertex, @location(4) tangent: vec4f, copy: MeshCopy, @builtin(vertex_index) index: u32,
) -> MappedVarying {
    let plain = mesh_copy_placed(vertex, copy, index);
    return mesh_mapped(plain, vertex, mesh_copy_place(copy, vec4f(tangent.xyz, 0.0)), tangent);
}

fn mesh_mapped(plain: Varying, vertex: Vertex, turned: vec3f, tangent: vec4f) -> MappedVarying {
    let side = select(tangent.w, -tangent.w, instance.mirrored == 1u);
    return MappedVarying(
        plain.clip, plain.position, plain.normal, plain.color, plain.place, vertex.uv, vec4f(turned, side),
        plain.vertex,
    );
}

// The place in a texture, by the rows of its transform.
fn mesh_place(x: vec4f, y: vec4f, uv: vec4f) -> vec2f {
    let p = vec3f(select(uv.xy, uv.zw, x.w > 0.5), 1.0);
    return vec2f(dot(x.xyz, p), dot(y.xyz, p));
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
    let color = instance.color * in.color * textureSample(base_color, base_sampler, in.place);
    let surface = vec3f(instance.metalness, instance.roughness, 1.0);
    return mesh_written(in, front, color, mesh_normal(in), surface, instance.emission);
}

@fragment
fn mesh_mapped_fragment(in: MappedVarying, @builtin(front_facing) front: bool) -> Written {
    let rows = instance.map_rows;
    let color = instance.color * in.color * textureSample(base_color, base_sampler, in.place);
    let metal_rough = textureSample(metal_rough_map, metal_rough_sampler, mesh_place(rows[0], rows[1], in.uv));
    let bump_place = mesh_place(rows[2], rows[3], in.uv);
    let bump = textureSample(normal_map, normal_sampler, bump_place).xyz * 2.0 - 1.0;
    let scaled = bump * vec3f(instance.normal_scale, instance.normal_scale, 1.0);
    let occlusion = textureSample(occlusion_map, occlusion_sampler, mesh_place(rows[4], rows[5], in.uv)).x;
    let emissive = textureSample(emissive_map, emissive_sampler, mesh_place(rows[6], rows[7], in.uv)).rgb;
    let plain = Varying(in.clip, in.position, in.normal, in.color, in.place, in.vertex);
    let normal = tangent_turned(mesh_normal(plain), in.tangent, in.position, bump_place, scaled);
    let arriving = 1.0 + instance.occlusion_strength * (occlusion - 1.0);
    let surface = vec3f(instance.metalness * metal_rough.b, instance.roughness * metal_rough.g, arriving);
    return mesh_written(plain, front, color, normal, surface, instance.emission * emissive);
}

// The unit normal between the vertices.
fn mesh_normal(in: Varying) -> vec3f {
    let length_of_normal = length(in.normal);
    let away = in.position + view.forward * instance.ray_origin_depth;
    return select(-normalize(away), in.normal / max(length_of_normal, 1e-30), length_of_normal > 0.0);
}

// The opacity above which the fragment covers this sample of its pixel.
fn mesh_threshold(in: Varying) -> f32 {
    let threshold = coverage_threshold(vec2u(in.clip.xy), view.sample_index, in.vertex + coverage_hash(instance.visibility));
    return select(threshold, 0.0, view.first_surfaces == 1u);
}

// `surface` is metalness, roughness and the share of the ambient light that arrives.
fn mesh_written(
    in: Varying, front: bool, color: vec4f, upward: vec3f, surface: vec3f, emission: vec3f,
) -> Written {
    let t = mesh_distance(in.position);
    if t < view.near || t > view.far || color.a < instance.alpha_cutoff {
        discard;
    }
    if instance.blended == 1u && color.a <= mesh_threshold(in) {
        discard;
    }
    // Both sides are visible. The triangle decides which side faces the eye: near an outline the
    // interpolated normal may point away although the triangle faces the eye.
    let normal = select(upward, -upward, front == (instance.mirrored == 1u));
    var shown = select(color.rgb, instance.base_color, instance.overridden == 1u);
    var light = emission;
    if instance.unlit == 1u {
        light = shown;
        shown = vec3f(0.0);
    }
    let words = mesh_encoded(instance.material, surface, light);
    return Written(t, instance.visibility, vec4f(normal, 0.0), vec4f(shown, 1.0), words);
}

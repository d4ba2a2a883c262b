// Rays against the triangles of the meshes, from anywhere. Counterpart of `mesh_rays_hit` and
// `mesh_rays_blocked` in `src/field/mesh_rays.rs`; `src/render/resources/mesh_rays.rs` binds them.
//
// Positions are relative to the origin of the query, as everywhere in `shaders/scene`. Surfaces
// with the alpha mode BLEND let all rays pass. Those with MASK stop them everywhere: here no texture
// is read.

#include "common/ray.wgsl"

// A placed mesh.
struct RayMesh {
    // Rows of the matrix from the query's space to that of its triangles.
    local_x: vec4f,
    local_y: vec4f,
    local_z: vec4f,
    // Its first node and its first triangle, counted in words of `mesh_ray_words`.
    nodes: u32,
    triangles: u32,
    // Its number in the scene.
    index: u32,
    padding_0: u32,
}

struct MeshRayHit {
    // The far limit without a hit.
    t: f32,
    // The number of the mesh in the scene; NO_MESH for none.
    mesh: u32,
    // The number of the triangle in its mesh.
    triangle: u32,
    // Whether all meshes were searched. Otherwise the limit of visits was reached.
    complete: bool,
}

const NO_MESH: u32 = 0xffffffffu;
// Nodes that an invocation visits at most, in all its rays together: the loop limit of lavapipe
// counts over a whole invocation. `MAX_MESH_VISITS` on the CPU.
const MAX_MESH_VISITS: u32 = 12000u;
// The depth of a hierarchy is below this: `src/mesh/bvh.rs`.
const MESH_STACK: u32 = 80u;

// The placed meshes, of four words each, up to one of the number NO_MESH. Then nodes of two words:
// lower corner and link; upper corner and count. Triangles of three: corner and number; first edge,
// and 1 if it stops rays; second edge.
@group(3) @binding(3) var<storage, read> mesh_ray_words: array<vec4u>;

// Never reset.
var<private> mesh_visits: u32;
var<private> mesh_stack: array<u32, MESH_STACK>;

// The first triangle on the ray between `near` and `far`.
fn mesh_rays_hit(ray: Ray, near: f32, far: f32) -> MeshRayHit {
    return mesh_rays_search(ray, near, far, false);
}

// Whether a triangle lies on the ray between `near` and `far`.
fn mesh_rays_blocked(ray: Ray, near: f32, far: f32) -> bool {
    return mesh_rays_search(ray, near, far, true).mesh != NO_MESH;
}

// `is_any`: the first triangle found ends the search.
fn mesh_rays_search(ray: Ray, near: f32, far: f32, is_any: bool) -> MeshRayHit {
    var best = MeshRayHit(far, NO_MESH, 0u, true);
    for (var at = 0u; mesh_ray_words[at + 3u].z != NO_MESH; at += 4u) {
        best = mesh_rays_through(mesh_rays_placed(at), ray, near, best, is_any);
        if is_any && best.mesh != NO_MESH {
            break;
        }
    }
    return best;
}

fn mesh_rays_placed(at: u32) -> RayMesh {
    let last = mesh_ray_words[at + 3u];
    return RayMesh(
        bitcast<vec4f>(mesh_ray_words[at]),
        bitcast<vec4f>(mesh_ray_words[at + 1u]),
        bitcast<vec4f>(mesh_ray_words[at + 2u]),
        last.x,
        last.y,
        last.z,
        0u,
    );
}

// The search through one mesh, for what is nearer than the best hit so far.
fn mesh_rays_through(mesh: RayMesh, ray: Ray, near: f32, before: MeshRayHit, is_any: bool) -> MeshRayHit {
    var best = before;
    let p = vec4f(ray.origin, 1.0);
    let origin = vec3f(dot(mesh.local_x, p), dot(mesh.local_y, p), dot(mesh.local_z, p));
    let d = ray.direction;
    let direction = vec3f(dot(mesh.local_x.xyz, d), dot(mesh.local_y.xyz, d), dot(mesh.local_z.xyz, d));
    var open = 1u;
    mesh_stack[0] = 0u;
    while open > 0u {
        open -= 1u;
        let node = mesh_stack[open];
        mesh_visits += 1u;
        if mesh_visits > MAX_MESH_VISITS {
            best.complete = false;
            break;
        }
        let low = mesh_ray_words[mesh.nodes + 2u * node];
        let high = mesh_ray_words[mesh.nodes + 2u * node + 1u];
        let span = mesh_rays_interval(low, high, origin, direction) + ray.skipped;
        if span.x > min(span.y, best.t) || span.y < near {
            continue;
        }
        let count = high.w;
        let first = low.w;
        if count == 0u {
            // The nearer child comes off the stack first.
            let left = mesh_rays_entry(mesh, node + 1u, origin, direction);
            let right = mesh_rays_entry(mesh, first, origin, direction);
            mesh_stack[open] = select(node + 1u, first, left <= right);
            mesh_stack[open + 1u] = select(first, node + 1u, left <= right);
            open += 2u;
            continue;
        }
        for (var i = first; i < first + count; i++) {
            let at = mesh.triangles + 3u * i;
            let corner = mesh_ray_words[at];
            let along = mesh_ray_words[at + 1u];
            let t = mesh_rays_triangle(origin, direction, corner, along, mesh_ray_words[at + 2u]) + ray.skipped;
            if along.w == 1u && t >= near && t <= best.t {
                best = MeshRayHit(t, mesh.index, corner.w, best.complete);
            }
        }
        if is_any && best.mesh != NO_MESH {
            break;
        }
    }
    return best;
}

fn mesh_rays_entry(mesh: RayMesh, node: u32, origin: vec3f, direction: vec3f) -> f32 {
    let at = mesh.nodes + 2u * node;
    return mesh_rays_interval(mesh_ray_words[at], mesh_ray_words[at + 1u], origin, direction).x;
}

// Entry and exit of a ray through a box.
fn mesh_rays_interval(low: vec4u, high: vec4u, origin: vec3f, direction: vec3f) -> vec2f {
    // A zero component of the direction would yield 0 times infinity.
    let d = select(direction, vec3f(1e-18), abs(direction) < vec3f(1e-18));
    let a = (bitcast<vec3f>(low.xyz) - origin) / d;
    let b = (bitcast<vec3f>(high.xyz) - origin) / d;
    let near = min(a, b);
    let far = max(a, b);
    return vec2f(max(max(near.x, near.y), near.z), min(min(far.x, far.y), far.z));
}

// The parameter of the intersection with a triangle, from either side; below all limits without one
// (Möller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997).
fn mesh_rays_triangle(origin: vec3f, direction: vec3f, corner: vec4u, first: vec4u, second: vec4u) -> f32 {
    let ab = bitcast<vec3f>(first.xyz);
    let ac = bitcast<vec3f>(second.xyz);
    let p = cross(direction, ac);
    let determinant = dot(ab, p);
    let s = origin - bitcast<vec3f>(corner.xyz);
    let q = cross(s, ab);
    let share = 1.0 / select(determinant, 1.0, determinant == 0.0);
    let u = dot(s, p) * share;
    let v = dot(direction, q) * share;
    let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && determinant != 0.0;
    return select(-1e30, dot(ac, q) * share, is_inside);
}

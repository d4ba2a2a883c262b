// Distance from points to the triangles of the meshes that stop rays. Counterpart of
// `mesh_rays_distance` in `src/field/mesh_rays.rs`. Needs `scene/mesh_rays.wgsl`.

// Distance from `p` to the nearest triangle in meters; `within` if there is none so near.
fn mesh_near_distance(p: vec3f, within: f32) -> f32 {
    var best = within;
    for (var at = 0u; mesh_ray_words[at + 3u].z != NO_MESH; at += 4u) {
        best = mesh_near_placed(mesh_rays_placed(at), p, best);
    }
    return best;
}

// The same for one mesh. Boxes are compared in its own space, triangles in that of the query: the mesh
// may be stretched.
fn mesh_near_placed(mesh: RayMesh, p: vec3f, within: f32) -> f32 {
    let x = mesh.local_x.xyz;
    let y = mesh.local_y.xyz;
    let z = mesh.local_z.xyz;
    let from_local = mat3x3f(cross(y, z), cross(z, x), cross(x, y)) * (1.0 / dot(x, cross(y, z)));
    // Meters per unit of length, at least (Gershgorin's circles of the squared matrix).
    let mixed = abs(vec3f(dot(x, y), dot(x, z), dot(y, z)));
    let sums = vec3f(dot(x, x), dot(y, y), dot(z, z)) + mixed.xxy + mixed.yzz;
    let meters = 0.9999 * inverseSqrt(max(max(sums.x, sums.y), sums.z));
    let q = vec4f(p, 1.0);
    let local = vec3f(dot(mesh.local_x, q), dot(mesh.local_y, q), dot(mesh.local_z, q));
    var best = within;
    var open = 1u;
    mesh_stack[0] = 0u;
    while open > 0u {
        open -= 1u;
        let node = mesh_stack[open];
        mesh_visits += 1u;
        if mesh_visits > MAX_MESH_VISITS {
            break;
        }
        let at = mesh.nodes + 2u * node;
        if mesh_near_box(mesh, node, local) * meters >= best {
            continue;
        }
        let first = mesh_ray_words[at].w;
        let count = mesh_ray_words[at + 1u].w;
        if count == 0u {
            // The nearer child comes off the stack first.
            let is_left = mesh_near_box(mesh, node + 1u, local) <= mesh_near_box(mesh, first, local);
            mesh_stack[open] = select(node + 1u, first, is_left);
            mesh_stack[open + 1u] = select(first, node + 1u, is_left);
            open += 2u;
            continue;
        }
        for (var i = first; i < first + count; i++) {
            let words = mesh.triangles + 3u * i;
            let along = mesh_ray_words[words + 1u];
            let a = from_local * (bitcast<vec3f>(mesh_ray_words[words].xyz) - local);
            let ab = from_local * bitcast<vec3f>(along.xyz);
            let ac = from_local * bitcast<vec3f>(mesh_ray_words[words + 2u].xyz);
            best = select(best, min(best, mesh_near_triangle(a, ab, ac)), along.w == 1u);
        }
    }
    return best;
}

fn mesh_near_box(mesh: RayMesh, node: u32, p: vec3f) -> f32 {
    let at = mesh.nodes + 2u * node;
    let low = bitcast<vec3f>(mesh_ray_words[at].xyz);
    let high = bitcast<vec3f>(mesh_ray_words[at + 1u].xyz);
    return length(max(max(low - p, p - high), vec3f(0.0)));
}

// Distance of the origin from a triangle with this corner and these edges: to its plane if the origin is
// above the triangle, else to the nearest edge.
fn mesh_near_triangle(a: vec3f, ab: vec3f, ac: vec3f) -> f32 {
    let normal = cross(ab, ac);
    let bc = ac - ab;
    let is_above = dot(cross(normal, ab), a) <= 0.0 && dot(cross(normal, bc), a + ab) <= 0.0
        && dot(cross(ac, normal), a) <= 0.0;
    let edges = min(mesh_near_edge(a, ab), min(mesh_near_edge(a, ac), mesh_near_edge(a + ab, bc)));
    let area = length(normal);
    return select(edges, abs(dot(a, normal)) / max(area, 1e-30), is_above && area > 0.0);
}

fn mesh_near_edge(a: vec3f, along: vec3f) -> f32 {
    let share = clamp(-dot(a, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
    return length(a + along * share);
}

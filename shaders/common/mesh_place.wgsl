// The places of a mesh and of its copies.

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
    // Rows of the matrix from the vertices' texture coordinates to those of the texture. The last
    // number of the first row is 1 if it takes the second coordinates of a vertex.
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
    // Factors of the textures.
    emission: vec3f,
    // Index of the material that holds what no texture changes.
    material: u32,
    metalness: f32,
    roughness: f32,
    // Of the first two coordinates of the normals of a texture; 0 without one.
    normal_scale: f32,
    occlusion_strength: f32,
    // 1: emits its base color, and reflects nothing.
    unlit: u32,
    // 1: covers samples by its opacity.
    blended: u32,
    padding_1: u32,
    padding_2: u32,
    // Pairs of rows as `texture_x` and `texture_y`, for metalness and roughness, normals, occlusion,
    // emission.
    map_rows: array<vec4f, 8>,
}

@group(1) @binding(0) var<uniform> instance: Instance;

// A copy: rows as those of `Instance`, from the space of the mesh, to which those of the instance lead.
struct MeshCopy {
    @location(8) eye_x: vec4f,
    @location(9) eye_y: vec4f,
    @location(10) eye_z: vec4f,
    @location(11) normal_x: vec4f,
    @location(12) normal_y: vec4f,
    @location(13) normal_z: vec4f,
}

// Where a point or a direction of a part is.
fn mesh_part_place(p: vec4f) -> vec3f {
    return vec3f(
        dot(instance.eye_from_local_x, p),
        dot(instance.eye_from_local_y, p),
        dot(instance.eye_from_local_z, p),
    );
}

fn mesh_copy_place(copy: MeshCopy, p: vec4f) -> vec3f {
    let q = vec4f(mesh_part_place(p), p.w);
    return vec3f(dot(copy.eye_x, q), dot(copy.eye_y, q), dot(copy.eye_z, q));
}

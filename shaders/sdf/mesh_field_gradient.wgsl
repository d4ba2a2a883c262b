// The distance to a model with its gradient. Samples are rounded, and their interpolation has kinks at every
// voxel: the slope over a voxel and a half is smooth, as the counterpart on the CPU has it.

// Half of it, in voxels.
const MESH_FIELD_SPREAD: f32 = 0.75;

fn dual_sdf_mesh_field(p: vec3f, a: vec4f, b: vec4f, data: u32) -> vec4f {
    let step = MESH_FIELD_SPREAD * scene_row(data + 4u).w;
    var slope = vec3f(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let along = select(vec3f(0.0), vec3f(step), vec3u(0u, 1u, 2u) == vec3u(axis));
        let rise = sdf_mesh_field(p + along, a, b, data) - sdf_mesh_field(p - along, a, b, data);
        slope = select(slope, vec3f(rise / (2.0 * step)), vec3u(0u, 1u, 2u) == vec3u(axis));
    }
    // Differences over a kink may be a little longer than 1.
    return vec4f(slope / max(length(slope), 1.0), sdf_mesh_field(p, a, b, data));
}

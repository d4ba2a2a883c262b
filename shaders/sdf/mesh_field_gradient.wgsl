// The distance to a model with its gradient. Samples are rounded, and their interpolation has kinks at every
// voxel: the slope over a voxel and a half is smooth, as the counterpart on the CPU has it.

// Half of it, in voxels.
const MESH_FIELD_SPREAD: f32 = 0.75;

fn dual_sdf_mesh_field(p: vec3f, data: u32) -> vec4f {
    let step = MESH_FIELD_SPREAD * mesh_field_voxel(p, data);
    let x = vec3f(step, 0.0, 0.0);
    let y = vec3f(0.0, step, 0.0);
    let z = vec3f(0.0, 0.0, step);
    let rise = vec3f(
        sdf_mesh_field(p + x, data) - sdf_mesh_field(p - x, data),
        sdf_mesh_field(p + y, data) - sdf_mesh_field(p - y, data),
        sdf_mesh_field(p + z, data) - sdf_mesh_field(p - z, data),
    );
    let slope = rise / (2.0 * step);
    // Differences over a kink may be a little longer than 1.
    return vec4f(slope / max(length(slope), 1.0), sdf_mesh_field(p, data));
}

// The size of the voxels of the finest level that tells anything of a point, in meters.
fn mesh_field_voxel(p: vec3f, data: u32) -> f32 {
    let levels = u32(scene_row(data + 1u).x);
    var row = data + 4u;
    for (var level = 0u; level + 1u < levels; level += 1u) {
        if mesh_field_level(p, row, 1.0).y != TOLD_COARSER {
            break;
        }
        row += LEVEL_ROWS;
    }
    return scene_row(row).w;
}

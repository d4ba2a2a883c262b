// A landscape from an image: b.y columns and b.z lines of heights; see `sdf_relief` for the rest. `data` is the first row,
// behind which each height stands with its neighbours along X, see `flat::body::relief` on the CPU.
//
// Between them a quadratic B-spline (de Boor, "A practical guide to splines", 1978); beyond the border the height of the
// border.

#include "sdf/relief.wgsl"

fn sdf_heightmap(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let half = a.xz;
    let cells = (clamp(p.xz, -half, half) / max(half, vec2f(1e-9)) * 0.5 + 0.5) * b.yz;
    let cell = min(floor(cells), b.yz - 1.0);
    let t = cells - cell - 0.5;
    let along_x = vec3f(0.5 * (0.5 - t.x) * (0.5 - t.x), 0.75 - t.x * t.x, 0.5 * (0.5 + t.x) * (0.5 + t.x));
    let along_z = vec3f(0.5 * (0.5 - t.y) * (0.5 - t.y), 0.75 - t.y * t.y, 0.5 * (0.5 + t.y) * (0.5 + t.y));
    let lines = clamp(cell.y + vec3f(-1.0, 0.0, 1.0), vec3f(0.0), vec3f(b.z - 1.0));
    let rows = data + 1u + vec3u(lines * b.y + cell.x);
    let height = vec3f(
        dot(scene_row(rows.x).xyz, along_x),
        dot(scene_row(rows.y).xyz, along_x),
        dot(scene_row(rows.z).xyz, along_x),
    );
    return sdf_relief(p, a, b, dot(height, along_z));
}

// The height of a grid of `size` columns and lines at a place within the grid, in cells from its
// first corner: a quadratic B-spline (de Boor, "A practical guide to splines", 1978). `first` is
// the first row of the heights, which are stored line by line, each with its neighbors along X.
// Beyond the border, the heights of the border apply.

fn sdf_heights(place: vec2f, size: vec2f, first: u32) -> f32 {
    let cell = min(floor(place), size - 1.0);
    let t = place - cell - 0.5;
    let along_x = vec3f(0.5 * (0.5 - t.x) * (0.5 - t.x), 0.75 - t.x * t.x, 0.5 * (0.5 + t.x) * (0.5 + t.x));
    let along_z = vec3f(0.5 * (0.5 - t.y) * (0.5 - t.y), 0.75 - t.y * t.y, 0.5 * (0.5 + t.y) * (0.5 + t.y));
    let lines = clamp(cell.y + vec3f(-1.0, 0.0, 1.0), vec3f(0.0), vec3f(size.y - 1.0));
    let rows = first + vec3u(lines * size.x + cell.x);
    let height = vec3f(
        dot(scene_row(rows.x).xyz, along_x),
        dot(scene_row(rows.y).xyz, along_x),
        dot(scene_row(rows.z).xyz, along_x),
    );
    return dot(height, along_z);
}

// Pass `overlay`, editor only: blends a grid on the ground and the outline of the selection over
// the finished picture. Each has its own pipeline: lavapipe executes an `if` that no pixel takes.
//
// A coarse picture is first enlarged, so that lines over it are as thin as over a fine one.

#include "common/view.wgsl"
#include "common/depth.wgsl"
#include "common/screen.wgsl"

struct Overlay {
    // The eye in the world, turned so that the grid lies across y; x and z are reduced to one
    // coarse cell of the grid, y is its true height.
    eye: vec3f,
    // Side of a fine cell; ten of them make a coarse one.
    cell: f32,
    // Where the red X axis and the blue Z axis run in the reduced grid, if they are near.
    axis_x: f32,
    axis_z: f32,
    // Bits of `selected` before those of the meshes.
    leaf_count: u32,
    // Size of the target in pixels, the picture's or larger: width plus 65 536 times height.
    size: u32,
    // The axis across the grid; 1 for the ground.
    axis: u32,
    // Distance over which the grid loses half of its strength.
    reach: f32,
    // Share of the depth by which the grid must be nearer than a surface.
    bias: f32,
    padding: f32,
}

@group(1) @binding(0) var<uniform> overlay: Overlay;
// One bit for each entry of the subtree-extent array, then one for each mesh.
@group(1) @binding(1) var<storage, read> selected: array<u32>;
@group(2) @binding(0) var depth_target: texture_2d<f32>;
@group(2) @binding(1) var leaf_target: texture_2d<u32>;
@group(3) @binding(0) var picture: texture_2d<f32>;

@fragment
fn overlay_grid_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return overlay_grid(vec2u(at.xy));
}

@fragment
fn overlay_outline_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(1.0, 0.62, 0.2, f32(overlay_is_edge(vec2u(at.xy))));
}

@fragment
fn overlay_enlarge_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let place = overlay_place(at.xy);
    let corner = vec2i(floor(place));
    let share = place - floor(place);
    let top = mix(overlay_color(corner), overlay_color(corner + vec2i(1, 0)), share.x);
    let bottom = mix(overlay_color(corner + vec2i(0, 1)), overlay_color(corner + vec2i(1, 1)), share.x);
    return mix(top, bottom, share.y);
}

@fragment
fn overlay_coarse_outline_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return vec4f(1.0, 0.62, 0.2, overlay_coarse_edge(at.xy));
}

fn overlay_size() -> vec2f {
    return vec2f(f32(overlay.size & 0xffffu), f32(overlay.size >> 16u));
}

// Position in the picture of a point of the target; whole numbers are pixel centers.
fn overlay_place(at: vec2f) -> vec2f {
    return at * vec2f(f32(view.width), f32(view.height)) / overlay_size() - 0.5;
}

// The pixel, clamped to the picture.
fn overlay_inside(pixel: vec2i) -> vec2i {
    return clamp(pixel, vec2i(0), vec2i(i32(view.width), i32(view.height)) - 1);
}

fn overlay_color(pixel: vec2i) -> vec4f {
    return textureLoad(picture, overlay_inside(pixel), 0);
}

// Coverage of a point by the edge of the selection. The edge runs where the interpolated selection
// of the four pixels around is one half; its slope gives the distance to the edge.
fn overlay_coarse_edge(at: vec2f) -> f32 {
    let place = overlay_place(at);
    let corner = vec2i(floor(place));
    let share = place - floor(place);
    let a = f32(overlay_is_selected(overlay_inside(corner)));
    let b = f32(overlay_is_selected(overlay_inside(corner + vec2i(1, 0))));
    let c = f32(overlay_is_selected(overlay_inside(corner + vec2i(0, 1))));
    let d = f32(overlay_is_selected(overlay_inside(corner + vec2i(1, 1))));
    let selected = mix(mix(a, b, share.x), mix(c, d, share.x), share.y);
    let slope = vec2f(mix(b - a, d - c, share.y), mix(c - a, d - b, share.x));
    let per_pixel = vec2f(f32(view.width), f32(view.height)) / overlay_size();
    let distance = abs(selected - 0.5) / max(length(slope * per_pixel), 1e-6);
    return clamp(1.5 - distance, 0.0, 1.0);
}

// Whether the pixel is outside the selection and within two pixels of it.
fn overlay_is_edge(pixel: vec2u) -> bool {
    let here = overlay_is_selected(vec2i(pixel));
    var near = false;
    // A ring of radius 2 without its corners: three pixels on each of four sides. The condition
    // ends the loop early, which an `if` in the body would not.
    for (var i = 0; i < 12 && !here && !near; i += 1) {
        let along = i % 3 - 1;
        let side = 2 - 4 * (i / 3 % 2);
        near = overlay_is_selected(vec2i(pixel) + select(vec2i(side, along), vec2i(along, side), i < 6));
    }
    return near;
}

fn overlay_is_selected(pixel: vec2i) -> bool {
    if any(pixel < vec2i(0)) || pixel.x >= i32(view.width) || pixel.y >= i32(view.height) {
        return false;
    }
    let leaf = textureLoad(leaf_target, pixel, 0).x;
    if leaf == VISIBILITY_NONE {
        return false;
    }
    let index = select(leaf, (leaf & ~MESH_BIT) + overlay.leaf_count, (leaf & MESH_BIT) != 0u);
    return ((selected[index >> 5u] >> (index & 31u)) & 1u) == 1u;
}

// The vector with the axis across the grid in the place of y.
fn overlay_turned(v: vec3f) -> vec3f {
    return select(select(v.xzy, v, overlay.axis == 1u), v.yxz, overlay.axis == 0u);
}

// Lines one pixel wide on the plane y = 0, after turning. Nearer surfaces hide them; they fade
// with distance.
fn overlay_grid(pixel: vec2u) -> vec4f {
    let direction = overlay_direction(pixel);
    if direction.y * overlay.eye.y >= 0.0 {
        return vec4f(0.0);
    }
    let t = -overlay.eye.y / direction.y;
    let seen = overlay_inside(vec2i(round(overlay_place(vec2f(pixel) + 0.5))));
    if t > textureLoad(depth_target, seen, 0).x * (1.0 - overlay.bias) {
        return vec4f(0.0);
    }
    let at = overlay_ground(pixel);
    // Step on the ground from this pixel to its neighbors.
    let right = overlay_turned(view.right) * (2.0 / f32(view.width));
    let down = overlay_turned(view.up) * (-2.0 / f32(view.height));
    let width = overlay_step(pixel, right) + overlay_step(pixel, down);
    let fine = overlay_lines(at, overlay.cell, width) * 0.12;
    let coarse = overlay_lines(at, overlay.cell * 10.0, width) * 0.25;
    var color = vec3f(0.75);
    var strength = max(fine, coarse);
    let on_axis = vec2f(abs(at.y - overlay.axis_x), abs(at.x - overlay.axis_z)) < width.yx;
    if on_axis.x {
        color = select(vec3f(0.9, 0.3, 0.33), vec3f(0.45, 0.7, 0.3), overlay.axis == 0u);
        strength = 0.6;
    } else if on_axis.y {
        color = select(vec3f(0.3, 0.5, 0.95), vec3f(0.45, 0.7, 0.3), overlay.axis == 2u);
        strength = 0.6;
    }
    let fade = exp2(-t / overlay.reach);
    return vec4f(color, strength * fade);
}

// Unit direction of the ray through the center of a pixel of the target.
fn overlay_direction(pixel: vec2u) -> vec3f {
    let at = (vec2f(pixel) + 0.5) / overlay_size() * 2.0 - 1.0;
    return normalize(overlay_turned(view.right * at.x - view.up * at.y + view.forward));
}

// Where the ray of a pixel meets the plane y = 0, in the reduced grid.
fn overlay_ground(pixel: vec2u) -> vec2f {
    let direction = overlay_direction(pixel);
    let fall = select(direction.y, 1e-6, abs(direction.y) < 1e-6);
    return overlay.eye.xz - direction.xz * (overlay.eye.y / fall);
}

// Step on the ground for a `step` in the picture. Avoids the difference of two places on the
// ground, which are nearly equal in narrow pictures.
fn overlay_step(pixel: vec2u, step: vec3f) -> vec2f {
    let along = overlay_turned(view_offset(vec2f(pixel) + 0.5 - view.jitter) + view.forward);
    let falls = vec2f(along.y, along.y + step.y);
    let safe = select(falls, vec2f(1e-6), abs(falls) < vec2f(1e-6));
    return abs(step.xz * along.y - along.xz * step.y) * abs(overlay.eye.y / (safe.x * safe.y));
}

fn overlay_lines(at: vec2f, cell: f32, width: vec2f) -> f32 {
    let from_line = abs(fract(at / cell + 0.5) - 0.5) * cell;
    let line = clamp(1.5 - from_line / width, vec2f(0.0), vec2f(1.0));
    // Lines of cells smaller than a few pixels would only flicker.
    let sparse = clamp(cell / (8.0 * width) - 0.25, vec2f(0.0), vec2f(1.0));
    return max(line.x * sparse.x, line.y * sparse.y);
}

// Distance bricks of a model, see `src/bricks` for their texels. `src/field/eval/brick_field.rs` is the
// counterpart and explains the payload rows from `data` on.

const CELL_VOXELS: f32 = 14.0;
const BRICK_VOXELS: f32 = 7.0;
const BRICK_TEXELS: u32 = 32u;
// Steps of a sample in a voxel, and the greatest distance that samples hold, in voxels.
const SAMPLE_STEPS: f32 = 32.0;
const SAMPLE_REACH: f32 = 3.96875;
// From here on a level fades into the next, and from there on the next counts alone, in voxels.
const FADE_START: f32 = 1.5;
const FADE_END: f32 = 3.0;
// Places of cells without entries: those of which the next level tells as much, inside, and one more outside.
const CELL_COARSER: u32 = 0xfffffffdu;
const CELL_INSIDE: u32 = 0xfffffffeu;
// Bits of entries of bricks without samples.
const BRICK_INSIDE: u32 = 0x40000000u;
const BRICK_COARSER: u32 = 0x20000000u;
// Stands for the distance by samples where the next level tells as much.
const TOLD_COARSER: f32 = 1e9;
const LEVEL_ROWS: u32 = 3u;

fn sdf_mesh_field(p: vec3f, data: u32) -> f32 {
    let head = scene_row(data + 1u);
    let levels = u32(head.x);
    var row = data + 4u;
    var sum = 0.0;
    var rest = 1.0;
    // Of the first level that tells anything.
    var sign = 0.0;
    for (var level = 0u; level < levels; level += 1u) {
        let found = mesh_field_level(p, row, head.y);
        row += LEVEL_ROWS;
        if found.y == TOLD_COARSER {
            continue;
        }
        if sign == 0.0 {
            sign = select(1.0, -1.0, found.y < 0.0);
        }
        let fade = clamp((abs(found.y) - FADE_START) * (1.0 / (FADE_END - FADE_START)), 0.0, 1.0);
        let share = select(fade, 0.0, level + 1u == levels);
        sum += rest * (1.0 - share) * found.x;
        rest *= share;
        if rest == 0.0 {
            break;
        }
    }
    // The distance to a box around the surface is a bound, too.
    let beyond = length(max(abs(p - scene_row(data + 2u).xyz) - scene_row(data + 3u).xyz, vec3f(0.0)));
    return select(max(sum, beyond), -sum, sign < 0.0);
}

// A lower bound of the distance by the samples of a level, in meters; and what they tell, in voxels.
fn mesh_field_level(p: vec3f, row: u32, scale: f32) -> vec2f {
    let place = scene_row(row);
    let size = scene_row(row + 1u);
    let voxel = place.w;
    let at = (p - place.xyz) * (1.0 / voxel);
    let within = clamp(at, vec3f(0.0), size.xyz * CELL_VOXELS);
    let raw = mesh_field_within(within, size, u32(scene_row(row + 2u).x));
    let value = abs(raw) * voxel * scale;
    let beside = (at - within) * voxel;
    let beyond = dot(beside, beside);
    if beyond > 0.0 {
        return vec2f(sqrt(beyond + value * value), raw);
    }
    return vec2f(value, raw);
}

// What samples tell at a point within the grid, both in voxels, from the origin of the grid.
fn mesh_field_within(at: vec3f, size: vec4f, first_brick: u32) -> f32 {
    let counts = vec3u(size.xyz);
    let cell = min(vec3u(at * (1.0 / CELL_VOXELS)), counts - 1u);
    let index = cell.x + counts.x * (cell.y + counts.y * cell.z);
    let first = u32(size.w);
    let cells = counts.x * counts.y * counts.z;
    let places = bricks_texel(first + index / 4u);
    let place = places[index % 4u];
    if place >= CELL_COARSER {
        return select(select(SAMPLE_REACH, -SAMPLE_REACH, place == CELL_INSIDE), TOLD_COARSER, place == CELL_COARSER);
    }
    let inner = at - vec3f(cell) * CELL_VOXELS;
    let brick = min(vec3u(max(inner, vec3f(0.0)) * (1.0 / BRICK_VOXELS)), vec3u(1u));
    let number = brick.x + 2u * brick.y + 4u * brick.z;
    let entries = bricks_texel(first + (cells + 3u) / 4u + 2u * place + number / 4u);
    let entry = entries[number % 4u];
    if (entry >> 31u) == 0u {
        let reach = select(SAMPLE_REACH, -SAMPLE_REACH, entry == BRICK_INSIDE);
        return select(reach, TOLD_COARSER, entry == BRICK_COARSER);
    }
    let samples = first + first_brick + (entry & 0xffffffu) * BRICK_TEXELS;
    return mesh_field_samples(inner - vec3f(brick) * BRICK_VOXELS, samples);
}

// The samples of a brick, in voxels, at a point in voxels from its first one.
fn mesh_field_samples(at: vec3f, first: u32) -> f32 {
    let low = min(vec3u(max(at, vec3f(0.0))), vec3u(6u));
    let row = first + 4u * low.z;
    let after = low.y + 1u;
    let steps = mesh_field_trilinear(
        mesh_field_pair(bricks_texel(row + low.y / 2u), low.y, low.x),
        mesh_field_pair(bricks_texel(row + after / 2u), after, low.x),
        mesh_field_pair(bricks_texel(row + 4u + low.y / 2u), low.y, low.x),
        mesh_field_pair(bricks_texel(row + 4u + after / 2u), after, low.x),
        at - vec3f(low),
    );
    return (steps - 128.0) * (1.0 / SAMPLE_STEPS);
}

// Two neighbors along x out of two lines of eight samples.
fn mesh_field_pair(texel: vec4u, y: u32, x: u32) -> vec2f {
    let line = select(texel.xy, texel.zw, y % 2u == 1u);
    let next = x + 1u;
    let low = select(line.x, line.y, x >= 4u) >> (8u * (x % 4u));
    let high = select(line.x, line.y, next >= 4u) >> (8u * (next % 4u));
    return vec2f(f32(low & 0xffu), f32(high & 0xffu));
}

// Values at the corners of a cube, interpolated: pairs along x, at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
fn mesh_field_trilinear(a: vec2f, b: vec2f, c: vec2f, d: vec2f, t: vec3f) -> f32 {
    let low = vec4f(a.x, b.x, c.x, d.x);
    let along_x = low + (vec4f(a.y, b.y, c.y, d.y) - low) * t.x;
    let along_y = along_x.xz + (along_x.yw - along_x.xz) * t.y;
    return along_y.x + (along_y.y - along_y.x) * t.z;
}

// Distance bricks of a model: `src/field/eval/brick_field.rs` is the counterpart and explains the payload
// rows from `data` on, `src/bricks/mod.rs` the texels.

const CELL_VOXELS: f32 = 14.0;
const BRICK_VOXELS: f32 = 7.0;
const BRICK_TEXELS: u32 = 32u;
// Steps of a sample in a voxel, and the greatest distance that samples hold, in voxels.
const SAMPLE_STEPS: f32 = 32.0;
const SAMPLE_REACH: f32 = 4.0;

fn sdf_mesh_field(p: vec3f, a: vec4f, b: vec4f, data: u32) -> f32 {
    let place = scene_row(data + 1u);
    let size = scene_row(data + 2u);
    let voxel = place.w;
    let at = (p - place.xyz) * (1.0 / voxel);
    let within = clamp(at, vec3f(0.0), size.xyz * CELL_VOXELS);
    let value = mesh_field_within(within, size, scene_row(data + 3u), voxel);
    let beside = (at - within) * voxel;
    let beyond = dot(beside, beside);
    if beyond > 0.0 {
        return sqrt(beyond + value * value);
    }
    return value;
}

// At a point within the grid, in voxels from its origin.
fn mesh_field_within(at: vec3f, size: vec4f, coarse: vec4f, voxel: f32) -> f32 {
    let counts = vec3u(size.xyz);
    let cell = min(vec3u(at * (1.0 / CELL_VOXELS)), counts - 1u);
    let index = cell.x + counts.x * (cell.y + counts.y * cell.z);
    let first = u32(size.w);
    let corners = bricks_texel(first + index);
    let middle = mesh_field_trilinear(
        unpack2x16snorm(corners.x),
        unpack2x16snorm(corners.y),
        unpack2x16snorm(corners.z),
        unpack2x16snorm(corners.w),
        at * (1.0 / CELL_VOXELS) - vec3f(cell),
    ) * coarse.x;
    let far = abs(middle) - coarse.y;
    if far >= SAMPLE_REACH * voxel {
        return select(far, -far, middle < 0.0);
    }
    let cells = counts.x * counts.y * counts.z;
    let entries = first + cells + (cells + 3u) / 4u;
    let places = bricks_texel(first + cells + index / 4u);
    let place = places[index % 4u];
    // In voxels from the origin of the cell: each of its two bricks has seven.
    let inner = at - vec3f(cell) * CELL_VOXELS;
    let brick = vec3u(inner >= vec3f(BRICK_VOXELS));
    let number = brick.x + 2u * brick.y + 4u * brick.z;
    let pair = bricks_texel(entries + 2u * place + number / 4u);
    let entry = pair[number % 4u];
    if (entry >> 31u) == 0u {
        let least = max(f32(entry & 0xffffffu) * (1.0 / 16.0) * voxel, far);
        return select(least, -least, (entry & 0x40000000u) != 0u);
    }
    let slope = 1.0 + f32((entry >> 24u) & 0x7fu) * (1.0 / 64.0);
    let samples = first + u32(coarse.z) + (entry & 0xffffffu) * BRICK_TEXELS;
    let value = mesh_field_samples(inner - vec3f(brick) * BRICK_VOXELS, samples) * (voxel / slope);
    let depth = max(abs(value), far);
    return select(depth, -depth, value < 0.0);
}

// The samples of a brick, in voxels, at a point in voxels from its first one.
fn mesh_field_samples(at: vec3f, first: u32) -> f32 {
    let low = min(vec3u(at), vec3u(6u));
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
    let along_x = vec4f(a.x, b.x, c.x, d.x) + (vec4f(a.y, b.y, c.y, d.y) - vec4f(a.x, b.x, c.x, d.x)) * t.x;
    let along_y = along_x.xz + (along_x.yw - along_x.xz) * t.y;
    return along_y.x + (along_y.y - along_y.x) * t.z;
}

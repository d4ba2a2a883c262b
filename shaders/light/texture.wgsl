// Textures of materials. Needs `placed_textures`, `texture_sets` and `texels`. Everything is filtered by the pixel's
// footprint: images by their levels, patterns by integrals over it, or by fading out.

#include "mod/noise.wgsl"

// `src/field/flat_texture.rs` holds the counterparts of these structs; a test compares the layouts.
struct FlatTexture {
    first: vec3f,
    kind: u32,
    second: vec3f,
    image: u32,
    scale: f32,
    a: f32,
    b: f32,
    wrap: u32,
}

struct TextureSet {
    // Base color, roughness, normal, height, opacity.
    slots: array<FlatTexture, 5>,
    base_weight: f32,
    sharpness: f32,
    strength: f32,
}

struct GpuPlacedTextures {
    rows: array<vec4f, 3>,
    textures: u32,
    bump: f32,
    // 1 + the index of the instancer whose copies show it; 0 for none.
    copied_by: u32,
    // The cells of an array, counted from that of the eye.
    cells: array<vec4f, 3>,
    first: vec3f,
    skew: f32,
    last: vec3f,
    repeated: u32,
    steps: array<vec4f, 3>,
}

const TEXTURE_IMAGE: u32 = 1u;
const TEXTURE_CHECKER: u32 = 2u;
const TEXTURE_BRICKS: u32 = 3u;
const TEXTURE_NOISE: u32 = 4u;
const TEXTURE_WOOD: u32 = 5u;
// The looks of a model, in place of all textures of a material.
const TEXTURE_MODEL: u32 = 7u;
const TEXTURE_NONE: u32 = 0xffffffffu;
const TEXTURE_TILES: f32 = 256.0;
// A projection that weighs less is left out: it changes a color by less than one step of 8 bits.
const TEXTURE_LEAST_WEIGHT: f32 = 1.0 / 256.0;

// A point in the space of a texture.
struct TextureSample {
    // In tiles.
    at: vec3f,
    // Edges of the pixel's footprint on the surface.
    across: vec3f,
    along: vec3f,
    // Along the axes of the texture.
    normal: vec3f,
    // Of the three projections.
    weights: vec3f,
}

// Textures start again after `TEXTURE_TILES` tiles.
fn texture_wrapped(at: vec3f) -> vec3f {
    return at - TEXTURE_TILES * floor(at / TEXTURE_TILES + 0.5);
}

// What the copies of an array add to the place of a texture, in tiles.
fn texture_repeated(placed: GpuPlacedTextures, position: vec3f) -> vec3f {
    if placed.repeated == 0u {
        return vec3f(0.0);
    }
    let here = vec4f(position, 1.0);
    let at = vec3f(dot(placed.cells[0], here), dot(placed.cells[1], here), dot(placed.cells[2], here));
    var cell = clamp(round(at), placed.first, placed.last);
    cell.x = clamp(round(at.x - placed.skew * cell.y), placed.first.x, placed.last.x);
    return placed.steps[0].xyz * cell.x + placed.steps[1].xyz * cell.y + placed.steps[2].xyz * cell.z;
}

// Weights of the projections along the axes: powers of the normal's coordinates.
fn texture_weights(normal: vec3f, sharpness: f32) -> vec3f {
    let size = abs(normal);
    let largest = max(size.x, max(size.y, size.z));
    var weights = pow(max(size / max(largest, 1e-9), vec3f(1e-9)), vec3f(sharpness));
    weights /= weights.x + weights.y + weights.z;
    weights = max(weights - TEXTURE_LEAST_WEIGHT, vec3f(0.0));
    return weights / (weights.x + weights.y + weights.z);
}

// How much of a detail is left if this many of its periods are within the footprint: none at half as many as a pixel
// can show.
fn texture_fade(periods: f32) -> f32 {
    return 1.0 - smoothstep(0.25, 0.75, periods);
}

// Share of 1 within the width around x of a wave that is 1 for `share` of every unit, from 0 on.
fn texture_pulse(x: f32, width: f32, share: f32) -> f32 {
    let wide = max(width, 1e-3);
    let low = x - floor(x) - 0.5 * wide;
    let high = low + wide;
    let sum = (floor(high) - floor(low)) * share + min(high - floor(high), share) - min(low - floor(low), share);
    return clamp(sum / wide, 0.0, 1.0);
}

// Share of the second color of a checker, integrated over the footprint (Quilez, "Filtering procedural textures").
fn texture_checker(at: vec2f, width: vec2f) -> f32 {
    let x = 2.0 * texture_pulse(at.x, width.x, 0.5) - 1.0;
    let y = 2.0 * texture_pulse(at.y, width.y, 0.5) - 1.0;
    return 0.5 - 0.5 * x * y;
}

// Share of the mortar.
fn texture_bricks(at: vec2f, width: vec2f, row: f32, joint: f32) -> f32 {
    let line = at.y / row;
    let tall = width.y / row;
    let thick = min(joint / row, 1.0);
    let between_rows = texture_pulse(line + 0.5 * thick, tall, thick);
    let shifted = at.x + 0.5 * (floor(line) - 2.0 * floor(0.5 * floor(line)));
    let exact = texture_pulse(shifted + 0.5 * joint, width.x, joint);
    let between_bricks = mix(joint, exact, texture_fade(tall));
    return 1.0 - (1.0 - between_rows) * (1.0 - between_bricks);
}

// Layers of noise between -1 and 1; those that the footprint hides fade out.
fn texture_noise(at: vec3f, width: f32, layers: u32, seed: u32) -> f32 {
    var sum = 0.0;
    var size = 0.0;
    var height = 1.0;
    var frequency = 1.0;
    for (var layer = 0u; layer < min(layers, 10u); layer += 1u) {
        let left = texture_fade(width * frequency);
        size += height;
        if left > 0.0 {
            sum += height * left * noise_value(at * frequency, seed + layer);
        }
        height *= 0.5;
        frequency *= 2.0;
    }
    return sum / size;
}

// Share of the second color of a pattern that fills the space.
fn texture_solid(texture: FlatTexture, sample: TextureSample) -> f32 {
    let at = sample.at * texture.scale;
    let width = texture.scale * max(length(sample.across), length(sample.along));
    if texture.kind == TEXTURE_NOISE {
        return clamp(0.5 + 0.8 * texture_noise(at, width, u32(texture.a), u32(texture.b)), 0.0, 1.0);
    }
    let is_wood = texture.kind == TEXTURE_WOOD;
    let frequency = select(0.5, 0.25, is_wood);
    let wander = texture.a * texture_noise(at * frequency, width * frequency, 4u, u32(select(texture.b, 0.0, is_wood)));
    let phase = select(at.x, length(at.xy), is_wood) + wander;
    let wave = 0.5 + 0.5 * cos(6.283185307179586 * (phase - floor(phase)));
    // Rings are even; veins are thin. Each fades to its mean.
    let shown = select(wave * wave * wave * wave, wave, is_wood);
    return mix(select(0.2734375, 0.5, is_wood), shown, texture_fade(width * (1.0 + texture.a)));
}

// Word of the images.
fn texture_word(index: u32) -> u32 {
    return textureLoad(texels, vec2u(index & 4095u, index >> 12u)).x;
}

// A coordinate of a texel within the image.
fn texture_wrapped_texel(x: i32, size: i32, wrap: u32) -> i32 {
    if wrap == 2u {
        return clamp(x, 0, size - 1);
    }
    let period = select(size, 2 * size, wrap == 1u);
    let rest = x - period * i32(floor(f32(x) / f32(period)));
    return clamp(select(rest, period - 1 - rest, rest >= size), 0, size - 1);
}

// A texel of a level that begins at `first`.
fn texture_texel(first: u32, form: u32, size: vec2i, x: i32, y: i32) -> vec3f {
    let blocks = (u32(size.x) + 3u) / 4u;
    let block = (u32(y) / 4u) * blocks + u32(x) / 4u;
    let word = texture_word(first + block * 16u + (u32(y) & 3u) * 4u + (u32(x) & 3u));
    if form == 1u {
        return vec3f(bitcast<f32>(word));
    }
    let value = vec3f(f32(word & 1023u), f32((word >> 10u) & 1023u), f32((word >> 20u) & 1023u)) / 1023.0;
    return select(value, value * value, form == 0u);
}

// An image at a place in a level, interpolated between four texels.
fn texture_level(image: u32, level: u32, form: u32, finest: vec2i, at: vec2f, wrap: u32) -> vec3f {
    let size = max(finest >> vec2u(level), vec2i(1));
    let first = texture_word(image + 4u + level);
    let place = at * vec2f(size) - 0.5;
    let corner = floor(place);
    let share = place - corner;
    let x = vec2i(texture_wrapped_texel(i32(corner.x), size.x, wrap), texture_wrapped_texel(i32(corner.x) + 1, size.x, wrap));
    let y = vec2i(texture_wrapped_texel(i32(corner.y), size.y, wrap), texture_wrapped_texel(i32(corner.y) + 1, size.y, wrap));
    let upper = mix(texture_texel(first, form, size, x.x, y.x), texture_texel(first, form, size, x.y, y.x), share.x);
    let lower = mix(texture_texel(first, form, size, x.x, y.y), texture_texel(first, form, size, x.y, y.y), share.x);
    return mix(upper, lower, share.y);
}

// The looks of a model at a point, see `src/bricks/looks.rs` and `levels.rs` for their texels. Needs `bricks`.
// `src/field/light/model_look.rs` is the counterpart.

#include "common/lines.wgsl"

// Looks with their weights, summed.
struct ModelLook {
    color: vec3f,
    emission: vec3f,
    bend: vec3f,
    metalness: f32,
    roughness: f32,
    // The sum of the weights: 1 where everything around has a look.
    share: f32,
}

const MODEL_LOOK_HEADER: u32 = 8u;
const MODEL_LOOK_LEVEL: u32 = 3u;
const MODEL_LOOK_CELL: f32 = 14.0;
const MODEL_LOOK_BRICK: f32 = 7.0;
// Cells without entries have places from here on.
const MODEL_LOOK_NOWHERE: u32 = 0xfffffffdu;
// What is left to be looked up in coarser levels when it does not change a color any more.
const MODEL_LOOK_LEAST: f32 = 1.0 / 256.0;

fn model_look_texel(at: u32) -> vec4u {
    return textureLoad(bricks, vec2u(at % LINE, at / LINE));
}

// The looks at a point of the space of looks, over this width. `header` is that of the looks of the model whose first
// texel is `first`.
fn model_look(header: u32, first: u32, at: vec3f, width: f32) -> ModelLook {
    let levels = model_look_texel(header).x;
    let finest = bitcast<f32>(model_look_texel(header + 1u).w);
    let detail = min(log2(max(width * finest, 1.0)), f32(levels - 1u));
    let fine = u32(detail);
    let blur = detail - f32(fine);
    var sum = ModelLook();
    var rest = 1.0;
    for (var level = fine; level < levels; level += 1u) {
        let weight = rest * select(1.0, 1.0 - blur, level == fine);
        let row = header + 1u + MODEL_LOOK_LEVEL * level;
        let before = sum.share;
        sum = model_look_level(sum, row, first, at, weight);
        rest -= sum.share - before;
        if rest < MODEL_LOOK_LEAST {
            break;
        }
    }
    return sum;
}

// Adds what a level shows at a point. `row` is its place in the header.
fn model_look_level(before: ModelLook, row: u32, first: u32, at: vec3f, weight: f32) -> ModelLook {
    let space = bitcast<vec4f>(model_look_texel(row));
    let size = model_look_texel(row + 1u);
    let places = model_look_texel(row + 2u);
    let voxels = space.xyz + at * space.w;
    let limit = vec3f(size.xyz) * MODEL_LOOK_CELL;
    if any(voxels < vec3f(0.0)) || any(voxels > limit) {
        return before;
    }
    let low = min(floor(voxels), limit - 1.0);
    let cell = vec3u(low / MODEL_LOOK_CELL);
    let index = cell.x + size.x * (cell.y + size.y * cell.z);
    let texels = first + size.w;
    let group = model_look_texel(texels + index / 4u);
    let place = group[index % 4u];
    if place >= MODEL_LOOK_NOWHERE {
        return before;
    }
    let in_cell = low - vec3f(cell) * MODEL_LOOK_CELL;
    let brick = vec3u(in_cell / MODEL_LOOK_BRICK);
    let number = brick.x + 2u * brick.y + 4u * brick.z;
    let cells = size.x * size.y * size.z;
    let entries = model_look_texel(texels + (cells + 3u) / 4u + 2u * place + number / 4u);
    let entry = entries[number % 4u];
    if (entry >> 31u) == 0u {
        return before;
    }
    let marks = first + places.x + MODEL_LOOK_HEADER * (entry & 0xffffffu);
    let corner = vec3u(in_cell - vec3f(brick) * MODEL_LOOK_BRICK);
    return model_look_corners(before, marks, first + places.y, corner, voxels - low, weight);
}

// Adds the looks of the samples around a point of a brick, whose marks begin at `marks`. `corner` is the first of these
// samples, and `part` the place of the point between them.
fn model_look_corners(before: ModelLook, marks: u32, looks: u32, corner: vec3u, part: vec3f, weight: f32) -> ModelLook {
    var sum = before;
    let own = model_look_texel(marks + 6u).x;
    for (var i = 0u; i < 8u; i += 1u) {
        let side = vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u);
        let at = corner + side;
        let sample = at.x + 8u * at.y + 64u * at.z;
        let run = model_look_texel(marks + sample / 128u);
        let word = run[sample / 32u % 4u];
        let bit = sample % 32u;
        if (word >> bit & 1u) == 0u {
            continue;
        }
        let counts = model_look_texel(marks + 4u + sample / 256u);
        let count = counts[sample / 64u % 4u] >> (16u * (sample / 32u % 2u)) & 0xffffu;
        let index = own + count + countOneBits(word & ((1u << bit) - 1u));
        let pair = model_look_texel(looks + index / 2u);
        let shares = select(1.0 - part, part, side == vec3u(1u));
        sum = model_look_added(sum, select(pair.xy, pair.zw, index % 2u == 1u), weight * shares.x * shares.y * shares.z);
    }
    return sum;
}

// Adds the look that two words hold.
fn model_look_added(sum: ModelLook, words: vec2u, weight: f32) -> ModelLook {
    var added = sum;
    let color = model_look_linear(unpack4x8unorm(words.x).xyz);
    let light = words.x >> 24u;
    added.color += weight * color;
    if light > 0u {
        added.emission += weight * exp2((f32(light) - 128.0) / 8.0) * color;
    }
    let roots = (vec3f(vec3u(words.y, words.y >> 7u, words.y >> 14u) & vec3u(127u)) - 64.0) / 63.0;
    added.bend += weight * roots * abs(roots);
    added.roughness += weight * f32(words.y >> 22u & 63u) / 63.0;
    added.metalness += weight * f32(words.y >> 28u) / 15.0;
    added.share += weight;
    return added;
}

// Linear light of a color in sRGB (IEC 61966-2-1).
fn model_look_linear(color: vec3f) -> vec3f {
    let high = pow((color + 0.055) / 1.055, vec3f(2.4));
    return select(high, color / 12.92, color <= vec3f(0.04045));
}

// Materials of a surface: up to four, each with its weight. Counterpart of `src/field/mixture.rs`.
//
// The shade pass mixes materials, once per pixel. A material may therefore have any number of
// properties, and the fold over a component carries eight words in any case. Of more than four
// materials the mixture drops the lightest and scales the others to the whole: the error of a
// property is at most the dropped weight, as a share of the property's range.

struct Mixture {
    // Indices into the materials.
    ids: vec4u,
    // 0 for none. The sum is 1, or less if a material was dropped.
    weights: vec4f,
}

// Index beside a weight of 0.
const NO_MATERIAL: u32 = 0xffffu;
// Weights are stored as 16 bits.
const MIXTURE_WHOLE: u32 = 65535u;

fn mixture_none() -> Mixture {
    return Mixture(vec4u(NO_MATERIAL), vec4f(0.0));
}

fn mixture_of(id: u32) -> Mixture {
    return Mixture(vec4u(id, vec3u(NO_MATERIAL)), vec4f(1.0, 0.0, 0.0, 0.0));
}

// Adds `weight` to a material. A new material replaces the lightest one, if that is lighter.
fn mixture_add(mixture: Mixture, id: u32, weight: f32) -> Mixture {
    let same = mixture.ids == vec4u(id);
    let weights = mixture.weights + select(vec4f(0.0), vec4f(weight), same);
    let least = min(min(weights.x, weights.y), min(weights.z, weights.w));
    let is_new = weight > least && !any(same);
    let lightest = weights == vec4f(least);
    let x = is_new && lightest.x;
    let y = is_new && !lightest.x && lightest.y;
    let z = is_new && !lightest.x && !lightest.y && lightest.z;
    let takes = vec4<bool>(x, y, z, is_new && !x && !y && !z);
    return Mixture(select(mixture.ids, vec4u(id), takes), select(weights, vec4f(weight), takes));
}

// The mixture after a join; `weight` is that of the joining operand.
fn mixture_joined(before: Mixture, joins: Mixture, weight: f32) -> Mixture {
    var mixed = Mixture(before.ids, before.weights * (1.0 - weight));
    mixed = mixture_add(mixed, joins.ids.x, joins.weights.x * weight);
    mixed = mixture_add(mixed, joins.ids.y, joins.weights.y * weight);
    mixed = mixture_add(mixed, joins.ids.z, joins.weights.z * weight);
    return mixture_add(mixed, joins.ids.w, joins.weights.w * weight);
}

// Encoded mixture, the heaviest material first: 16 bits of weight above 16 bits of index; 0 for
// none. The weights sum to MIXTURE_WHOLE, so a surface of one material has exactly that material.
fn mixture_encoded(mixture: Mixture) -> vec4u {
    let sum = dot(mixture.weights, vec4f(1.0));
    let scaled = vec4u(round(mixture.weights * (f32(MIXTURE_WHOLE) / max(sum, 1e-30))));
    let words = select(vec4u(0u), (scaled << vec4u(16u)) | (mixture.ids & vec4u(0xffffu)), scaled > vec4u(0u));
    let low = min(words.xz, words.yw);
    let high = max(words.xz, words.yw);
    let middle = vec2u(min(high.x, high.y), max(low.x, low.y));
    let heaviest = max(high.x, high.y);
    let total = (words.x >> 16u) + (words.y >> 16u) + (words.z >> 16u) + (words.w >> 16u);
    // The heaviest material absorbs the rounding.
    let rounded = (MIXTURE_WHOLE - total) << 16u;
    return vec4u(heaviest + rounded, max(middle.x, middle.y), min(middle.x, middle.y), min(low.x, low.y));
}

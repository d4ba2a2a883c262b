// What is partly transparent covers a pixel in some samples and not in others: as many as its opacity
// says. Counterpart of `src/field/coverage.rs`.

// The opacity above which a layer covers this sample of a pixel, strictly between 0 and 1. Over the
// samples of a pixel the thresholds of a layer are evenly spread, and those of several layers are
// independent of each other (Burley, "Practical hash-based Owen scrambling", 2020).
fn coverage_threshold(pixel: vec2u, sample: u32, layer: u32) -> f32 {
    let seed = coverage_hash(pixel.x + coverage_hash(pixel.y + coverage_hash(layer)));
    let shuffled = reverseBits(coverage_scrambled(reverseBits(sample), seed));
    let value = reverseBits(coverage_scrambled(shuffled, coverage_hash(seed)));
    // Of 23 bits, so that half a step is exact.
    return (f32(value >> 9u) + 0.5) / 8388608.0;
}

// PCG (Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
fn coverage_hash(from: u32) -> u32 {
    let state = from * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A permutation in which each bit depends on the lower ones only (Laine and Karras, "Stratified
// sampling for stochastic transparency", 2011, with Burley's constants).
fn coverage_scrambled(from: u32, seed: u32) -> u32 {
    var x = from + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

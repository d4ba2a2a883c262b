// Displacement by waves.

#include "generated/params/WavesParams.wgsl"

fn mod_waves_value(f: f32, p: vec3f, q: WavesParams) -> f32 {
    let wave = sin(p * q.frequency + q.phase);
    let displaced = f + q.amplitude * wave.x * wave.y * wave.z;
    // The waves move the surface by at most the amplitude, so the field changes by at most as much.
    return clamp(displaced * q.slope, f - q.amplitude, f + q.amplitude);
}

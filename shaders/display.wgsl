// Pass `display`: the mean of accumulated samples as a picture. Runs only for frames that accumulate:
// a single sample is encoded by pass `shade`.

#include "common/view.wgsl"
#include "common/screen.wgsl"
#include "light/display.wgsl"

// Linear light and coverage, summed over the samples.
@group(1) @binding(0) var sum_target: texture_2d<f32>;

@fragment
fn display_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let mean = display_mean(vec2u(at.xy));
    return vec4f(display_encode(mean.rgb), mean.a);
}

@fragment
fn display_agx_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let mean = display_mean(vec2u(at.xy));
    return vec4f(display_encode(display_agx(mean.rgb)), mean.a);
}

@fragment
fn display_neutral_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let mean = display_mean(vec2u(at.xy));
    return vec4f(display_encode(display_neutral(mean.rgb)), mean.a);
}

// Mean light of what covers the pixel, after exposure, and its coverage. The picture holds straight
// alpha, so the light is that of the covered part.
fn display_mean(pixel: vec2u) -> vec4f {
    let sum = textureLoad(sum_target, pixel, 0);
    return vec4f(sum.rgb / max(sum.a, 1e-6) * view.exposure, sum.a / f32(view.sample_index + 1u));
}

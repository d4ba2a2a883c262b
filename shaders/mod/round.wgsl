// Round: moves the surface outward.

#include "generated/params/RoundParams.wgsl"

fn mod_round_value(f: f32, p: vec3f, q: RoundParams) -> f32 {
    return f - q.radius;
}

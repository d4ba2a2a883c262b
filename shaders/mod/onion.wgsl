// Onion: walls at the surface and inward from it.

#include "generated/params/OnionParams.wgsl"

fn detach_onion_wall(f: f32, q: OnionParams) -> f32 {
    return clamp(round(-f / q.spacing), 0.0, q.walls - 1.0);
}

fn mod_onion_value(f: f32, p: vec3f, q: OnionParams) -> f32 {
    return abs(f + detach_onion_wall(f, q) * q.spacing) - q.half;
}

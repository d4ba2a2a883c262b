// The cones of occlusion. Counterpart of `src/field/light/occlusion.rs`.

const OCCLUSION_CONES: u32 = 6u;
// What the cones are worth, in samples of rays.
const OCCLUSION_WORTH: f32 = 8.0;
// Rays of a sample of a still picture; each has a byte behind those of the cones.
const OCCLUSION_RAYS: u32 = 2u;
// In the byte of a ray, which holds its cone: nothing is in its way.
const OCCLUSION_FREE: u32 = 8u;

// Two vectors that form an orthonormal basis with a unit vector (Duff et al., "Building an
// Orthonormal Basis, Revisited", 2017).
fn occlusion_right(normal: vec3f) -> vec3f {
    let sign = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (sign + normal.z);
    return vec3f(1.0 + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a, -sign * normal.x);
}

fn occlusion_up(normal: vec3f) -> vec3f {
    let sign = select(-1.0, 1.0, normal.z >= 0.0);
    let a = -1.0 / (sign + normal.z);
    return vec3f(normal.x * normal.y * a, sign + normal.y * normal.y * a, -normal.y);
}

// How much a ray in the part of a cone is expected to tell: the deviation of what it finds, if this share is
// visible. Never 0, for cones err.
fn occlusion_doubt(share: f32) -> f32 {
    return max(sqrt(max(share * (1.0 - share), 0.0)), 0.2);
}

// How much the rays of n samples together tell, in samples: those of few are believed little and have little
// noise, those of many all, without bias.
fn occlusion_believed(n: f32) -> f32 {
    return n * n * n / (n * n + OCCLUSION_WORTH * OCCLUSION_WORTH);
}

// How much of what the ray of a sample tells is believed.
fn occlusion_trust(sample: u32) -> f32 {
    return occlusion_believed(f32(sample)) - occlusion_believed(max(f32(sample) - 1.0, 0.0));
}

// A point of the unit disc, above which lies the part of a cone in the hemisphere; from one of the unit
// square. The parts are as likely as the weights of the cones.
fn occlusion_place(cone: u32, unit: vec2f) -> vec2f {
    let is_middle = cone == 0u;
    let turn = select((f32(cone) - 1.5 + unit.y) / f32(OCCLUSION_CONES - 1u), unit.y, is_middle) * 6.2831853;
    return sqrt(select(0.25 + 0.75 * unit.x, 0.25 * unit.x, is_middle)) * vec2f(cos(turn), sin(turn));
}

// Direction (xyz) and weight of a cone of occlusion around a unit normal. Counterpart of
// `occlusion_cone` in `src/field/light/occlusion.rs`.
fn occlusion_cone(normal: vec3f, index: u32) -> vec4f {
    let angle = 6.2831853 * (f32(index) - 1.0) / f32(OCCLUSION_CONES - 1u);
    let around = occlusion_right(normal) * cos(angle) + occlusion_up(normal) * sin(angle);
    return select(vec4f(normal * 0.5 + around * 0.8660254, 0.15), vec4f(normal, 0.25), index == 0u);
}

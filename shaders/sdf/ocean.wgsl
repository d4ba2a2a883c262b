// An ocean: a heightfield of waves, each with a second harmonic. `data` is the first row, see
// `src/field/prepare/heightfield.rs`.

#include "generated/params/OceanParams.wgsl"
#include "sdf/heightfield.wgsl"

fn sdf_ocean(p: vec3f, q: OceanParams, data: u32) -> f32 {
    var height = 0.0;
    for (var wave = 0u; wave < q.waves; wave += 1u) {
        let row = scene_row(data + 1u + wave);
        let turns = dot(p.xz, row.xy) + row.w;
        height += (sdf_ocean_cosine(turns) + 0.5 * q.harmonic * sdf_ocean_cosine(2.0 * turns)) * row.z;
    }
    return sdf_heightfield(p, height, q.half, q.depth, q.top, q.slope);
}

// The cosine of a number of turns, within 1e-7: a driver's own function may be less exact. Counts
// from a quarter turn, so that the series of the sine is short.
fn sdf_ocean_cosine(turns: f32) -> f32 {
    let x = 6.2831853 * (0.25 - abs(turns - round(turns)));
    let s = x * x;
    return x * (1.0 + s * (-0.16666667 + s * (0.008333333 + s * (-0.00019841270 + s * (2.7557319e-6 + s * -2.5052108e-8)))));
}

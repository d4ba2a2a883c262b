// What a surface is like at a point.

#include "common/mixture.wgsl"

struct Surface {
    distance: f32,
    // The leaf that outweighs the others at each blend: entry of the subtree-extent array.
    leaf: u32,
    // Of the field: not of unit length where space is stretched.
    gradient: vec3f,
    // By the blends' weights.
    materials: Mixture,
}

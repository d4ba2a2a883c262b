// Attributes of a surface at a point.

#include "common/mixture.wgsl"

struct Surface {
    distance: f32,
    // The leaf that outweighs the others at each blend, as entry of the subtree-extent array.
    leaf: u32,
    // Gradient of the field; not of unit length where space is stretched.
    gradient: vec3f,
    // Mixed by the weights of the blends.
    materials: Mixture,
}

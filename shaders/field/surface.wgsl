// What a surface is like at a point.

struct Surface {
    distance: f32,
    // The leaf that outweighs the others at each blend: entry of the subtree-extent array.
    leaf: u32,
    // Of the field: not of unit length where space is stretched.
    gradient: vec3f,
    // Albedo and specular, emission and shininess: mixed by the blends' weights.
    diffuse: vec4f,
    emission: vec4f,
}

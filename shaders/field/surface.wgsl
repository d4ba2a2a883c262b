// What a surface is made of, mixed along the fold by the joints' weights.

struct Surface {
    distance: f32,
    leaf: u32,
    albedo: vec3f,
    specular: f32,
    emission: vec3f,
    shininess: f32,
}

// A leaf with the material of its node.
fn surface_leaf(at: u32, distance: f32) -> Surface {
    let m = materials[nodes[at].material];
    return Surface(distance, at, m.albedo, m.specular, m.emission, m.shininess);
}

// `joined` is an operator's value and the weight of `operand`. The leaf is that of the heavier one.
fn surface_join(so_far: Surface, operand: Surface, joined: vec2f) -> Surface {
    let w = joined.y;
    return Surface(
        joined.x,
        select(so_far.leaf, operand.leaf, w > 0.5),
        mix(so_far.albedo, operand.albedo, w),
        mix(so_far.specular, operand.specular, w),
        mix(so_far.emission, operand.emission, w),
        mix(so_far.shininess, operand.shininess, w),
    );
}

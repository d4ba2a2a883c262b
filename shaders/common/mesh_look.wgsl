// What the mesh pass stores of a pixel's material, in the target that holds mixtures where fields
// are: the index of the material, metalness and roughness, emission, and the share of the ambient
// light that arrives. The base color is in a target of its own.

// `surface` is metalness, roughness and the share of the ambient light.
fn mesh_encoded(material: u32, surface: vec3f, emission: vec3f) -> vec4u {
    let most = min(emission, vec3f(65504.0));
    let last = pack2x16float(vec2f(most.z, surface.z));
    return vec4u(material, pack2x16unorm(surface.xy), pack2x16float(most.xy), last);
}

fn mesh_encoded_surface(words: vec4u) -> vec3f {
    return vec3f(unpack2x16unorm(words.y), unpack2x16float(words.w).y);
}

fn mesh_encoded_emission(words: vec4u) -> vec3f {
    return vec3f(unpack2x16float(words.z), unpack2x16float(words.w).x);
}

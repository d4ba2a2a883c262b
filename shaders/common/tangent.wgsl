// Textures of normals. Counterpart of `TriangleMesh::mapped_normal` in `src/mesh/triangle_mesh.rs`.

// The normal turned by that of a texture. The tangent is the file's, or the direction in which the
// texture's first coordinate grows along the triangle; V points down.
fn tangent_turned(normal: vec3f, given: vec4f, position: vec3f, place: vec2f, bump: vec3f) -> vec3f {
    let right = dpdx(position);
    let below = dpdy(position);
    let place_right = dpdx(place);
    let place_below = dpdy(place);
    let area = place_right.x * place_below.y - place_right.y * place_below.x;
    let across = (right * place_below.y - below * place_right.y) * sign(area);
    let upward = (right * place_below.x - below * place_right.x) * sign(area);
    var tangent = across - normal * dot(normal, across);
    var side = select(1.0, -1.0, dot(cross(normal, tangent), upward) < 0.0);
    if given.w != 0.0 {
        tangent = given.xyz;
        side = sign(given.w);
    }
    let longness = length(tangent);
    tangent /= max(longness, 1e-30);
    let bitangent = cross(normal, tangent) * side;
    let turned = tangent * bump.x + bitangent * bump.y + normal * bump.z;
    let is_turned = longness > 0.0 && dot(turned, turned) > 0.0;
    return select(normal, turned / max(length(turned), 1e-30), is_turned);
}

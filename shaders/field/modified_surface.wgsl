// Surfaces of the content of modifiers.

// The surface of a copy of a modifier's content, as seen from outside the modifier.
fn surface_of_copy(modifier: u32, copy: u32, local: vec3f, row: u32, content: Surface) -> Surface {
    let scale = modifier_scale(modifier, copy, row);
    var seen = content;
    seen.distance *= scale;
    seen.gradient = modifier_pull(modifier, local, copy, content.gradient, row) * scale;
    return seen;
}

// Applies the modifier to the surface of the nearest copy.
fn surface_modified(modifier: u32, params: u32, local: vec3f, content: Surface) -> Surface {
    let slopes = modifier_slopes(modifier, content.distance, local, params + MODIFIER_ROWS);
    let d = content.gradient * slopes.w + slopes.xyz;
    let scale = scene_row(params + 1u).w;
    var seen = content;
    seen.distance = modifier_value(modifier, content.distance, local, params + MODIFIER_ROWS) * scale;
    seen.gradient = scale
        * (scene_row(params + 3u).xyz * d.x + scene_row(params + 4u).xyz * d.y + scene_row(params + 5u).xyz * d.z);
    return seen;
}

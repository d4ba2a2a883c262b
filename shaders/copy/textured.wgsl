// Textures that copies carry with them. Needs `copied` and the pixel, `mixture_pixel`.

#include "copy/space.wgsl"
#include "copy/copied.wgsl"

// The copy that the pixel shows; `index` is that of its instancer.
fn textured_copy(index: u32) -> Copy {
    instancer_at = index;
    return copy_at(copied[copied_place(mixture_pixel)].xyz, COPY_OF_ANY);
}

fn textured_copied_direction(copy: Copy, d: vec3f) -> vec3f {
    return copy_local_direction(copy, instancer_local_direction(d));
}

// The point in the space of the copy.
fn textured_copied(copy: Copy, point: TexturedPoint) -> TexturedPoint {
    return TexturedPoint(
        copy_local_point(copy, instancer_local_point(point.position)),
        normalize(textured_copied_direction(copy, point.normal)),
        textured_copied_direction(copy, point.across),
        textured_copied_direction(copy, point.along),
    );
}

// A bend in the space of the copy, in the world. `normal` is the normal in that space.
fn textured_world_bend(copy: Copy, bend: vec3f, normal: vec3f) -> vec3f {
    return copy_world_gradient(copy, bend) / length(copy_world_gradient(copy, normal));
}

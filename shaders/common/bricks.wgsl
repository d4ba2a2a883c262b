// The texels of distance bricks, see `src/bricks/mod.rs`. A storage texture, like `params`.

#include "common/scene.wgsl"

@group(1) @binding(5) var bricks: texture_storage_2d<rgba32uint, read>;

fn bricks_texel(at: u32) -> vec4u {
    return textureLoad(bricks, vec2u(at % LINE, at / LINE));
}

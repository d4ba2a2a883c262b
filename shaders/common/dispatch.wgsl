// The dispatch, in passes that do not query the whole scene.

#include "common/dispatch_params.wgsl"

@group(3) @binding(0) var<uniform> dispatch: DispatchParams;

// Pixels along a side of a tile, the area of one invocation of the cone pass.
const TILE: u32 = 8u;

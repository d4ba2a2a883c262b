// Parameters of a dispatch: the component, the part of the picture, the limit of steps.

struct DispatchParams {
    // Upper left pixel.
    origin: vec2u,
    // First pixel outside.
    end: vec2u,
    component: u32,
    // Steps that an invocation may take in this dispatch.
    max_steps: u32,
    // 0 begins a march, later relaunches continue it.
    relaunch: u32,
    // 1 in the last relaunch, which counts unfinished rays.
    last_relaunch: u32,
    // Index of the list of subtiles, see `common/subtiles.wgsl`.
    list: u32,
    // First of its subtiles in `subtiles`.
    first_subtile: u32,
    // 1: continues the unfinished rays, compacted. 0: all pixels of the subtiles.
    compacted: u32,
    // First of the unfinished rays in `rays`.
    rays: u32,
    // Start of the lists of subtiles with hits in `subtiles`.
    hits: u32,
    // Cells of an instancer that an invocation may look at in this dispatch.
    max_cells: u32,
    // Where rays from the eye begin to see the component, and where they cease to.
    near: f32,
    far: f32,
    // Width of a pixel at distance 1 by which the accepted error of a hit is measured.
    footprint: f32,
    // Steps that a ray may take through one copy.
    copy_steps: u32,
    // Pixels from one ray to the next, where not all pixels have rays: see `resolution.wgsl`.
    spacing: u32,
    padding_1: u32,
}

//! The parameters of modifiers as their functions read them, on the CPU and on the GPU: what `modify` derives from those
//! of the artist (`scene/modifier.rs`). `modifier_table` says which kind has which.

use isolith_scene::{EvalParams, eval_params};

/// The parameters in rows of four numbers.
pub(super) fn params_of<P: EvalParams, N: Copy + Into<f64>>(rows: &[[N; 4]]) -> P {
    P::read(|at| rows[at / 4][at % 4].into())
}

/// Writes parameters into their rows.
pub(super) fn write_params(params: &impl EvalParams, rows: &mut [[f32; 4]]) {
    params.write(|at, number| rows[at / 4][at % 4] = number as f32);
}

eval_params! {
    /// Of kinds that are written as copies, and have no function.
    NoParams {}
}

eval_params! {
    /// Copies at equal distances.
    RepeatParams {
        /// From one cell to the next.
        spacing: [f64; 3],
        /// Turn per cell, in radians.
        turn: f64,
        /// The first cell along each axis.
        first: [f64; 3],
        /// Flags of the axes along which every other cell is mirrored: 1, 2, 4.
        mirrored: u32,
        /// The last cell along each axis.
        last: [f64; 3],
        /// The number of cells to evaluate along each axis, as one number to the base of 128.
        candidates: u32,
        /// The center of the content in its cell.
        middle: [f64; 3],
        /// The least slope of the content's field outside its bounds.
        slope: f64,
        /// Half the extent of the content.
        half: [f64; 3],
        /// Shifts: of X by the cell along Y, of Y and Z by the cell along X.
        offset: [f64; 3],
        /// The first cell of the omitted block.
        carve_from: [f64; 3],
        /// The cell after its last.
        carve_to: [f64; 3],
        /// The lower corner of the bounds of all copies.
        least: [f64; 3],
        /// The upper corner.
        greatest: [f64; 3],
    }
}

eval_params! {
    /// Copies of copies.
    RecursionParams {
        /// Where the next copy stands.
        offset: [f64; 3],
        /// Its size.
        scale: f64,
        /// The first row of its inverse rotation.
        inverse_x: [f64; 3],
        /// The number of copies.
        count: u32,
        /// The second row.
        inverse_y: [f64; 3],
        /// Flags of mirrored axes (1, 2, 4), and of those where the copy is on the lower side (8, 16, 32).
        mirrored: u32,
        /// The third row.
        inverse_z: [f64; 3],
        /// The center of the content.
        center: [f64; 3],
        /// The least slope of the content's field outside its bounds.
        slope: f64,
        /// Half the extent of the content.
        half: [f64; 3],
    }
}

eval_params! {
    /// A rotation around Y that grows with height.
    TwistParams {
        /// Radians per meter.
        rate: f64,
        /// One over the largest stretch.
        slope: f64,
        /// The radius of the content around the axis.
        radius: f64,
        /// How far around the bounds the field describes the content.
        margin: f64,
        /// The middle of the content along Y.
        center: f64,
        /// Half its height.
        half: f64,
    }
}

eval_params! {
    /// The X axis as an arc around a point on Y.
    BendParams {
        /// Of the arc.
        radius: f64,
        /// One over the largest stretch.
        slope: f64,
        /// How far around the bounds the field describes the content.
        margin: f64,
        /// Where its center is: 1 above, -1 below.
        side: f64,
        /// Half the angle that the content takes.
        reach: f64,
        /// How far the content is away from the center of the arc, at least: its lower height.
        low: f64,
        /// Its upper height, toward the center.
        high: f64,
        /// The center of the bounds.
        center: [f64; 3],
        /// Half their extent.
        half: [f64; 3],
    }
}

eval_params! {
    /// A width that changes with height.
    TaperParams {
        /// Change of the width per meter.
        rate: f64,
        /// One over the largest stretch.
        slope: f64,
        /// How far around the bounds the field describes the content.
        margin: f64,
        /// The center of the bounds.
        center: [f64; 3],
        /// The least height of the content.
        low: f64,
        /// Half the extent of the bounds.
        half: [f64; 3],
        /// The greatest height of the content.
        high: f64,
    }
}

eval_params! {
    /// Parts moved away from the origin.
    ElongateParams {
        /// Half the way by which they are moved apart.
        half: [f64; 3],
    }
}

eval_params! {
    /// A surface moved outward.
    RoundParams {
        /// How far.
        radius: f64,
    }
}

eval_params! {
    /// Walls at the surface and inward from it.
    OnionParams {
        /// Half the thickness of a wall.
        half: f64,
        /// The number of walls.
        walls: f64,
        /// From one wall to the next.
        spacing: f64,
    }
}

eval_params! {
    /// Displacement by waves.
    WavesParams {
        /// Greatest displacement.
        amplitude: f64,
        /// Radians per meter.
        frequency: f64,
        /// In radians.
        phase: f64,
        /// One over the largest slope.
        slope: f64,
    }
}

eval_params! {
    /// Displacement by layers of noise.
    NoiseParams {
        /// Of the first layer.
        amplitude: f64,
        /// One over the size of its cells.
        frequency: f64,
        /// The number of layers.
        layers: u32,
        /// Another number, another noise.
        seed: u32,
        /// One over the largest slope.
        slope: f64,
        /// Greatest displacement by all layers.
        reach: f64,
    }
}

eval_params! {
    /// Displacement by the heights of an image.
    DisplacementParams {
        /// Tiles per meter along its width and its length.
        tiles: [f64; 2],
        /// Columns and lines of heights in a tile.
        cells: [f64; 2],
        /// One over the largest slope.
        slope: f64,
        /// The least height.
        least: f64,
        /// The greatest height.
        greatest: f64,
        /// The axis of projection.
        axis: u32,
    }
}

/// Calls `$callback!` with the names of the parameters of all modifiers that have some, in the order of their kinds.
#[macro_export]
macro_rules! for_each_modifier_params {
    ($callback:ident) => {
        $callback! {
            RepeatParams RecursionParams TwistParams BendParams TaperParams ElongateParams RoundParams OnionParams
            WavesParams NoiseParams DisplacementParams
        }
    };
}

//! Compiles every shader of the program with a graphics card's compiler, without the card.
//!
//! Mesa's RADV has a null device: it compiles for any AMD generation and reports for each pipeline its registers,
//! spills, waves per SIMD and minimum run time. wgpu cannot open that device, so this package calls Vulkan itself. It
//! is a separate package because that needs `unsafe`, which the others forbid.
//!
//! | module | content |
//! |---|---|
//! | `subjects` | every pipeline that the renderer builds for the example scenes |
//! | `spirv` | WGSL to SPIR-V, with the options of wgpu |
//! | `cards` | the cards, and a process for each: the driver reads its environment once |
//! | `vulkan` | the only `unsafe` code: compiles pipelines and reads their statistics |
//! | `gate` | limits and their exceptions |
//! | `table` | the tables of `benches/README.md` |

pub mod cards;
pub mod gate;
pub mod spirv;
pub mod subjects;
pub mod table;
pub mod vulkan;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Reasons for a failed measurement.
#[derive(Clone, Debug, Error)]
pub enum Error {
    /// No driver knows the card.
    #[error(
        "Mesa's driver for AMD graphics cards (RADV) is missing: {0}. It compiles without a card. On Debian or Ubuntu \
         `apt-get install mesa-vulkan-drivers libvulkan1` installs it, on Fedora `dnf install mesa-vulkan-drivers \
         vulkan-loader`, on Arch `pacman -S vulkan-radeon vulkan-icd-loader`"
    )]
    NoDriver(String),
    /// A shader is invalid, or the driver refuses it.
    #[error("{what}: {reason}")]
    Refused {
        /// The pipeline.
        what: String,
        /// The error message.
        reason: String,
    },
    /// An error of a card's process, or of a file between it and this one.
    #[error("{0}")]
    Process(String),
}

/// The driver's statistics for one stage of a pipeline.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The driver's name of the stage.
    pub stage: String,
    /// The figures.
    pub metrics: StageMetrics,
}

/// The driver's figures for a stage, or the worst of several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageMetrics {
    /// Vector registers per lane.
    pub vgprs: u64,
    /// Scalar registers per wave.
    pub sgprs: u64,
    /// Vector registers spilled to memory.
    pub spilled_vgprs: u64,
    /// Scalar registers spilled to lanes of vector registers, which takes an instruction each way.
    pub spilled_sgprs: u64,
    /// Bytes of memory per wave for spills and for indexed arrays.
    pub scratch: u64,
    /// Waves that a SIMD holds at once: few waves cannot hide the latency of memory.
    pub waves: u64,
    /// Cycles per wave if everything else is hidden, by the driver's estimate. It counts loop bodies once, times ten.
    pub inverse_throughput: u64,
    /// Bytes of machine code.
    pub code_size: u64,
    /// Compile time of the whole pipeline; of several, the sum.
    pub compile_ms: f64,
}

//! What the compiler of a graphics card makes of every shader of the program, without the card.
//!
//! Mesa's RADV has a null device: it compiles for any AMD generation, and tells of each pipeline how many registers it
//! takes, what spills, how many waves fit a SIMD and how long it takes at best. wgpu cannot open that device, so this
//! package speaks to Vulkan itself, and is a package of its own because that needs `unsafe`, which the others forbid.
//!
//! | module | what it does |
//! |---|---|
//! | `subjects` | every pipeline that the renderer builds for the example scenes |
//! | `spirv` | WGSL to SPIR-V, with the options of wgpu |
//! | `cards` | the cards, and a process for each: the driver reads its environment once |
//! | `vulkan` | the only `unsafe` code: compiles pipelines and reads their statistics |
//! | `gate` | limits, and the exceptions from them |
//! | `table` | the tables of `benches/README.md` |

pub mod cards;
pub mod gate;
pub mod spirv;
pub mod subjects;
pub mod table;
pub mod vulkan;

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why nothing was measured.
#[derive(Clone, Debug, Error)]
pub enum Error {
    /// There is no driver that knows the card.
    #[error(
        "Mesa's driver for AMD graphics cards (RADV) is missing: {0}. It compiles without a card. On Debian or Ubuntu \
         `apt-get install mesa-vulkan-drivers libvulkan1` installs it, on Fedora `dnf install mesa-vulkan-drivers \
         vulkan-loader`, on Arch `pacman -S vulkan-radeon vulkan-icd-loader`"
    )]
    NoDriver(String),
    /// A shader is not valid, or the driver refuses it.
    #[error("{what}: {reason}")]
    Refused {
        /// Which pipeline.
        what: String,
        /// What is said against it.
        reason: String,
    },
    /// The process for a card, or a file between it and this one.
    #[error("{0}")]
    Process(String),
}

/// What the driver says of one stage of a pipeline.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Statistics {
    /// The stage, as the driver calls it.
    pub stage: String,
    /// Vector registers of each lane.
    pub vgprs: u64,
    /// Scalar registers of each wave.
    pub sgprs: u64,
    /// Vector registers that are kept in memory because there are too few.
    pub spilled_vgprs: u64,
    /// Scalar registers that are kept in lanes of vector registers, which takes an instruction each way.
    pub spilled_sgprs: u64,
    /// Bytes of memory of each wave for what is spilled, and for arrays that are indexed.
    pub scratch: u64,
    /// Waves that a SIMD keeps at once: with few of them nothing hides that memory is slow.
    pub waves: u64,
    /// Cycles per wave where everything else is hidden, by the driver's estimate. Bodies of loops count once, by ten.
    pub inverse_throughput: u64,
    /// Bytes of machine code.
    pub code_size: u64,
    /// What the driver took to compile the whole pipeline.
    pub compile_ms: f64,
}

//! Errors of the GPU.

use thiserror::Error;

/// Why a device is missing or unusable.
#[derive(Clone, Debug, Error)]
pub enum GpuError {
    /// No driver responds.
    #[error(
        "no graphics driver answers. On Debian or Ubuntu, `apt-get install mesa-vulkan-drivers` installs one that \
         needs no graphics card"
    )]
    NoAdapter,
    /// No adapter has the requested name.
    #[error("no graphics adapter is called \"{wanted}\"; there is {found}")]
    NoSuchAdapter {
        /// The requested name.
        wanted: String,
        /// The names of the adapters that exist.
        found: String,
    },
    /// The driver refuses to open a device.
    #[error("the graphics driver {adapter} gives no device: {reason}")]
    NoDevice {
        /// The driver.
        adapter: String,
        /// Its reason.
        reason: String,
    },
    /// The device is gone.
    #[error("the graphics device was lost: {0}")]
    Lost(String),
    /// The device works but refused a command, because of a fault of the program or too little memory.
    #[error("the graphics driver refused a command: {0}")]
    Refused(String),
}

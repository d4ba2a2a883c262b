//! Why the GPU does not serve.

use thiserror::Error;

/// Why there is no device, or no more.
#[derive(Clone, Debug, Error)]
pub enum GpuError {
    /// No driver answers.
    #[error(
        "no graphics driver answers. On Debian or Ubuntu, `apt-get install mesa-vulkan-drivers` installs one that \
         needs no graphics card"
    )]
    NoAdapter,
    /// No adapter has the name that was asked for.
    #[error("no graphics adapter is called \"{wanted}\"; there is {found}")]
    NoSuchAdapter {
        /// What was asked for.
        wanted: String,
        /// What there is.
        found: String,
    },
    /// The driver refuses a device.
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
    /// The device works and refused something: a fault of the program, or too little memory.
    #[error("the graphics driver refused a command: {0}")]
    Refused(String),
}

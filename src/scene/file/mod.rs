//! Scene files: versioned JSON with a flat table of nodes.
//!
//! | file | holds |
//! |---|---|
//! | `animation` | the keys of parameters, as types for serde |
//! | `format` | the types of the present version, for serde and the schema |
//! | `list` | lists, bounded while they grow |
//! | `old_version` | what older versions have different, and its conversion |
//! | `read` | bytes → checked scene; every message names file, node and field |
//! | `watch` | progress and cancellation of reading |
//! | `weight` | counts the values of a text before it is parsed |
//! | `place` | finds name and id of the node at which reading failed |
//! | `write` | scene → bytes, always the same, one value per line |
//! | `atomic` | bytes → file, so that a crash leaves the old file or the new one |
//!
//! The reader parses the version first and alone. What a later version changes becomes a type in `old_version` with a
//! conversion; readers are never removed.

mod animation;
mod atomic;
mod error;
mod format;
mod list;
mod old_version;
mod place;
mod read;
mod watch;
mod weight;
mod write;

pub use atomic::{
    KEPT_BACKUPS, Stamp, WriteError, WriteStep, attachment, backup_path, check_writable, create_private_folder,
    is_same_place, keep_records_in, load, load_stamped, random_name, remove_leftovers, replace, save, save_stamped,
};
pub use error::FileError;
pub use format::{VERSION, schema};
pub use read::parse;
pub use write::to_json;

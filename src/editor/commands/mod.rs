//! Everything that the artist can order: it feeds the menus, the toolbar, the shortcuts and the palette.
//!
//! | file | holds |
//! |---|---|
//! | `command` | the commands by name |
//! | `table`, `info` | label, keys, menu and condition of each; its rows are in `file`, `edit`, `add` and `view` |
//! | `run` | what they do |
//! | `entries`, `shortcuts` | commands in menus and by keys |

mod add;
pub mod command;
mod edit;
pub mod entries;
mod file;
pub mod info;
mod run;
mod shortcuts;
mod table;
mod view;

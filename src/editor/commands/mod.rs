//! All commands of the artist. They feed the menus, the toolbar, the shortcuts and the command palette.
//!
//! | file | holds |
//! |---|---|
//! | `command` | the names of the commands |
//! | `table`, `info` | label, keys, menu and condition of each; its rows are in `file`, `edit`, `arrange`, `tools`, `add`, `view` and `help` |
//! | `run` | their effects |
//! | `entries`, `shortcuts` | commands in menus and by keys |

mod add;
mod arrange;
pub mod command;
mod edit;
pub mod entries;
mod file;
mod help;
pub mod info;
mod run;
mod shortcuts;
mod table;
mod tools;
mod view;

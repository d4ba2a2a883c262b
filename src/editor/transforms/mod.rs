//! Moves, rotates and scales the selection, by the gizmo or by keys.
//!
//! | file | holds |
//! |---|---|
//! | `kinds` | what is done, along which axes, in which tool |
//! | `starts` | the nodes at the start, and the effect of a motion on them |
//! | `onto_surface` | moving onto the surface under the pointer |
//! | `typed` | numbers typed meanwhile |
//! | `transform_drag` | the pointer's way or the typed numbers as a motion |
//! | `modal` | the keys after G, R or S |
//! | `transform_bar` | the bar of tools over the picture |

pub mod kinds;
pub mod modal;
pub mod onto_surface;
pub mod starts;
pub mod transform_bar;
pub mod transform_drag;
mod typed;

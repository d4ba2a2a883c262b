//! Handles on the selected node in the viewport: a dot for each length, angle and point that can be dragged.
//!
//! | file | holds |
//! |---|---|
//! | `measures` | the values of a node, and the directions of the view, that rows are computed from |
//! | `grip` | how a handle moves and which value a ray stands for |
//! | `rows` | a row of the tables, and the ways to drag |
//! | `kind_rows`, `shape_rows` | the tables: one row for each parameter with a handle; that of shapes |
//! | `value_handle` | the handles of the selected node on the screen |
//! | `value_drag` | a drag of one of them |
//! | `handle_paint` | dots, guides and the value beside the pointer |
//! | `guides` | the outlines of what has no surface: cones of lights, frames of cameras, curves |

pub mod grip;
mod guides;
pub mod handle_paint;
mod kind_rows;
mod measures;
mod rows;
mod shape_rows;
pub mod value_drag;
pub mod value_handle;

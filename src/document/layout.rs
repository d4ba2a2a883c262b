//! The layout of a window's panels, as the preferences keep it.

use serde::{Deserialize, Serialize};

/// Most panels and splits of a layout; a larger one is not ours.
pub const MAX_LAYOUT_PARTS: usize = 200;

/// A part of the window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Docked {
    /// Panels behind each other.
    Tabs {
        /// Their ids, from left to right.
        panels: Vec<String>,
        /// The one in front.
        front: Option<String>,
    },
    /// Parts beside each other.
    Row(Vec<DockedPart>),
    /// Parts below each other.
    Column(Vec<DockedPart>),
}

/// A part of a row or a column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DockedPart {
    /// Its width in a row or height in a column, in points. The part with the viewport takes what the others leave.
    pub size: f32,
    /// Its content.
    pub part: Docked,
}

/// The layout of all panels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PanelLayout {
    /// The window.
    pub root: Docked,
    /// The ids of the panels that are closed; they keep their place.
    #[serde(default)]
    pub closed: Vec<String>,
}

impl PanelLayout {
    /// Whether it can be a layout: sizes are finite, and it is not too large.
    pub fn is_sound(&self) -> bool {
        let mut count = 0;
        is_sound(&self.root, &mut count) && self.closed.len() <= MAX_LAYOUT_PARTS
    }
}

fn is_sound(part: &Docked, count: &mut usize) -> bool {
    *count += 1;
    match part {
        Docked::Tabs { panels, .. } => {
            *count += panels.len();
            *count <= MAX_LAYOUT_PARTS
        }
        Docked::Row(parts) | Docked::Column(parts) => {
            *count <= MAX_LAYOUT_PARTS
                && parts.iter().all(|part| part.size.is_finite() && part.size >= 0.0 && is_sound(&part.part, count))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layout_that_cannot_be_is_refused() {
        let tabs = || Docked::Tabs { panels: vec!["viewport".into()], front: None };
        let row = |size| Docked::Row(vec![DockedPart { size, part: tabs() }]);
        let layout = |root| PanelLayout { root, closed: Vec::new() };
        assert!(layout(row(200.0)).is_sound());
        assert!(!layout(row(f32::NAN)).is_sound() && !layout(row(-1.0)).is_sound());
        let many = vec!["viewport".to_owned(); MAX_LAYOUT_PARTS + 1];
        assert!(!layout(Docked::Tabs { panels: many, front: None }).is_sound());
    }
}

//! The keys after G, R or S: axes, numbers, the end.

use egui::{Event, Key, Modifiers};

use super::kinds::{Constraint, Orientation, TransformKind};
use super::transform_drag::TransformDrag;

/// What the keys ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModalStep {
    /// To go on.
    Going,
    /// To keep what has been done.
    Done,
    /// To take it back.
    Canceled,
    /// To take it back and do something else.
    Switch(TransformKind),
}

/// Handles the keys of a frame; `usual` is the orientation of the tools.
pub fn take_keys(drag: &mut TransformDrag, events: &[Event], usual: Orientation) -> ModalStep {
    for event in events {
        match event {
            Event::Key { key, pressed: true, modifiers, .. } if !modifiers.command => match key {
                Key::Enter | Key::Space => return ModalStep::Done,
                Key::Escape => return ModalStep::Canceled,
                Key::Backspace => drag.typed.pop(),
                Key::Tab => drag.typed.next(drag.numbers()),
                Key::F if drag.typed.is_empty() => drag.surface = drag.surface.next(),
                Key::X => limit(drag, 0, *modifiers, usual),
                Key::Y => limit(drag, 1, *modifiers, usual),
                Key::Z => limit(drag, 2, *modifiers, usual),
                Key::G if drag.typed.is_empty() => return ModalStep::Switch(TransformKind::Move),
                Key::R if drag.typed.is_empty() => return ModalStep::Switch(TransformKind::Rotate),
                Key::S if drag.typed.is_empty() => return ModalStep::Switch(TransformKind::Scale),
                _ => {}
            },
            Event::Text(text) => {
                let others = if drag.typed.is_empty() { "xyzfgrs" } else { "xyz" };
                let is_taken = |c: &char| !others.contains(*c);
                let taken: Vec<char> = text.chars().map(|c| c.to_ascii_lowercase()).filter(is_taken).collect();
                taken.into_iter().for_each(|c| drag.typed.push(c));
            }
            _ => {}
        }
    }
    ModalStep::Going
}

/// Limits the transform to an axis, or with Shift to the plane across it. The same key again takes the local axis (that
/// of the world where local is usual), a third time lifts the limit.
fn limit(drag: &mut TransformDrag, axis: usize, modifiers: Modifiers, usual: Orientation) {
    let wanted = if modifiers.shift { Constraint::Plane(axis) } else { Constraint::Axis(axis) };
    let other = if usual == Orientation::Local { Orientation::World } else { Orientation::Local };
    let (constraint, orientation) = match (drag.constraint == wanted, drag.orientation == usual) {
        (true, true) => (wanted, other),
        (true, false) => (Constraint::Free, usual),
        (false, _) => (wanted, usual),
    };
    drag.constraint = constraint;
    drag.set_orientation(orientation);
}

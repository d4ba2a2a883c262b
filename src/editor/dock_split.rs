//! Layouts with several viewports beside each other.

use egui::Vec2;

use super::view_slots::SIDES;
use isolith_document::{Docked, DockedPart, PanelLayout};

/// The layout with this many viewports, 1, 2 or 4, in the room of those that it has now, in points. All other panels stay
/// where they are.
pub fn split(layout: &PanelLayout, center: &str, count: usize, room: Vec2) -> PanelLayout {
    let is_side = |id: &str| SIDES.iter().any(|(side, ..)| *side == id);
    let mut root = without(&layout.root, &is_side).unwrap_or_else(|| tab(center));
    let beside = |part: Docked, size: f32| DockedPart { size: size.round(), part };
    let half = room * 0.5;
    let [second, third, fourth] = SIDES.map(|(id, ..)| tab(id));
    let with = |own: Docked| match count {
        2 => Docked::Row(vec![beside(own, 0.0), beside(second.clone(), half.x)]),
        4 => {
            let left = Docked::Column(vec![beside(own, 0.0), beside(third.clone(), half.y)]);
            let right = Docked::Column(vec![beside(second.clone(), half.y), beside(fourth.clone(), half.y)]);
            Docked::Row(vec![beside(left, 0.0), beside(right, half.x)])
        }
        _ => own,
    };
    replace(&mut root, center, &with);
    let open = if count > 2 { SIDES.len() } else { count.saturating_sub(1) };
    let mut closed: Vec<String> = layout.closed.iter().filter(|id| !is_side(id)).cloned().collect();
    closed.extend(SIDES.iter().skip(open).map(|(id, ..)| (*id).to_owned()));
    PanelLayout { root, closed }
}

fn tab(id: &str) -> Docked {
    Docked::Tabs { panels: vec![id.to_owned()], front: Some(id.to_owned()) }
}

/// The part without these panels; `None` if nothing is left.
fn without(part: &Docked, is_gone: &impl Fn(&str) -> bool) -> Option<Docked> {
    match part {
        Docked::Tabs { panels, front } => {
            let panels: Vec<String> = panels.iter().filter(|id| !is_gone(id)).cloned().collect();
            let front = front.clone().filter(|id| !is_gone(id));
            (!panels.is_empty()).then_some(Docked::Tabs { panels, front })
        }
        Docked::Row(parts) => rest(parts, is_gone, Docked::Row),
        Docked::Column(parts) => rest(parts, is_gone, Docked::Column),
    }
}

fn rest(parts: &[DockedPart], is_gone: &impl Fn(&str) -> bool, of: fn(Vec<DockedPart>) -> Docked) -> Option<Docked> {
    let left = |part: &DockedPart| Some(DockedPart { size: part.size, part: without(&part.part, is_gone)? });
    let mut left: Vec<DockedPart> = parts.iter().filter_map(left).collect();
    match left.len() {
        0 => None,
        1 => left.pop().map(|only| only.part),
        _ => Some(of(left)),
    }
}

/// Replaces the tabs that hold a panel.
fn replace(part: &mut Docked, id: &str, with: &impl Fn(Docked) -> Docked) {
    match part {
        Docked::Tabs { panels, .. } if panels.iter().any(|panel| panel == id) => {
            let own = std::mem::replace(part, Docked::Row(Vec::new()));
            *part = with(own);
        }
        Docked::Tabs { .. } => {}
        Docked::Row(parts) | Docked::Column(parts) => {
            parts.iter_mut().for_each(|inner| replace(&mut inner.part, id, with))
        }
    }
}

#[cfg(test)]
mod tests {
    use egui::vec2;

    use super::*;

    fn layout() -> PanelLayout {
        let part = |id: &str, size| DockedPart { size, part: tab(id) };
        PanelLayout {
            root: Docked::Row(vec![part("outliner", 240.0), part("viewport", 0.0), part("view-3", 300.0)]),
            closed: vec!["log".into(), "view-3".into()],
        }
    }

    fn panels(part: &Docked) -> Vec<String> {
        match part {
            Docked::Tabs { panels, .. } => panels.clone(),
            Docked::Row(parts) | Docked::Column(parts) => parts.iter().flat_map(|inner| panels(&inner.part)).collect(),
        }
    }

    #[test]
    fn views_are_split_and_joined_in_the_room_of_the_viewport() {
        let room = vec2(900.0, 600.0);
        let two = split(&layout(), "viewport", 2, room);
        assert_eq!(panels(&two.root), ["outliner", "viewport", "view-2"]);
        assert_eq!(two.closed, ["log", "view-3", "view-4"]);
        let four = split(&two, "viewport", 4, room);
        assert_eq!(panels(&four.root), ["outliner", "viewport", "view-3", "view-2", "view-4"]);
        assert_eq!(four.closed, ["log"]);
        let one = split(&four, "viewport", 1, room);
        assert_eq!(panels(&one.root), ["outliner", "viewport"]);
        assert_eq!(one.closed.len(), 4);
        assert!(four.is_sound() && split(&four, "viewport", 4, room) == four);
    }
}

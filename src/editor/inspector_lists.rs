//! The lists of a node that the inspector shows: modifiers, dynamics, and the masks of an instancer.

use egui::Ui;

use super::multi_edit::MultiEdit;
use super::slot_list::{self, SlotList};
use super::{curve_editor, widgets};
use isolith_scene::{
    DynamicKind, DynamicSlot, MAX_DYNAMICS, MAX_MASKS, MAX_MODIFIERS, MaskKind, MaskSlot, ModifierKind, ModifierSlot,
    Node, NodeKind, Param, Part,
};

/// The card of modifiers, for objects and groups.
pub fn modifiers(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Modifiers", |ui| slot_list::show::<ModifierSlot>(ui, edit));
}

/// The card of dynamics, for objects, groups and instancers.
pub fn dynamics(ui: &mut Ui, edit: &mut MultiEdit<'_>) {
    widgets::card(ui, "Dynamics", |ui| slot_list::show::<DynamicSlot>(ui, edit));
}

impl SlotList for ModifierSlot {
    type Kind = ModifierKind;
    const MOST: usize = MAX_MODIFIERS;
    const NAMES: [&'static str; 2] = ["modifier", "modifiers"];
    const SWITCH: Option<&'static str> = Some("enabled");
    const ROWS: &'static [&'static str] = &[];

    fn kinds() -> &'static [ModifierKind] {
        ModifierKind::ALL
    }

    fn texts(kind: ModifierKind) -> [&'static str; 2] {
        [kind.label(), kind.help()]
    }

    fn params(kind: ModifierKind) -> &'static [Param] {
        kind.params()
    }

    fn with_defaults(kind: ModifierKind) -> Self {
        kind.default_modifier().into()
    }

    fn kind(&self) -> ModifierKind {
        self.modifier.kind()
    }

    fn list(node: &Node) -> &[Self] {
        &node.modifiers
    }

    fn list_mut(node: &mut Node) -> Option<&mut Vec<Self>> {
        Some(&mut node.modifiers)
    }

    fn part(index: usize) -> Part {
        Part::Modifier(index)
    }
}

impl SlotList for DynamicSlot {
    type Kind = DynamicKind;
    const MOST: usize = MAX_DYNAMICS;
    const NAMES: [&'static str; 2] = ["dynamic", "dynamics"];
    const SWITCH: Option<&'static str> = Some("enabled");
    const ROWS: &'static [&'static str] = &[];

    fn kinds() -> &'static [DynamicKind] {
        DynamicKind::ALL
    }

    fn texts(kind: DynamicKind) -> [&'static str; 2] {
        [kind.label(), kind.help()]
    }

    fn params(kind: DynamicKind) -> &'static [Param] {
        kind.params()
    }

    fn with_defaults(kind: DynamicKind) -> Self {
        kind.default_dynamic().into()
    }

    fn kind(&self) -> DynamicKind {
        self.dynamic.kind()
    }

    fn list(node: &Node) -> &[Self] {
        &node.dynamics
    }

    fn list_mut(node: &mut Node) -> Option<&mut Vec<Self>> {
        Some(&mut node.dynamics)
    }

    fn part(index: usize) -> Part {
        Part::Dynamic(index)
    }
}

impl SlotList for MaskSlot {
    type Kind = MaskKind;
    const MOST: usize = MAX_MASKS;
    const NAMES: [&'static str; 2] = ["mask", "masks"];
    const SWITCH: Option<&'static str> = None;
    const ROWS: &'static [&'static str] = &["inverted", "join"];

    fn kinds() -> &'static [MaskKind] {
        MaskKind::ALL
    }

    fn texts(kind: MaskKind) -> [&'static str; 2] {
        [kind.label(), kind.help()]
    }

    fn params(kind: MaskKind) -> &'static [Param] {
        kind.params()
    }

    fn with_defaults(kind: MaskKind) -> Self {
        kind.default_mask().into()
    }

    fn kind(&self) -> MaskKind {
        self.mask.kind()
    }

    fn list(node: &Node) -> &[Self] {
        if let NodeKind::Instancer(instancer) = &node.kind { &instancer.masks } else { &[] }
    }

    fn list_mut(node: &mut Node) -> Option<&mut Vec<Self>> {
        if let NodeKind::Instancer(instancer) = &mut node.kind { Some(&mut instancer.masks) } else { None }
    }

    fn part(index: usize) -> Part {
        Part::Mask(index)
    }

    fn more(ui: &mut Ui, edit: &mut MultiEdit<'_>, index: usize) {
        curve_editor::show(ui, edit, index);
    }
}

//! Fields bound to the selected nodes: what is shown comes from the active node, what is changed
//! changes every one of them, and values that differ show a dash.

use std::sync::Arc;

use egui::Ui;
use glam::DVec3;

use super::edit_session::EditSession;
use super::numbers::{self, FieldResponse, NumberField};
use super::widgets;
use crate::scene::{Node, NodeId};

/// Nodes edited together; never empty, the last is the active one.
pub struct MultiEdit<'a> {
    session: &'a mut EditSession,
    nodes: Vec<Arc<Node>>,
}

impl<'a> MultiEdit<'a> {
    /// Edits these nodes; `None` for none.
    pub fn new(session: &'a mut EditSession, nodes: Vec<Arc<Node>>) -> Option<Self> {
        if nodes.is_empty() { None } else { Some(Self { session, nodes }) }
    }

    /// The node whose values are shown.
    pub fn active(&self) -> &Arc<Node> {
        self.nodes.last().expect("there is always a node")
    }

    /// The document and its messages.
    pub fn session(&mut self) -> &mut EditSession {
        self.session
    }

    /// The nodes.
    pub fn ids(&self) -> Vec<NodeId> {
        self.nodes.iter().map(|n| n.id).collect()
    }

    /// Changes every node, as part of the widget's gesture.
    pub fn change(&mut self, widget: egui::Id, change: impl Fn(&mut Node)) {
        let ids = self.ids();
        self.session.change(widget, &ids, change);
    }

    /// What all nodes agree on, or `None`.
    pub fn common<T: PartialEq>(&self, get: impl Fn(&Node) -> T) -> Option<T> {
        let first = get(self.active());
        self.nodes.iter().all(|n| get(n) == first).then_some(first)
    }

    /// A row with one number.
    pub fn number(
        &mut self,
        ui: &mut Ui,
        field: &NumberField<'_>,
        get: impl Fn(&Node) -> Option<f64>,
        set: impl Fn(&mut Node, f64),
    ) {
        let Some(value) = get(self.active()) else { return };
        let mixed = self.common(get).is_none();
        let answer = widgets::row(ui, field.label, field.help, |ui| {
            let width = ui.available_width();
            numbers::number(ui, field, field.label, value, mixed, width)
        });
        if let Some(value) = answer.value {
            self.change(answer.widget, |node| set(node, value));
        }
    }

    /// A row with three numbers; only the component changed is set in each node.
    pub fn vector(
        &mut self,
        ui: &mut Ui,
        field: &NumberField<'_>,
        get: impl Fn(&Node) -> Option<DVec3>,
        set: impl Fn(&mut Node, DVec3),
    ) {
        let Some(value) = get(self.active()) else { return };
        let mixed = std::array::from_fn(|axis| self.common(|n| get(n).map(|v| v[axis])).is_none());
        let changed =
            widgets::row(ui, field.label, field.help, |ui| numbers::vector(ui, field, value.to_array(), mixed));
        if let Some((axis, FieldResponse { widget, value: Some(new) })) = changed {
            self.change(widget, |node| {
                if let Some(mut value) = get(node) {
                    value[axis] = new;
                    set(node, value);
                }
            });
        }
    }

    /// A row with a drop-down list.
    pub fn choice<T: Copy + PartialEq>(
        &mut self,
        ui: &mut Ui,
        (label, help): (&str, &str),
        options: &[T],
        (name, describe): (impl Fn(T) -> &'static str, impl Fn(T) -> &'static str),
        get: impl Fn(&Node) -> Option<T>,
        set: impl Fn(&mut Node, T),
    ) {
        let current = self.common(get).flatten();
        let (widget, chosen) =
            widgets::row(ui, label, help, |ui| widgets::choice(ui, label, current, options, name, describe));
        if let Some(chosen) = chosen {
            self.change(widget, |node| set(node, chosen));
        }
    }

    /// A row with a check box.
    pub fn toggle(
        &mut self,
        ui: &mut Ui,
        (label, text, help): (&str, &str, &str),
        get: impl Fn(&Node) -> bool,
        set: impl Fn(&mut Node, bool),
    ) {
        let mut on = get(self.active());
        let mixed = self.common(get).is_none();
        let response = widgets::row(ui, label, help, |ui| {
            ui.add(egui::Checkbox::new(&mut on, text).indeterminate(mixed)).on_hover_text(help)
        });
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(label.to_owned()));
        if response.changed() {
            self.change(response.id, |node| set(node, on));
        }
    }

    /// A row with a color.
    pub fn color(
        &mut self,
        ui: &mut Ui,
        (label, help): (&str, &str),
        get: impl Fn(&Node) -> Option<[f64; 3]>,
        set: impl Fn(&mut Node, [f64; 3]),
    ) {
        let Some(value) = get(self.active()) else { return };
        let mixed = self.common(get).is_none();
        let (widget, changed) = widgets::row(ui, label, help, |ui| widgets::color(ui, label, value, mixed));
        if let Some(value) = changed {
            self.change(widget, |node| set(node, value));
        }
    }
}

//! Fields bound to the selected nodes: they show the values of the active node, change every node, and show a dash if
//! values differ.

use std::borrow::Cow;
use std::sync::Arc;

use egui::Ui;

use super::edit_session::EditSession;
use super::widgets;
use isolith_scene::{Node, NodeId, ParamPath, Part};

/// Nodes edited together: at least one; the last is the active one.
pub struct MultiEdit<'a> {
    session: &'a mut EditSession,
    nodes: Vec<Arc<Node>>,
}

impl<'a> MultiEdit<'a> {
    /// Edits these nodes; `None` if there are none.
    pub fn new(session: &'a mut EditSession, nodes: Vec<Arc<Node>>) -> Option<Self> {
        if nodes.is_empty() { None } else { Some(Self { session, nodes }) }
    }

    /// Restricts the edit to the nodes that `keep` accepts; `None` if the active node is not among them.
    pub fn only(&mut self, keep: impl Fn(&Node) -> bool) -> Option<MultiEdit<'_>> {
        if !keep(self.active()) {
            return None;
        }
        let nodes = self.nodes.iter().filter(|node| keep(node)).cloned().collect();
        MultiEdit::new(self.session, nodes)
    }

    /// The node whose values the fields show.
    pub fn active(&self) -> &Arc<Node> {
        self.nodes.last().expect("there is always a node")
    }

    /// The document and its messages.
    pub fn session(&mut self) -> &mut EditSession {
        self.session
    }

    /// The ids of the nodes.
    pub fn ids(&self) -> Vec<NodeId> {
        self.nodes.iter().map(|n| n.id).collect()
    }

    /// The paths of this parameter, one for each node.
    pub fn paths(&self, part: Part, name: impl Into<Cow<'static, str>>) -> Vec<ParamPath> {
        let name = name.into();
        self.nodes.iter().map(|node| ParamPath::of_node(node.id, part, name.clone())).collect()
    }

    /// Changes every node, as part of the widget's gesture.
    pub fn change(&mut self, widget: egui::Id, change: impl Fn(&mut Node)) {
        let ids = self.ids();
        self.session.change(widget, &ids, change);
    }

    /// The common value of all nodes, or `None` if they differ.
    pub fn common<T: PartialEq>(&self, get: impl Fn(&Node) -> T) -> Option<T> {
        let first = get(self.active());
        self.nodes.iter().all(|n| get(n) == first).then_some(first)
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
}

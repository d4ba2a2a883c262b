//! The document and the means to change it from panels: gestures and messages.

use std::sync::Arc;

use egui::{Context, Id};

use super::messages::{Message, Messages};
use isolith_document::{Document, Edit};
use isolith_scene::{Attached, Material, Node, NodeId, NodeKind, ParamOwner, ParamPath, ParamValue, Part, Scene};

/// The document, the gesture in progress, the messages.
///
/// Every change by a widget names the widget. All changes by one widget, from its first until the
/// pointer is up and the widget has lost the focus, are one gesture and so one undo step.
pub struct EditSession {
    /// The document.
    pub document: Document,
    /// Messages to the artist.
    pub messages: Messages,
    /// The file request of a panel.
    pub wanted_file: Option<WantedFile>,
    /// A mesh file that a panel wants to replace by another.
    pub wanted_mesh: Option<String>,
    /// The gesture goes on without a pressed button.
    pub is_held: bool,
    gesture: Option<Id>,
}

/// A request for a file as the value of a parameter of some nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedFile {
    /// The paths of the parameter, one for each node.
    pub paths: Vec<ParamPath>,
    /// Its current value.
    pub instead_of: Attached,
}

/// Names the node, its shape or modifier and the parameter, for messages; `None` if the node no longer exists.
pub fn subject(scene: &Scene, path: &ParamPath) -> Option<String> {
    let (id, part) = match path.owner {
        ParamOwner::Node(id, part) => (id, part),
        ParamOwner::Material(id) => return Some(format!("{}: {}", scene.material(id)?.name, path.name)),
        ParamOwner::Environment | ParamOwner::Display => return None,
    };
    let node = scene.node(id)?;
    let of = match (part, &node.kind) {
        (Part::Modifier(place), _) => node.modifiers.get(place)?.modifier.kind().label(),
        (Part::Dynamic(place), _) => node.dynamics.get(place)?.dynamic.kind().label(),
        (Part::Mask(place), NodeKind::Instancer(instancer)) => instancer.masks.get(place)?.mask.kind().label(),
        (Part::Shape, NodeKind::Object(object)) => object.shape.kind().label(),
        _ => return Some(format!("{} {id}: {}", node.name, path.name)),
    };
    Some(format!("{} {id}: {of}: {}", node.name, path.name))
}

impl EditSession {
    /// A session without messages.
    pub fn new(document: Document) -> Self {
        Self {
            document,
            messages: Messages::default(),
            wanted_file: None,
            wanted_mesh: None,
            is_held: false,
            gesture: None,
        }
    }

    /// Applies one change as its own undo step; returns the added nodes. A refusal becomes a message.
    pub fn apply(&mut self, edit: Edit) -> Vec<NodeId> {
        match self.document.apply(edit) {
            Ok(added) => added,
            Err(refusal) => {
                self.messages.push(Message::error(refusal.to_string()));
                Vec::new()
            }
        }
    }

    /// Applies a change as part of the widget's gesture.
    pub fn apply_by(&mut self, widget: Id, edit: Edit) -> Vec<NodeId> {
        self.begin(widget);
        self.apply(edit)
    }

    /// Changes each node as part of the widget's gesture.
    pub fn change(&mut self, widget: Id, ids: &[NodeId], change: impl Fn(&mut Node)) {
        self.begin(widget);
        for &id in ids {
            if let Some(node) = self.document.scene().node(id) {
                let mut node = Node::clone(node);
                change(&mut node);
                self.apply(Edit::Replace(node));
            }
        }
    }

    /// Changes parameters as part of the widget's gesture.
    pub fn set_params(&mut self, widget: Id, changes: Vec<(ParamPath, ParamValue)>) {
        self.begin(widget);
        for (path, value) in changes {
            self.apply(Edit::SetParam { path, value });
        }
    }

    /// Changes a material as part of the widget's gesture.
    pub fn change_material(&mut self, widget: Id, material: Material) {
        self.apply_by(widget, Edit::ReplaceMaterial(material));
    }

    /// Combines several changes into one undo step.
    pub fn together<R>(&mut self, changes: impl FnOnce(&mut Self) -> R) -> R {
        self.document.begin_gesture();
        let result = changes(self);
        self.document.end_gesture();
        result
    }

    /// The selected nodes in order of selection; the last is the active one.
    pub fn selected(&self) -> Vec<Arc<Node>> {
        self.document.selection().iter().filter_map(|id| self.document.scene().node(*id).cloned()).collect()
    }

    /// Whether a gesture is in progress.
    pub fn is_changing(&self) -> bool {
        self.gesture.is_some()
    }

    /// Ends the gesture once its widget is released. Call once a frame, after all panels.
    pub fn settle(&mut self, ctx: &Context) {
        let Some(widget) = self.gesture else { return };
        let held = self.is_held || ctx.input(|i| i.pointer.any_down()) || ctx.memory(|m| m.has_focus(widget));
        if !held {
            self.finish();
        }
    }

    /// Ends the gesture now, regardless of the pointer.
    pub fn finish(&mut self) {
        if self.gesture.take().is_some() {
            self.document.end_gesture();
        }
    }

    /// Cancels the gesture, regardless of the pointer.
    pub fn cancel(&mut self) {
        if self.gesture.take().is_some() {
            self.document.cancel_gesture();
        }
    }

    /// Starts the widget's gesture unless it is the one in progress.
    pub fn begin(&mut self, widget: Id) {
        if self.gesture == Some(widget) {
            return;
        }
        self.finish();
        self.document.begin_gesture();
        self.gesture = Some(widget);
    }
}

//! Copy, cut and paste. Nodes go to the system's clipboard as the text of a scene file, so that they can be pasted into
//! other scenes and windows, and into a text editor.

use std::path::Path;
use std::sync::Arc;

use egui::{Context, Event, ViewportCommand};

use super::arrangement::CopiedPart;
use super::edit_session::EditSession;
use super::messages::Message;
use super::state::EditorState;
use super::{material_edits, selection};
use isolith_document::{Edit, extracted};
use isolith_scene::{Material, MaterialId, Node, NodeId, Scene, file};

/// Carries out the key presses for the clipboard, which the system translates. Call it while no text is typed.
pub fn take_events(state: &mut EditorState, ctx: &Context) {
    let belongs = |event: &Event| matches!(event, Event::Copy | Event::Cut | Event::Paste(_));
    let events: Vec<Event> = ctx.input(|i| i.events.iter().filter(|event| belongs(event)).cloned().collect());
    if events.is_empty() {
        return;
    }
    ctx.input_mut(|i| i.events.retain(|event| !belongs(event)));
    state.session.finish();
    for event in events {
        match event {
            Event::Copy => copy(state, ctx),
            Event::Cut => cut(state, ctx),
            Event::Paste(text) => paste(state, &text),
            _ => {}
        }
    }
}

/// Copies the selection.
pub fn copy(state: &mut EditorState, ctx: &Context) {
    let roots = selection::roots(&state.session);
    if roots.is_empty() {
        return;
    }
    // A part of a valid scene is valid, and has a text.
    let part = extracted(state.session.document.resting(), &roots);
    match part.map_err(|error| error.to_string()).and_then(|part| {
        let text = file::to_json(&part).map_err(|error| error.to_string())?;
        Ok((part, text))
    }) {
        Ok((part, text)) => {
            ctx.copy_text(text);
            state.copied = Some(Arc::new(part));
        }
        Err(reason) => state.session.messages.push(Message::error(format!("The selection is not copied: {reason}"))),
    }
}

/// Copies the selection and deletes it, except what is locked.
pub fn cut(state: &mut EditorState, ctx: &Context) {
    copy(state, ctx);
    let count = selection::roots(&state.session).len();
    let name = state.session.selected().first().map(|node| node.name.clone()).unwrap_or_default();
    let what = if count == 1 { name } else { format!("{count} nodes") };
    state.session.document.begin_step(format!("Cut {what}"));
    selection::delete(&mut state.session);
    state.session.document.end_gesture();
}

/// Asks the system for what was copied; it arrives as an event.
pub fn request(ctx: &Context) {
    ctx.send_viewport_cmd(ViewportCommand::RequestPaste);
}

/// Adds the nodes of a text beside the active node and selects them.
pub fn paste(state: &mut EditorState, text: &str) {
    if !text.trim_start().starts_with('{') {
        state.session.messages.push(Message::info("The clipboard holds no nodes. Copy some in Isolith first."));
        return;
    }
    match file::parse(text.as_bytes(), Path::new("clipboard")) {
        Ok(scene) if scene.nodes().is_empty() => {
            state.session.messages.push(Message::info("The clipboard holds no nodes."));
        }
        Ok(scene) => {
            let scene = Arc::new(scene);
            insert(&mut state.session, &scene);
            state.copied = Some(scene);
        }
        Err(error) => state.session.messages.push(Message::error(error.to_string())),
    }
}

/// Adds the nodes of a scene beside the active node and selects them.
pub fn insert(session: &mut EditSession, from: &Arc<Scene>) {
    let scene = session.document.scene();
    let active = session.document.selection().last().and_then(|id| scene.node(*id));
    let holds_types = |id: NodeId| scene.node(id).is_some_and(|parent| super::instancing::instancer(parent).is_some());
    let fits = |id: &NodeId| !holds_types(*id) || from.children(None).all(|node| node.can_be_type());
    let (parent, position) = match active {
        Some(node) if node.parent.is_none_or(|id| fits(&id)) => (node.parent, selection::place(scene, node.id) + 1),
        _ => (None, scene.children(None).count()),
    };
    let added = session.apply(Edit::Merge { parent, position, from: Arc::clone(from) });
    if !added.is_empty() {
        session.document.select(added);
    }
}

/// Whether something is copied that has this part, and something is selected that takes it.
pub fn can_paste(state: &EditorState, part: CopiedPart) -> bool {
    let Some(node) = copied_node(state) else { return false };
    let has = match part {
        CopiedPart::Material => material_edits::material_of(node).is_some(),
        CopiedPart::Modifiers => node.has_field(),
        CopiedPart::Dynamics => node.can_move(),
        CopiedPart::Transform => true,
    };
    has && state.session.selected().iter().any(|node| takes(node, part))
}

/// The first of the copied nodes.
fn copied_node(state: &EditorState) -> Option<&Node> {
    state.copied.as_ref()?.nodes().first().map(|node| &**node)
}

fn takes(node: &Node, part: CopiedPart) -> bool {
    match part {
        CopiedPart::Transform => true,
        CopiedPart::Material => material_edits::takes_material(node),
        CopiedPart::Modifiers => node.has_field(),
        CopiedPart::Dynamics => node.can_move(),
    }
}

/// Gives the selection a part of the copied node: one step of undo.
pub fn paste_part(state: &mut EditorState, part: CopiedPart) {
    let Some(source) = copied_node(state).cloned() else { return };
    let ids = state.session.document.selection().to_vec();
    if part == CopiedPart::Transform && selection::refuse_locked(&mut state.session, &ids, "moved") {
        return;
    }
    state.session.document.begin_step(part.label());
    let material = match part {
        CopiedPart::Material => own_material(state, &source),
        _ => None,
    };
    for node in state.session.selected().iter().filter(|node| takes(node, part)) {
        let mut node = Node::clone(node);
        match part {
            CopiedPart::Transform => node.transform = source.transform,
            CopiedPart::Material => material_edits::set_material(&mut node, material),
            CopiedPart::Modifiers => node.modifiers.clone_from(&source.modifiers),
            CopiedPart::Dynamics => node.dynamics.clone_from(&source.dynamics),
        }
        state.session.apply(Edit::Replace(node));
    }
    state.session.document.end_gesture();
}

/// The scene's material that equals the one of the copied node; it is added if there is none.
fn own_material(state: &mut EditorState, source: &Node) -> Option<MaterialId> {
    let copied = state.copied.clone()?;
    let wanted = copied.material(material_edits::material_of(source)?)?;
    let scene = state.session.document.scene();
    let same = |other: &&Arc<Material>| Material { id: wanted.id, ..Material::clone(other) } == **wanted;
    match scene.materials().iter().find(same) {
        Some(own) => Some(own.id),
        None => material_edits::insert(&mut state.session, Material::clone(wanted)),
    }
}

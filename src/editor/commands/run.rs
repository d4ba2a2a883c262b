//! The effects of commands.

use std::path::Path;

use egui::Context;
use glam::DQuat;

use super::command::Command;
use crate::edit_session::EditSession;
use crate::help::HelpTab;
use crate::intent::Intent;
use crate::keymap::Keymap;
use crate::log_panel::LOG;
use crate::root::Editor;
use crate::snapping::{ANGLES, LENGTHS, SnapSettings};
use crate::state::{EditorState, Request};
use crate::transforms::kinds::TransformKind;
use crate::view_state::PointerActivity;
use crate::{
    arrange, camera_view, clipboard, dope_sheet, drawing, insertion, instancer_edits, keying, material_edits,
    mesh_conversion, pass_view, relations, seeds, selection,
};
use isolith_document::Edit;
use isolith_scene::{CameraNode, Group, Light, LightKind, Node, NodeKind, Operation, Operator};

impl Editor {
    /// Runs a command if it is enabled.
    pub fn run(&mut self, command: Command, ctx: &Context) {
        if !command.is_enabled(&self.state) {
            return;
        }
        self.state.session.finish();
        self.state.view.transforming = None;
        match command {
            Command::New => self.intend(Intent::New, ctx),
            Command::Open => self.intend(Intent::Choose, ctx),
            Command::Save => self.save(None, ctx),
            Command::SaveAs => self.choose_save_path(None, ctx),
            Command::Reload => self.reload(ctx),
            Command::Recover => self.offer_lost_work(),
            Command::Quit => self.intend(Intent::Quit, ctx),
            Command::ExamineScene => self.open_doctor(),
            Command::ShowHelp => self.open_help(ctx),
            Command::ShowKeys => self.open_help_tab(HelpTab::Keys),
            Command::ShowNews => self.open_help_tab(HelpTab::News),
            Command::StartTour => self.tour.start(),
            Command::ShowWelcome => self.open_welcome(),
            Command::Render => self.rendering.open(&self.state.session.document),
            Command::AddAtPointer => self.add_at_pointer(ctx),
            Command::AddMesh => self.choose_mesh(ctx),
            Command::Copy => clipboard::copy(&mut self.state, ctx),
            Command::Cut => clipboard::cut(&mut self.state, ctx),
            Command::Paste => clipboard::request(ctx),
            Command::FindCommand => self.command_palette.open(),
            Command::Preferences => self.preferences_window.open(),
            _ => run_on_state(&mut self.state, command),
        }
    }

    /// Opens the palette where the context menu was opened, or at the pointer.
    fn add_at_pointer(&mut self, ctx: &Context) {
        let view = &mut self.state.view;
        let pointer = view.menu_at.take().or(ctx.pointer_latest_pos()).unwrap_or(view.rect.center());
        view.add_at = Some(pointer).filter(|pointer| view.rect.contains(*pointer));
        self.add_palette.open(pointer);
    }

    fn reload(&mut self, ctx: &Context) {
        if let Some(path) = self.document().path().map(Path::to_path_buf) {
            self.intend(Intent::Open(path), ctx);
        }
    }
}

/// Runs a command that needs no window in front and no file; [`Editor::run`] runs those that do.
fn run_on_state(state: &mut EditorState, command: Command) {
    let session = &mut state.session;
    match command {
        Command::ReloadModels | Command::PackFiles | Command::UnpackFiles => models(state, command),
        Command::Undo => undo(session),
        Command::Redo => redo(session),
        Command::Rename => state.renaming = session.document.selection().last().copied(),
        Command::Duplicate | Command::DuplicateLinked | Command::DuplicateAlong | Command::Unlink => {
            duplicate(state, command);
        }
        Command::ShowHistory => state.show_history ^= true,
        Command::PastePart(_) | Command::Align(..) | Command::Distribute(_) | Command::MoveOrigin(_) => {
            place(state, command)
        }
        Command::Delete if state.playback.deletes_keys() => dope_sheet::delete(session, &mut state.playback),
        Command::Delete => selection::delete(session),
        Command::KeyTransform => keying::key_transforms(session),
        Command::Play => state.playback.toggle(&mut session.document),
        Command::Group => arrange::grouped(state, |session| selection::join(session, Operator::Union, true)),
        Command::Ungroup => selection::ungroup(session),
        Command::InstanceSelection => instance(session),
        Command::RerollSeeds => reroll(session),
        Command::ApplyPreset(preset) => instancer_edits::apply_preset(state, preset),
        Command::MoveUp => selection::shift(session, -1),
        Command::MoveDown => selection::shift(session, 1),
        Command::Join(operator) => arrange::grouped(state, |session| selection::join(session, operator, false)),
        Command::ToggleSubtract => selection::toggle_operation(session, Operation::Subtract),
        Command::ToggleIntersect => selection::toggle_operation(session, Operation::Intersect),
        Command::SelectAll | Command::SelectNothing | Command::SelectParents | Command::SelectChildren => {
            select(state, command);
        }
        Command::SelectSimilar
        | Command::SelectSameMaterial
        | Command::SelectLinked
        | Command::SelectByBox
        | Command::SelectByLasso => {
            select(state, command);
        }
        Command::Isolate => relations::isolate(state),
        Command::DropOnSurface => relations::drop_on_surface(state),
        Command::MeshToField => mesh_conversion::to_fields(session),
        Command::FieldToMesh => mesh_conversion::to_meshes(session),
        Command::ToggleVisible => selection::toggle_visible(session),
        Command::ShowAll => selection::show_all(session),
        Command::ToggleLock => selection::toggle_locked(session),
        Command::MakeMaterialUnique => make_material_unique(session),
        Command::RemoveUnusedMaterials => remove_unused_materials(session),
        Command::AddShape(kind) if drawing::chooses_shape(state) => state.view.drawn = kind,
        Command::AddShape(kind) => insertion::shape(state, kind),
        Command::AddGroup => add(state, Node::new("Group", NodeKind::Group(Group::UNION))),
        Command::AddInstancer => instancer_edits::add(state),
        Command::AddSun | Command::AddPointLight | Command::AddSpotLight | Command::AddAreaLight => {
            add_light(state, command);
        }
        Command::AddCamera => add_camera(state),
        _ => run_on_view(state, command),
    }
}

/// Runs a command on the view, the panels or the tools.
fn run_on_view(state: &mut EditorState, command: Command) {
    match command {
        Command::FrameSelected => state.frame_selected(),
        Command::FrameAll => state.frame_all(),
        Command::LookThroughCamera => state.look_through_camera(),
        Command::LockCamera => state.view.locks_camera ^= true,
        Command::ToggleSafeAreas => state.view.show_safe_areas ^= true,
        Command::SetBookmark(index) => camera_view::set_bookmark(state, index),
        Command::ShowBookmark(index) => camera_view::show_bookmark(state, index),
        Command::LookFrom(side) => state.view.navigation.look_along(side),
        Command::ToggleOrthographic => state.view.navigation.toggle_orthographic(),
        Command::ToggleGrid => state.view.show_grid ^= true,
        Command::ToggleOutline => state.view.show_outline ^= true,
        Command::ShowMessages => state.requests.push(Request::TogglePanel(LOG)),
        Command::ResetLayout => state.requests.push(Request::ResetLayout),
        Command::Transform(kind) => state.view.transforming = Some(kind),
        Command::UseTool(tool) => state.view.tool = tool,
        Command::UseOrientation(orientation) => state.view.orientation = orientation,
        Command::UsePivot(pivot) => state.view.pivot = pivot,
        Command::ToggleSnap => change_snapping(state, |snap| snap.is_on ^= true),
        Command::SnapLengths(index) => change_snapping(state, |snap| snap.length = index.map(|index| LENGTHS[index])),
        Command::SnapAngles(index) => change_snapping(state, |snap| snap.angle = ANGLES[index]),
        Command::UseKeymap(keymap) => state.use_keymap(keymap),
        Command::ShowShading(shading) => state.view.show_shading(shading),
        Command::CycleShading => state.view.cycle_shading(),
        Command::ShowView(view_mode) => state.view.toggle_view_mode(view_mode),
        Command::ShowPass(step) => pass_view::step(state, step),
        Command::Samples(samples) => state.view.samples = samples,
        Command::SplitView(count) => state.requests.push(Request::SplitView(count)),
        // Those of a window in front or a file.
        _ => {}
    }
}

/// Changes how drags snap, and keeps it for the next start.
fn change_snapping(state: &mut EditorState, change: impl FnOnce(&mut SnapSettings)) {
    change(&mut state.view.snap);
    let snap = state.view.snap;
    state.preferences.change(|values| snap.keep(values));
}

fn models(state: &mut EditorState, command: Command) {
    let jobs = state.derived.jobs();
    match command {
        Command::PackFiles => state.packing.pack(jobs, &state.session),
        Command::UnpackFiles => state.packing.unpack(jobs, &state.session),
        _ => state.derived.reload_models(),
    }
}

fn duplicate(state: &mut EditorState, command: Command) {
    match command {
        Command::Duplicate | Command::DuplicateLinked => {
            if command == Command::Duplicate {
                selection::duplicate(&mut state.session);
            } else {
                selection::duplicate_linked(&mut state.session);
            }
            // The copy lies in its original until it is moved: at once, by the keys of Blender.
            if state.keymap() == Keymap::Blender && state.view.pointer == PointerActivity::Hovering {
                state.view.transforming = Some(TransformKind::Move);
            }
        }
        Command::DuplicateAlong => relations::duplicate_along(state),
        _ => selection::unlink(&mut state.session),
    }
}

fn place(state: &mut EditorState, command: Command) {
    match command {
        Command::PastePart(part) => clipboard::paste_part(state, part),
        Command::Align(axis, edge) => arrange::align(state, axis, edge),
        Command::Distribute(axis) => arrange::distribute(state, axis),
        Command::MoveOrigin(place) => arrange::origin_to_children(state, place),
        _ => {}
    }
}

fn select(state: &mut EditorState, command: Command) {
    match command {
        Command::SelectAll => selection::select_all(&mut state.session),
        Command::SelectParents => relations::select_parents(state),
        Command::SelectChildren => relations::select_children(state),
        Command::SelectSimilar => relations::select_similar(state),
        Command::SelectLinked => relations::select_linked(state),
        Command::SelectSameMaterial => relations::select_same_material(state),
        Command::SelectByLasso => state.view.wants_lasso = true,
        Command::SelectByBox => state.view.wants_box = true,
        _ => select_nothing(state),
    }
}

fn undo(session: &mut EditSession) {
    session.document.undo();
}

fn redo(session: &mut EditSession) {
    session.document.redo();
}

fn select_nothing(state: &mut EditorState) {
    state.session.document.select(Vec::new());
    state.materials.current = None;
    state.view.entered = None;
}

fn make_material_unique(session: &mut EditSession) {
    let nodes = session.document.selection().to_vec();
    material_edits::make_unique(session, &nodes);
}

fn remove_unused_materials(session: &mut EditSession) {
    let unused = selection::unused_materials(session.document.scene());
    session.together(|session| {
        for id in unused {
            session.apply(Edit::RemoveMaterial(id));
        }
    });
}

fn instance(session: &mut EditSession) {
    instancer_edits::from_selection(session);
}

fn reroll(session: &mut EditSession) {
    let selection = session.document.selection().to_vec();
    seeds::reroll(session, &selection);
}

fn add(state: &mut EditorState, node: Node) {
    insertion::node(state, node);
}

fn add_sun(state: &mut EditorState) {
    let down = DQuat::from_euler(glam::EulerRot::YXZ, 0.6, -0.9, 0.0);
    add(state, Node::new("Sun", NodeKind::Light(Light::sun())).rotated(down));
}

fn add_light(state: &mut EditorState, command: Command) {
    match command {
        Command::AddPointLight => add_lamp(state, "Point light", LightKind::POINT),
        Command::AddSpotLight => add_lamp(state, "Spot light", LightKind::SPOT),
        Command::AddAreaLight => add_lamp(state, "Area light", LightKind::RECTANGLE),
        _ => add_sun(state),
    }
}

/// A light two meters above the view's target, shining down.
fn add_lamp(state: &mut EditorState, name: &str, light: LightKind) {
    let down = DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let node = Node::new(name, NodeKind::Light(Light::new(light))).rotated(down);
    insertion::node_above(state, node, 2.0);
}

fn add_camera(state: &mut EditorState) {
    let camera = state.view.navigation.camera();
    let kind =
        CameraNode { fov_y: camera.fov_y.to_degrees(), near: camera.near, far: camera.far, ..CameraNode::default() };
    let node = Node::new("Camera", NodeKind::Camera(kind)).at(camera.position).rotated(camera.rotation);
    insertion::node_in_world(state, node);
}

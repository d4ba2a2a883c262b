//! The outliner: the tree of the scene, to select, rename, reorder, hide and lock nodes.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};

use egui::{Color32, Key, Rangef, Rect, RichText, ScrollArea, TextEdit, Ui, vec2};
use egui_ltreeview::{Action, IndentHintStyle, NodeBuilder, RowLayout, TreeView, TreeViewState};
use egui_material_icons::icons::{
    ICON_CLOSE, ICON_JOIN_INNER, ICON_LOCK, ICON_LOCK_OPEN, ICON_VISIBILITY, ICON_VISIBILITY_OFF,
};

use super::commands::command::Command;
use super::commands::entries::context_entries;
use super::edit_session::EditSession;
use super::messages::Message;
use super::messages::Severity;
use super::outliner_drop::{RowId, destination, move_rows};
use super::outliner_filter::{self, KindFilter};
use super::panel::{Panel, PanelPlace};
use super::state::{EditorState, Request};
use super::{icons, instancing, node_warnings, theme, widgets};
use isolith_document::Edit;
use isolith_scene::limits::MAX_NAME;
use isolith_scene::{Node, NodeId, NodeKind, Operation, Operator, Scene};

/// State of the outliner that persists between frames.
pub struct Outliner {
    tree: TreeViewState<RowId>,
    rename: Option<Rename>,
    search: String,
    kind: KindFilter,
    /// The last selection seen; a new one scrolls into view and opens its parents.
    seen: Vec<NodeId>,
    /// The area below the last row.
    empty_room: Rect,
}

impl Default for Outliner {
    fn default() -> Self {
        Self {
            tree: TreeViewState::default(),
            rename: None,
            search: String::new(),
            kind: KindFilter::All,
            seen: Vec::new(),
            empty_room: Rect::NOTHING,
        }
    }
}

struct Rename {
    id: NodeId,
    text: String,
    focused: bool,
}

/// A request of a row, carried out after the tree is shown.
enum RowRequest {
    Rename(NodeId, String),
    EndRename,
    Visible(egui::Id, NodeId),
    Locked(egui::Id, NodeId),
    Operator(egui::Id, NodeId, Operator),
    Select(Vec<NodeId>),
    Run(Command),
}

impl Panel for Outliner {
    fn id(&self) -> &'static str {
        "outliner"
    }

    fn title(&self) -> &'static str {
        "Outliner"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Left(240.0, 160.0)
    }

    fn ui(&mut self, state: &mut EditorState, ui: &mut Ui) {
        if let Some(id) = state.renaming.take() {
            self.start_rename(state.session.document.scene(), id);
        }
        let warned = node_warnings::all(state);
        let chosen = widgets::fixed(ui, |ui| self.show(ui, &mut state.session, &warned));
        state.requests.extend(chosen.into_iter().map(Request::Run));
    }

    fn forget(&mut self) {
        *self = Self::default();
    }
}

impl Outliner {
    /// Starts renaming a node in place.
    fn start_rename(&mut self, scene: &Scene, id: NodeId) {
        if let Some(node) = scene.node(id) {
            self.rename = Some(Rename { id, text: node.name.clone(), focused: false });
        }
    }

    /// Shows the panel; returns the commands chosen in its context menu.
    fn show(&mut self, ui: &mut Ui, session: &mut EditSession, warned: &HashMap<NodeId, String>) -> Vec<Command> {
        self.search_field(ui);
        let scene = session.document.snapshot();
        let reveal = self.follow_selection(session, &scene);
        let requests = RefCell::new(Vec::new());
        let mut actions = Vec::new();
        let whole = ui.available_rect_before_wrap();
        ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            if scene.nodes().is_empty() {
                empty(ui);
                return;
            }
            ui.spacing_mut().item_spacing = vec2(4.0, 0.0);
            // The tree paints the selection at a third of this while the keyboard is elsewhere.
            ui.visuals_mut().widgets.inactive.weak_bg_fill = *theme::ACCENT;
            let shown = self.found(&scene);
            let (tree, rename) = (&mut self.tree, &mut self.rename);
            let view = TreeView::new(ui.make_persistent_id("outliner"))
                .indent_hint_style(IndentHintStyle::Line)
                .row_layout(RowLayout::AlignedIcons)
                .fallback_context_menu(|ui, ids| context_menu(ui, ids, session.document.selection(), &requests))
                .max_width(tree_width(whole.width(), &scene))
                .default_node_height(Some(theme::ROW_HEIGHT));
            let top = ui.cursor().min;
            let rows = Rows {
                scene: &scene,
                top: top.y,
                in_view: ui.clip_rect().y_range().expand(theme::ROW_HEIGHT),
                is_dragging: ui.input(|i| i.pointer.any_down()),
                selected: session.document.selection().iter().copied().collect(),
                shares: instancing::all_shares(&scene),
                warned,
                shown: shown.as_ref(),
                reveal,
                requests: &requests,
                at: Cell::new(None),
                count: Cell::new(0),
            };
            actions = view.show_state(ui, tree, |builder| rows.build(builder, rename)).1;
            let end = top.y + rows.count.get() as f32 * theme::ROW_HEIGHT;
            self.empty_room = whole.with_min_y(end.max(whole.top()));
            if let Some(row) = rows.at.get() {
                let place = top + vec2(0.0, row as f32 * theme::ROW_HEIGHT);
                ui.scroll_to_rect(Rect::from_min_size(place, vec2(1.0, theme::ROW_HEIGHT)), None);
            }
        });
        for action in actions {
            self.act(ui, session, &scene, action);
        }
        self.answer(session, requests.into_inner())
    }

    fn search_field(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let clear = if self.search.is_empty() { 0.0 } else { 26.0 };
            let field = TextEdit::singleline(&mut self.search)
                .hint_text("Search…")
                .desired_width(ui.available_width() - clear - 26.0)
                .margin(egui::Margin::symmetric(8, 4));
            let response = ui.add(field).on_hover_text("Lists the nodes with this in their names");
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Search"));
            if response.lost_focus() && ui.input(|i| i.key_pressed(Key::Escape)) {
                self.search.clear();
            }
            if clear > 0.0 && widgets::icon_button(ui, ICON_CLOSE, "Clear the search", theme::WEAK).clicked() {
                self.search.clear();
            }
            outliner_filter::button(ui, &mut self.kind);
        });
        ui.add_space(2.0);
    }

    /// Takes over the document's selection; returns the node to scroll to.
    fn follow_selection(&mut self, session: &EditSession, scene: &Scene) -> Option<NodeId> {
        let selection = session.document.selection();
        let shown: HashSet<_> = self.tree.selected().iter().copied().flatten().collect();
        if shown.len() != selection.len() || selection.iter().any(|id| !shown.contains(id)) {
            self.tree.set_selected(selection.iter().copied().map(Some).collect());
        }
        if self.seen == selection {
            return None;
        }
        self.seen = selection.to_vec();
        for &id in selection {
            let mut at = scene.node(id).and_then(|n| n.parent);
            while let Some(parent) = at {
                self.tree.set_openness(Some(parent), true);
                at = scene.node(parent).and_then(|n| n.parent);
            }
        }
        selection.last().copied()
    }

    /// The nodes of the chosen kind whose name contains the search text, with their ancestors; `None` for all.
    fn found(&self, scene: &Scene) -> Option<HashSet<NodeId>> {
        let wanted = self.search.trim().to_lowercase();
        if wanted.is_empty() && self.kind == KindFilter::All {
            return None;
        }
        let mut found = HashSet::new();
        let fits = |node: &Node| self.kind.takes(node) && node.name.to_lowercase().contains(&wanted);
        for node in scene.nodes().iter().filter(|node| fits(node)) {
            let mut at = Some(node.id);
            while let Some(id) = at.filter(|id| found.insert(*id)) {
                at = scene.node(id).and_then(|n| n.parent);
            }
        }
        Some(found)
    }

    fn act(&mut self, ui: &mut Ui, session: &mut EditSession, scene: &Scene, action: Action<RowId>) {
        match action {
            // On a Shift click on the first row of the range, the tree reports an empty selection.
            Action::SetSelected(rows) if rows.is_empty() && ui.input(|i| i.modifiers.shift) => {}
            Action::SetSelected(rows) => {
                let ids: Vec<_> = rows.into_iter().flatten().collect();
                self.seen.clone_from(&ids);
                session.document.select(ids);
            }
            Action::Activate(activate) => {
                if let Some(id) = activate.selected.into_iter().flatten().last() {
                    self.start_rename(scene, id);
                }
            }
            Action::Drag(drag) if destination(scene, &drag).is_none() => drag.remove_drop_marker(ui),
            Action::Move(drag) => {
                let Some((ids, parent, position)) = destination(scene, &drag) else { return };
                move_rows(session, ids, parent, position);
            }
            // Below the rows: drop at the end of the top level.
            Action::DragExternal(drag) if self.empty_room.contains(drag.position) => {
                let line = self.empty_room.with_max_y(self.empty_room.top() + 2.0);
                ui.painter().rect_filled(line, 0.0, theme::ACCENT);
            }
            Action::MoveExternal(drag) if self.empty_room.contains(drag.position) => {
                let ids: Vec<NodeId> = drag.source.into_iter().flatten().collect();
                let position = scene.children(None).filter(|n| !ids.contains(&n.id)).count();
                move_rows(session, ids, None, position);
            }
            _ => {}
        }
    }

    fn answer(&mut self, session: &mut EditSession, requests: Vec<RowRequest>) -> Vec<Command> {
        let mut run = Vec::new();
        for request in requests {
            match request {
                RowRequest::Rename(id, name) => {
                    self.rename = None;
                    let node = session.document.scene().node(id).map(|n| Node::clone(n));
                    let Some(node) = node.filter(|n| n.name != name) else { continue };
                    if name.trim().is_empty() {
                        let text = format!("A name needs a letter, so it stays “{}”.", node.name);
                        session.messages.push(Message::warning(text));
                    } else {
                        session.apply(Edit::Replace(Node { name, ..node }));
                    }
                }
                RowRequest::EndRename => self.rename = None,
                RowRequest::Visible(widget, id) => session.change(widget, &[id], |n| n.visible = !n.visible),
                RowRequest::Locked(widget, id) => session.change(widget, &[id], |n| n.locked = !n.locked),
                RowRequest::Operator(widget, id, operator) => session.change(widget, &[id], |n| {
                    if let NodeKind::Group(group) = &mut n.kind {
                        group.operator = operator;
                    }
                }),
                RowRequest::Select(ids) => session.document.select(ids),
                RowRequest::Run(command) => run.push(command),
            }
        }
        run
    }
}

fn empty(ui: &mut Ui) {
    ui.add_space(24.0);
    ui.vertical_centered(|ui| {
        ui.label(RichText::new("Nothing here yet").color(theme::TEXT));
        ui.label(
            RichText::new("Add a shape with the buttons above\nor with Shift A, or open a scene:\nFile, Examples.")
                .color(theme::WEAK),
        );
    });
}

/// Width of the rows: that of the panel, or more if deep nesting leaves no room for names.
fn tree_width(panel: f32, scene: &Scene) -> f32 {
    /// Width of a row's icons and switches, minimum width of a name, width of one level of indent.
    const BESIDE_NAME: f32 = 92.0;
    const NAME: f32 = 72.0;
    const INDENT: f32 = 16.0;
    let deepest = scene.depths().iter().copied().max().unwrap_or(0);
    panel.max(deepest as f32 * INDENT + BESIDE_NAME + NAME)
}

fn context_menu(ui: &mut Ui, rows: &[RowId], selection: &[NodeId], requests: &RefCell<Vec<RowRequest>>) {
    let ids: Vec<NodeId> = rows.iter().copied().flatten().collect();
    if !ids.is_empty() && ids.iter().any(|id| !selection.contains(id)) {
        requests.borrow_mut().push(RowRequest::Select(ids));
    }
    ui.set_min_width(210.0);
    let room = widgets::room_beside(ui.ctx());
    if let Some(chosen) = widgets::scrolling(ui, room, context_entries) {
        requests.borrow_mut().push(RowRequest::Run(chosen));
        ui.close();
    }
}

/// The input of all rows.
struct Rows<'a> {
    scene: &'a Scene,
    /// Where the first row begins, and the part of the tree that is in view.
    top: f32,
    in_view: Rangef,
    /// Rows of the selection are also painted at the pointer.
    is_dragging: bool,
    selected: HashSet<NodeId>,
    /// The shares of the types of instancers.
    shares: HashMap<NodeId, f64>,
    warned: &'a HashMap<NodeId, String>,
    shown: Option<&'a HashSet<NodeId>>,
    /// The node to scroll to.
    reveal: Option<NodeId>,
    requests: &'a RefCell<Vec<RowRequest>>,
    /// The index of that row: the tree draws only the rows in view, so a row cannot scroll to itself.
    at: Cell<Option<usize>>,
    /// The number of rows.
    count: Cell<usize>,
}

impl Rows<'_> {
    /// Adds all rows, without recursion: scenes can be nested a thousand levels deep.
    fn build(&self, builder: &mut egui_ltreeview::TreeViewBuilder<'_, RowId>, rename: &mut Option<Rename>) {
        builder.node(NodeBuilder::dir(None).flatten(true).default_open(true));
        let (nodes, depths) = (self.scene.nodes(), self.scene.depths());
        let mut open_groups = 0;
        let mut rows = 0;
        let mut hidden_above: Vec<bool> = Vec::new();
        let mut index = 0;
        while index < nodes.len() {
            let node = &nodes[index];
            let depth = depths[index] as usize;
            while open_groups > depth {
                builder.close_dir();
                open_groups -= 1;
            }
            hidden_above.truncate(depth);
            let inherited = hidden_above.last().copied().unwrap_or(false);
            hidden_above.push(inherited || !node.visible);
            if self.shown.is_some_and(|shown| !shown.contains(&node.id)) {
                index = self.scene.subtree(index).end;
                continue;
            }
            if self.reveal == Some(node.id) {
                self.at.set(Some(rows));
            }
            let y = self.top + rows as f32 * theme::ROW_HEIGHT;
            let is_shown = self.in_view.contains(y) || (self.is_dragging && self.selected.contains(&node.id));
            rows += 1;
            // Rows out of view have a place, but nothing to paint: with ten thousand of them that is most of the time.
            let open = if is_shown { self.row(builder, node, inherited, rename) } else { builder.node(bare(node)) };
            if node.has_children() {
                open_groups += 1;
                if !open {
                    index = self.scene.subtree(index).end;
                    continue;
                }
            }
            index += 1;
        }
        self.count.set(rows);
        for _ in 0..=open_groups {
            builder.close_dir();
        }
    }

    fn row(
        &self,
        builder: &mut egui_ltreeview::TreeViewBuilder<'_, RowId>,
        node: &Node,
        hidden_above: bool,
        rename: &mut Option<Rename>,
    ) -> bool {
        let dim = hidden_above || !node.visible;
        let row = bare(node)
            .icon(|ui| {
                let rect = icons::centered(ui.max_rect(), 14.0);
                let painter = ui.painter().with_clip_rect(ui.clip_rect());
                icons::paint_node(&painter, rect, node);
                if let NodeKind::Group(group) = node.kind
                    && let Some((widget, operator)) = outliner_filter::operators(ui, node, group.operator)
                {
                    self.requests.borrow_mut().push(RowRequest::Operator(widget, node.id, operator));
                }
            })
            .label_ui(|ui| match rename.as_mut().filter(|r| r.id == node.id) {
                Some(rename) => self.name_field(ui, rename),
                None => self.name(ui, node, dim),
            })
            .accessory(|ui| self.switches(ui, node));
        builder.node(row)
    }

    fn name(&self, ui: &mut Ui, node: &Node, dim: bool) {
        let color = match () {
            () if dim => theme::FAINT,
            () if !node.adds() => theme::NEGATIVE,
            () => theme::TEXT,
        };
        let text = if node.name.is_empty() { RichText::new("(no name)").italics() } else { RichText::new(&node.name) };
        ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
            // What follows the name stays visible when the name is truncated.
            let share = self.shares.get(&node.id);
            let warning = self.warned.get(&node.id);
            let signs = u8::from(!node.adds()) + u8::from(warning.is_some());
            let room = 16.0 * f32::from(signs) + if share.is_some() { 44.0 } else { 0.0 };
            ui.scope(|ui| {
                ui.set_max_width((ui.available_width() - room).max(8.0));
                ui.add(egui::Label::new(text.color(color)).selectable(false).truncate());
            });
            let sign = match node.operation {
                Operation::Add => None,
                Operation::Subtract => Some(RichText::new("−")),
                Operation::Intersect => Some(ICON_JOIN_INNER.rich_text().size(14.0)),
            };
            if let Some(sign) = sign {
                let sign = ui.label(sign.color(theme::NEGATIVE).strong());
                sign.on_hover_text(node.operation.label());
            }
            if let Some(warning) = warning {
                ui.label(Severity::Warning.icon().size(14.0)).on_hover_text(warning);
            }
            if let Some(share) = share {
                let text = RichText::new(instancing::percent(*share)).small().color(theme::GROUP);
                ui.label(text).on_hover_text("A type of the instancer, with its share of the copies");
            }
        });
    }

    fn name_field(&self, ui: &mut Ui, rename: &mut Rename) {
        let field = TextEdit::singleline(&mut rename.text).char_limit(MAX_NAME).desired_width(140.0);
        let response = ui.add(field.margin(egui::Margin::symmetric(4, 1)));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("New name"));
        if !rename.focused {
            rename.focused = true;
            response.request_focus();
            let mut state = egui::text_edit::TextEditState::load(ui.ctx(), response.id).unwrap_or_default();
            let end = egui::text::CCursor::new(rename.text.chars().count());
            state.cursor.set_char_range(Some(egui::text::CCursorRange::two(egui::text::CCursor::new(0), end)));
            state.store(ui.ctx(), response.id);
        } else if response.lost_focus() {
            let canceled = ui.input(|i| i.key_pressed(Key::Escape));
            let request =
                if canceled { RowRequest::EndRename } else { RowRequest::Rename(rename.id, rename.text.clone()) };
            self.requests.borrow_mut().push(request);
        }
    }

    /// The eye and the lock at the right end of the row; an open lock appears only under the pointer.
    fn switches(&self, ui: &mut Ui, node: &Node) {
        let row = ui.clip_rect().with_min_y(ui.max_rect().top()).with_max_y(ui.max_rect().bottom());
        let hovered = ui.rect_contains_pointer(row);
        let rest = if hovered { theme::WEAK } else { theme::RESTING };
        ui.spacing_mut().item_spacing.x = 0.0;
        let (icon, verb, color) = match node.visible {
            true => (ICON_VISIBILITY, "Hide", rest),
            false => (ICON_VISIBILITY_OFF, "Show", theme::WARNING),
        };
        let eye = outliner_filter::switch(ui, icon, &format!("{verb} {}", node.name), color);
        if eye.clicked() {
            self.requests.borrow_mut().push(RowRequest::Visible(eye.id, node.id));
        }
        let (icon, verb, color) = match node.locked {
            false => (ICON_LOCK_OPEN, "Lock", if hovered { *rest } else { Color32::TRANSPARENT }),
            true => (ICON_LOCK, "Unlock", *theme::WARNING),
        };
        let lock = outliner_filter::switch(ui, icon, &format!("{verb} {}", node.name), color);
        if lock.clicked() {
            self.requests.borrow_mut().push(RowRequest::Locked(lock.id, node.id));
        }
    }
}

/// A row without content.
fn bare<'a>(node: &Node) -> NodeBuilder<'a, RowId> {
    let row = if node.has_children() { NodeBuilder::dir(Some(node.id)) } else { NodeBuilder::leaf(Some(node.id)) };
    row.activatable(true)
}

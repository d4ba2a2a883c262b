//! The docked panels: a tree of rows, columns and tabs. Every panel but the viewport has a size in points, which it
//! keeps when the window changes; the viewport takes what the others leave.

use std::collections::HashMap;

use egui::{Id, Ui, Vec2, vec2};
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};

use super::dock_split::split;
use super::dock_tabs::{self, DockTabs, GAP, LEAST, is_fixed};
use super::panel::{Panel, PanelPlace};
use super::state::EditorState;
use super::view_state::PointerActivity;
use isolith_document::{Docked, DockedPart, PanelLayout};

/// Least size of what the panels leave to the viewport, in points.
const LEAST_CENTER: f32 = 220.0;
/// Width of a panel at the left without a place of its own there, and its height, in points.
const USUAL: Vec2 = vec2(240.0, 260.0);

/// The panels in their places.
pub struct Dock {
    panels: Vec<Box<dyn Panel>>,
    tree: Tree<usize>,
    /// The size of each part along its row or column, in points, as the artist has set it.
    sizes: HashMap<TileId, f32>,
    /// Whether the artist has changed the layout since the last look.
    is_changed: bool,
}

impl Dock {
    /// Puts the panels into their usual places.
    pub fn new(panels: Vec<Box<dyn Panel>>) -> Self {
        let tree = Tree::empty(Id::unique("docked panels"));
        let mut dock = Self { panels, tree, sizes: HashMap::new(), is_changed: false };
        dock.arrange(None);
        dock
    }

    /// The panels, in the order of their list.
    pub fn panels(&self) -> &[Box<dyn Panel>] {
        &self.panels
    }

    /// The panels, for changes.
    pub fn panels_mut(&mut self) -> impl Iterator<Item = &mut Box<dyn Panel>> {
        self.panels.iter_mut()
    }

    /// Arranges them by a layout, or as usual. A panel that the layout lacks comes to its usual neighbors.
    pub fn arrange(&mut self, layout: Option<&PanelLayout>) {
        let usual = self.usual();
        let layout = layout.filter(|layout| layout.is_sound()).unwrap_or(&usual);
        let (mut tiles, mut sizes, mut found) = (Tiles::default(), HashMap::new(), Vec::new());
        let root = self.build(&layout.root, &mut tiles, &mut sizes, &mut found);
        let mut tree = match root {
            Some(root) => Tree::new(self.tree.id(), root, tiles),
            None => Tree::empty(self.tree.id()),
        };
        for index in (0..self.panels.len()).filter(|index| !found.contains(index)) {
            place_missing(&mut tree, &self.panels, index);
        }
        for (id, index) in panes(&tree) {
            let panel = self.panels[index].as_ref();
            // A layout of an earlier program lacks it.
            let is_extra = matches!(panel.place(), PanelPlace::Beside(_)) && !found.contains(&index);
            let is_closed = is_extra || layout.closed.iter().any(|closed| closed == panel.id());
            tree.set_visible(id, is_fixed(panel) || !is_closed);
        }
        for (id, _) in tree.tiles.iter().filter(|(_, tile)| tile.is_container()) {
            sizes.entry(*id).or_insert(0.0);
        }
        (self.tree, self.sizes) = (tree, sizes);
    }

    /// The usual layout, from the places that the panels ask for.
    fn usual(&self) -> PanelLayout {
        let tabs = |is_wanted: fn(PanelPlace) -> bool, size: f32| {
            let panels = self.panels.iter().filter(|panel| is_wanted(panel.place()));
            let panels: Vec<_> = panels.map(|panel| panel.id().to_owned()).collect();
            let front = panels.first().cloned();
            (!panels.is_empty()).then_some(DockedPart { size, part: Docked::Tabs { panels, front } })
        };
        let extent = |axis: usize, is_wanted: fn(PanelPlace) -> bool| {
            let sizes = self.panels.iter().map(|panel| panel.place()).filter(|place| is_wanted(*place));
            sizes.map(|place| usual_size(place)[axis]).fold(0.0, f32::max)
        };
        let side = [
            tabs(|place| matches!(place, PanelPlace::Left(..)), 0.0),
            tabs(
                |place| matches!(place, PanelPlace::BelowLeft(_)),
                extent(1, |place| matches!(place, PanelPlace::BelowLeft(_))),
            ),
        ];
        let side: Vec<_> = side.into_iter().flatten().collect();
        let width = extent(0, |place| matches!(place, PanelPlace::Left(..) | PanelPlace::BelowLeft(_)));
        let side = (!side.is_empty()).then_some(DockedPart { size: width, part: Docked::Column(side) });
        let right = tabs(
            |place| matches!(place, PanelPlace::Right(..)),
            extent(0, |place| matches!(place, PanelPlace::Right(..))),
        );
        let beside = tabs(
            |place| matches!(place, PanelPlace::Beside(_)),
            extent(0, |place| matches!(place, PanelPlace::Beside(_))),
        );
        let center = tabs(|place| place == PanelPlace::Center, 0.0);
        let middle = [side, center, beside, right].into_iter().flatten().collect();
        let extra = self.panels.iter().filter(|panel| matches!(panel.place(), PanelPlace::Beside(_)));
        let closed = extra.map(|panel| panel.id().to_owned()).collect();
        let lower = tabs(
            |place| matches!(place, PanelPlace::Lower(_)),
            extent(1, |place| matches!(place, PanelPlace::Lower(_))),
        );
        let rows = [Some(DockedPart { size: 0.0, part: Docked::Row(middle) }), lower];
        PanelLayout { root: Docked::Column(rows.into_iter().flatten().collect()), closed }
    }

    /// Makes the tiles of a part; `None` for one without known panels.
    fn build(
        &self,
        part: &Docked,
        tiles: &mut Tiles<usize>,
        sizes: &mut HashMap<TileId, f32>,
        found: &mut Vec<usize>,
    ) -> Option<TileId> {
        match part {
            Docked::Tabs { panels, front } => {
                let mut children = Vec::new();
                let mut active = None;
                for id in panels {
                    let Some(index) = self.panels.iter().position(|panel| panel.id() == id) else { continue };
                    if found.contains(&index) {
                        continue;
                    }
                    found.push(index);
                    let tile = tiles.insert_pane(index);
                    active = active.or((front.as_ref() == Some(id)).then_some(tile));
                    children.push(tile);
                }
                if children.is_empty() {
                    return None;
                }
                let tabs = tiles.insert_tab_tile(children);
                if let (Some(active), Some(Tile::Container(Container::Tabs(inner)))) = (active, tiles.get_mut(tabs)) {
                    inner.set_active(active);
                }
                Some(tabs)
            }
            Docked::Row(parts) | Docked::Column(parts) => {
                let mut children = Vec::new();
                for DockedPart { size, part } in parts {
                    if let Some(child) = self.build(part, tiles, sizes, found) {
                        sizes.insert(child, *size);
                        children.push(child);
                    }
                }
                let is_row = matches!(part, Docked::Row(_));
                match children.len() {
                    0 => None,
                    1 => children.pop(),
                    _ if is_row => Some(tiles.insert_horizontal_tile(children)),
                    _ => Some(tiles.insert_vertical_tile(children)),
                }
            }
        }
    }

    /// The layout now.
    pub fn layout(&self) -> PanelLayout {
        let empty = || Docked::Tabs { panels: Vec::new(), front: None };
        let root = self.tree.root().map_or_else(empty, |root| self.part(root));
        let closed = panes(&self.tree).filter(|(id, _)| !self.tree.is_visible(*id));
        let mut closed: Vec<_> = closed.map(|(_, index)| self.panels[index].id().to_owned()).collect();
        closed.sort_unstable();
        PanelLayout { root, closed }
    }

    fn part(&self, id: TileId) -> Docked {
        let tabs = |ids: &[TileId], front: Option<TileId>| {
            let name = |id: &TileId| self.tree.tiles.get_pane(id).map(|index| self.panels[*index].id().to_owned());
            Docked::Tabs { panels: ids.iter().filter_map(name).collect(), front: front.as_ref().and_then(name) }
        };
        match self.tree.tiles.get(id) {
            Some(Tile::Container(Container::Tabs(inner))) => tabs(&inner.children, inner.active),
            Some(Tile::Container(Container::Linear(inner))) => {
                let size = |id: &TileId| self.sizes.get(id).copied().unwrap_or(0.0).round();
                let parts = inner.children.iter().map(|id| DockedPart { size: size(id), part: self.part(*id) });
                let parts = parts.collect();
                if inner.dir == LinearDir::Horizontal { Docked::Row(parts) } else { Docked::Column(parts) }
            }
            _ => tabs(&[id], Some(id)),
        }
    }

    /// Whether the artist has changed the layout since the last call.
    pub fn take_change(&mut self) -> bool {
        std::mem::take(&mut self.is_changed)
    }

    /// Whether this panel is open.
    pub fn is_open(&self, index: usize) -> bool {
        panes(&self.tree).any(|(id, pane)| pane == index && self.tree.is_visible(id))
    }

    /// Whether this panel is in front of those that share its place.
    pub fn is_in_front(&self, id: &str) -> bool {
        let active = self.tree.active_tiles();
        active.iter().any(|tile| self.tree.tiles.get_pane(tile).is_some_and(|index| self.panels[*index].id() == id))
    }

    /// Opens or closes a panel. The viewport stays; one behind others comes to the front first.
    pub fn toggle(&mut self, id: &str) {
        let Some((tile, index)) = panes(&self.tree).find(|(_, index)| self.panels[*index].id() == id) else { return };
        let closes = self.tree.is_visible(tile) && self.is_in_front(id) && !is_fixed(self.panels[index].as_ref());
        self.tree.set_visible(tile, !closes);
        if !closes {
            self.tree.make_active(|tile_id, _| tile_id == tile);
        }
        self.is_changed = true;
    }

    /// Shows 1, 2 or 4 viewports in the room of those that are shown.
    pub fn split(&mut self, count: usize, room: Vec2) {
        let center = self.panels.iter().find(|panel| is_fixed(panel.as_ref())).map(|panel| panel.id());
        if let Some(center) = center {
            let layout = split(&self.layout(), center, count, room);
            self.arrange(Some(&layout));
            self.is_changed = true;
        }
    }

    /// Shows the panels.
    pub fn show(&mut self, state: &mut EditorState, ui: &mut Ui) {
        let area = ui.available_rect_before_wrap();
        self.inherit_sizes();
        self.tree.simplify(&dock_tabs::simplification());
        if let Some(root) = self.tree.root() {
            self.fit(root, area.size(), state);
        }
        let without_bar = self.lone_center();
        let mut tabs = DockTabs::new(&mut self.panels, state, without_bar);
        self.tree.ui(&mut tabs, ui);
        let DockTabs { is_resized, is_changed, closed, .. } = tabs;
        for id in closed {
            self.tree.set_visible(id, false);
        }
        if is_resized {
            self.take_sizes(state);
        }
        self.is_changed |= is_changed;
        if without_bar.is_none()
            && !self.panels.iter().any(|panel| is_fixed(panel.as_ref()) && self.is_in_front(panel.id()))
        {
            // Behind another panel it neither follows the pointer nor takes keys.
            (state.view.transforming, state.view.is_navigating) = (None, false);
            state.view.pointer = PointerActivity::Away;
        }
    }

    /// A row or column that a drop has put around a part is as large as that part was; the last part of one that goes
    /// is as large as it was.
    fn inherit_sizes(&mut self) {
        if let Some(root) = self.tree.root() {
            self.sizes.entry(root).or_insert(0.0);
        }
        let linears = self.tree.tiles.iter().filter_map(|(id, tile)| match tile {
            Tile::Container(Container::Linear(linear)) => Some((*id, linear.children.clone())),
            _ => None,
        });
        for (id, children) in linears.collect::<Vec<_>>() {
            if let ([only], Some(size)) = (&*children, self.sizes.get(&id)) {
                self.sizes.insert(*only, *size);
            } else if !self.sizes.contains_key(&id) {
                let sizes = children.iter().filter_map(|child| self.sizes.remove(child));
                let size = sizes.fold(0.0, f32::max);
                self.sizes.insert(id, size);
            }
        }
    }

    /// The tabs that show the viewport and nothing else.
    fn lone_center(&self) -> Option<TileId> {
        let (center, _) = panes(&self.tree).find(|(_, index)| is_fixed(self.panels[*index].as_ref()))?;
        let tabs = self.tree.tiles.parent_of(center)?;
        let Some(Tile::Container(Container::Tabs(inner))) = self.tree.tiles.get(tabs) else { return None };
        let mut others = inner.children.iter().filter(|id| **id != center);
        others.all(|id| !self.tree.is_visible(*id)).then_some(tabs)
    }

    /// Gives each part of a row or column its size, and the rest to the one with the viewport.
    fn fit(&mut self, id: TileId, room: Vec2, state: &EditorState) {
        match self.tree.tiles.get(id) {
            Some(Tile::Container(Container::Tabs(tabs))) => {
                if let Some(front) = tabs.next_active(&self.tree.tiles) {
                    self.fit(front, room, state);
                }
            }
            Some(Tile::Container(Container::Linear(linear))) => {
                let (linear, axis) = (linear.clone(), usize::from(linear.dir == LinearDir::Vertical));
                let shown = self.shown(&linear);
                let Some(open) = self.open_end(&shown) else { return };
                let available = (room[axis] - GAP * (shown.len() - 1) as f32).max(0.0);
                let wanted: Vec<_> = shown.iter().map(|child| self.wanted(*child, axis, state)).collect();
                let fixed: f32 = (0..shown.len()).filter(|i| *i != open).map(|i| wanted[i]).sum();
                let most = (available - LEAST_CENTER.min(0.5 * available)).max(0.0);
                let shrink = if fixed > most { most / fixed } else { 1.0 };
                let mut given: Vec<_> = wanted.iter().map(|size| (size * shrink).floor()).collect();
                given[open] = 0.0;
                given[open] = (available - given.iter().sum::<f32>()).max(1.0);
                if let Some(Tile::Container(Container::Linear(linear))) = self.tree.tiles.get_mut(id) {
                    for (child, size) in shown.iter().zip(&given) {
                        linear.shares.set_share(*child, *size);
                    }
                }
                for (child, size) in shown.iter().zip(given) {
                    let mut room = room;
                    room[axis] = size;
                    self.fit(*child, room, state);
                }
            }
            _ => {}
        }
    }

    fn shown(&self, linear: &Linear) -> Vec<TileId> {
        linear.children.iter().copied().filter(|child| self.tree.is_visible_in_layout(*child)).collect()
    }

    /// Which of these parts takes what the others leave: the one with the viewport, otherwise the first.
    fn open_end(&self, shown: &[TileId]) -> Option<usize> {
        let holds =
            |id: &TileId| leaves(&self.tree, *id).into_iter().any(|index| is_fixed(self.panels[index].as_ref()));
        shown.iter().position(holds).or((!shown.is_empty()).then_some(0))
    }

    /// The size of a part along an axis, in points.
    fn wanted(&self, id: TileId, axis: usize, state: &EditorState) -> f32 {
        if let Some(slim) = self.slim(id, axis, state) {
            return slim + dock_tabs::BAR;
        }
        let leaves = leaves(&self.tree, id);
        let places = || leaves.iter().map(|index| self.panels[*index].place());
        let least = places().map(|place| least_size(place)[axis]).fold(LEAST, f32::max);
        let usual = places().map(|place| usual_size(place)[axis]).fold(0.0, f32::max);
        self.sizes.get(&id).copied().filter(|size| *size > 0.0).unwrap_or(usual).max(least)
    }

    /// The height of tabs whose front panel has little to show.
    fn slim(&self, id: TileId, axis: usize, state: &EditorState) -> Option<f32> {
        let Some(Tile::Container(Container::Tabs(tabs))) = self.tree.tiles.get(id) else { return None };
        let front = tabs.next_active(&self.tree.tiles)?;
        let index = self.tree.tiles.get_pane(&front)?;
        self.panels[*index].slim_height(state).filter(|_| axis == 1)
    }

    /// Keeps the sizes that the artist has dragged.
    fn take_sizes(&mut self, state: &EditorState) {
        let linears = self.tree.tiles.tiles().filter_map(|tile| match tile {
            Tile::Container(Container::Linear(linear)) => Some(linear.clone()),
            _ => None,
        });
        for linear in linears.collect::<Vec<_>>() {
            let axis = usize::from(linear.dir == LinearDir::Vertical);
            let shown = self.shown(&linear);
            let open = self.open_end(&shown);
            for (at, child) in shown.iter().enumerate() {
                if Some(at) != open && self.slim(*child, axis, state).is_none() {
                    self.sizes.insert(*child, linear.shares[*child].round());
                }
            }
        }
    }
}

/// The panes with the panels that they show.
fn panes(tree: &Tree<usize>) -> impl Iterator<Item = (TileId, usize)> + use<> {
    let panes = tree.tiles.iter().filter_map(|(id, tile)| match tile {
        Tile::Pane(index) => Some((*id, *index)),
        Tile::Container(_) => None,
    });
    panes.collect::<Vec<_>>().into_iter()
}

/// The panels of a part.
fn leaves(tree: &Tree<usize>, id: TileId) -> Vec<usize> {
    match tree.tiles.get(id) {
        Some(Tile::Pane(index)) => vec![*index],
        Some(Tile::Container(container)) => container.children().flat_map(|child| leaves(tree, *child)).collect(),
        None => Vec::new(),
    }
}

/// Puts a panel beside one that has the same kind of place, or at the end of the window.
fn place_missing(tree: &mut Tree<usize>, panels: &[Box<dyn Panel>], index: usize) {
    let kind = std::mem::discriminant(&panels[index].place());
    let pane = tree.tiles.insert_pane(index);
    let neighbor = panes(tree).find(|(id, other)| {
        *id != pane && std::mem::discriminant(&panels[*other].place()) == kind && tree.tiles.parent_of(*id).is_some()
    });
    let parent = neighbor.and_then(|(id, _)| tree.tiles.parent_of(id));
    if let Some(Tile::Container(container)) = parent.and_then(|parent| tree.tiles.get_mut(parent)) {
        container.add_child(pane);
        return;
    }
    let tabs = tree.tiles.insert_tab_tile(vec![pane]);
    tree.root = Some(match tree.root {
        None => tabs,
        Some(root) if matches!(panels[index].place(), PanelPlace::Left(..) | PanelPlace::BelowLeft(_)) => {
            tree.tiles.insert_horizontal_tile(vec![tabs, root])
        }
        Some(root) if matches!(panels[index].place(), PanelPlace::Lower(_)) => {
            tree.tiles.insert_vertical_tile(vec![root, tabs])
        }
        Some(root) => tree.tiles.insert_horizontal_tile(vec![root, tabs]),
    });
}

/// The size of a panel before the artist has set it, in points.
fn usual_size(place: PanelPlace) -> Vec2 {
    match place {
        PanelPlace::Left(width, _) | PanelPlace::Right(width, _) | PanelPlace::Beside(width) => vec2(width, USUAL.y),
        PanelPlace::BelowLeft(height) | PanelPlace::Lower(height) => vec2(USUAL.x, height),
        PanelPlace::Top | PanelPlace::Bottom | PanelPlace::Center => USUAL,
    }
}

fn least_size(place: PanelPlace) -> Vec2 {
    match place {
        PanelPlace::Left(_, least) | PanelPlace::Right(_, least) => vec2(least, LEAST),
        _ => vec2(LEAST, LEAST),
    }
}

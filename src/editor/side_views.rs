//! Several viewports at once. The one under the pointer is the active one: its view is that of the editor, so that keys
//! and commands mean it. The others wait in slots, and are swapped in while they are shown.

use egui::Pos2;

use super::navigation::Navigation;
use super::state::EditorState;
use super::view_slots::{SIDES, VIEWS};
use super::view_state::{Picture, PointerActivity, ViewSettings};
use isolith_field::Shading;

impl EditorState {
    /// Sets the pictures of all viewports.
    pub(super) fn set_pictures(&mut self, main: &Picture, beside: &[Picture]) {
        for (index, picture) in std::iter::once(main).chain(beside).take(VIEWS).enumerate() {
            let place =
                if index == self.views.active { &mut self.picture } else { &mut self.views.slots[index].picture };
            place.clone_from(picture);
        }
    }

    /// Makes a viewport the active one.
    pub(super) fn activate_view(&mut self, index: usize) {
        if index == self.views.active {
            return;
        }
        let mut views = std::mem::take(&mut self.views);
        views.slots[views.active].swap(&mut self.view, &mut self.picture);
        views.slots[index].swap(&mut self.view, &mut self.picture);
        views.active = index;
        (self.view.pointer, self.view.is_navigating) = (PointerActivity::Away, false);
        self.views = views;
    }

    /// Begins a frame: no viewport is shown yet.
    pub(super) fn begin_views(&mut self) {
        self.views.shown = [false; VIEWS];
    }

    /// Ends a frame: a viewport that is closed gives its keys to the main one.
    pub(super) fn end_views(&mut self) {
        if !self.views.shown[self.views.active] {
            self.activate_view(0);
        }
    }

    /// Another document is open: each viewport looks at it anew.
    pub(super) fn reset_views(&mut self) {
        self.activate_view(0);
        for slot in &mut self.views.slots {
            (slot.is_new, slot.through) = (true, None);
        }
    }

    /// Shows a viewport with its own view. The pointer makes it the active one unless something is in progress.
    pub(super) fn show_view<R>(&mut self, index: usize, pointer: Option<Pos2>, show: impl FnOnce(&mut Self) -> R) -> R {
        self.views.shown[index] = true;
        let is_free = self.view.transforming.is_none() && !self.view.wants_box && !self.view.wants_lasso;
        if pointer.is_some() && is_free && !self.view.is_navigating {
            self.activate_view(index);
        }
        if index == self.views.active {
            self.look_at_first(index, self.views.slots[0].shading);
            return show(self);
        }
        let shading = self.view.shading;
        let mut slot = std::mem::take(&mut self.views.slots[index]);
        slot.swap(&mut self.view, &mut self.picture);
        // What is in progress belongs to the active one.
        let (transforming, pointer_activity) = (self.view.transforming.take(), self.view.pointer);
        let (events, flags) = (
            std::mem::take(&mut self.view.modal_events),
            [self.view.wants_box, self.view.wants_lasso, self.view.is_navigating],
        );
        (self.view.wants_box, self.view.wants_lasso) = (false, false);
        std::mem::swap(&mut self.views.slots[index].is_new, &mut slot.is_new);
        self.look_at_first(index, shading);
        let result = show(self);
        slot.is_new = self.views.slots[index].is_new;
        (self.view.transforming, self.view.pointer, self.view.modal_events) = (transforming, pointer_activity, events);
        [self.view.wants_box, self.view.wants_lasso, self.view.is_navigating] = flags;
        slot.swap(&mut self.view, &mut self.picture);
        self.views.slots[index] = slot;
        result
    }

    /// The first look of a viewport beside the main one, in the shading of another one.
    fn look_at_first(&mut self, index: usize, shading: Shading) {
        let Some((_, _, side)) = index.checked_sub(1).map(|beside| SIDES[beside]) else { return };
        if self.views.slots[index].is_new && !self.derived.is_preparing() {
            self.views.slots[index].is_new = false;
            self.view.shading = shading;
            self.view.navigation = Navigation::default();
            self.view.navigation.look_along(side);
            self.frame_all();
        }
    }

    /// The views of the viewports beside the active one that are shown, for the renderer.
    pub(super) fn views_beside(&self) -> Vec<(usize, ViewSettings)> {
        let mut views = Vec::new();
        for (index, slot) in self.views.slots.iter().enumerate() {
            if index != self.views.active && self.views.shown[index] {
                let own = (slot.navigation, slot.size_px, slot.shading, slot.view_mode);
                views.push((index, self.settings_of(own, false)));
            }
        }
        views
    }
}

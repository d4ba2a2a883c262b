//! Hands events to egui in the order of their arrival, however slow the frames are.
//!
//! egui evaluates all events of a frame together: after "1 Tab 2" in one frame both digits land in the second field,
//! and a press and a release at two positions become one click at the second. Here each event that changes the meaning
//! of later ones (a button, Tab, Enter, Escape, a shortcut) ends a pass; later events wait for the next pass.
//!
//! A press outside an open popup closes the popup and does nothing else.

use std::collections::{HashSet, VecDeque};

use egui::{Context, Event, Key, Modifiers, Order, Plugin, PointerButton, Popup, Pos2, RawInput, Ui};

/// The queue of events that wait for a later pass.
#[derive(Default)]
pub struct InputOrder {
    waiting: VecDeque<Event>,
    held: HashSet<Key>,
    /// The next pass gets no events: first show whatever the last pass opened or focused.
    settling: bool,
    /// Buttons whose press closed a popup: ignore their release, too.
    swallowed: Vec<PointerButton>,
    /// Close popups before the next pass: a field in one of them has yet to handle the loss of the focus.
    closing: bool,
    /// When the last frame began, in seconds of the program's clock.
    time: Option<f64>,
}

/// Longest time between press and release of a click: in seconds, and in frames if frames are slow. Press and release
/// take a pass each.
const LONGEST_CLICK: f64 = 0.8;
const FRAMES_OF_CLICK: f64 = 8.0;

impl Plugin for InputOrder {
    fn debug_name(&self) -> &'static str {
        "input order"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        self.waiting.extend(input.events.drain(..));
        // A pass that repeats a discarded one shows the same state again.
        if ctx.current_pass_index() > 0 {
            return;
        }
        self.allow_slow_clicks(ctx, input.time);
        if std::mem::take(&mut self.closing) {
            Popup::close_all(ctx);
        }
        if std::mem::take(&mut self.settling) && !self.waiting.is_empty() {
            return;
        }
        input.events = self.next_events(ctx.text_edit_focused());
        self.close_popups_instead(ctx, &mut input.events);
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if self.closing || !self.waiting.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}

impl InputOrder {
    /// Whether events wait for a later pass.
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    fn allow_slow_clicks(&mut self, ctx: &Context, time: Option<f64>) {
        let Some(now) = time else { return };
        let frame = now - self.time.replace(now).unwrap_or(now);
        let longest = LONGEST_CLICK.max(FRAMES_OF_CLICK * frame);
        ctx.options_mut(|options| options.input_options.max_click_duration = longest);
    }

    /// The events up to the next one that changes the meaning of later ones.
    fn next_events(&mut self, typing: bool) -> Vec<Event> {
        let mut events = Vec::new();
        while let Some(event) = self.waiting.front() {
            let ends = self.ends_pass(event, typing);
            if ends && comes_later(&events, event) {
                break;
            }
            let is_key = matches!(event, Event::Key { .. });
            let Some(event) = self.waiting.pop_front() else { break };
            self.follow_keys(&event);
            events.push(event);
            if ends {
                self.take_what_belongs(&mut events, typing);
                // A field that gets the focus by a key selects its text in the pass after that.
                self.settling = is_key || !self.waiting.is_empty();
                break;
            }
        }
        events
    }

    fn ends_pass(&self, event: &Event, typing: bool) -> bool {
        match event {
            Event::PointerButton { .. } => true,
            Event::Key { key, pressed: true, modifiers, .. } => {
                // A held key repeats faster than slow frames can follow.
                !self.held.contains(key) && (!typing || ends_typing(*key, *modifiers))
            }
            _ => false,
        }
    }

    fn follow_keys(&mut self, event: &Event) {
        match event {
            Event::Key { key, pressed: true, .. } => {
                self.held.insert(*key);
            }
            Event::Key { key, pressed: false, .. } => {
                self.held.remove(key);
            }
            // A window without focus receives no release events.
            Event::WindowFocused(_) => self.held.clear(),
            _ => {}
        }
    }

    /// Appends the text of the key just taken, and key releases: they do not change the meaning of later events.
    fn take_what_belongs(&mut self, events: &mut Vec<Event>, typing: bool) {
        while let Some(event) = self.waiting.front() {
            match event {
                Event::Text(_) if !typing && matches!(events.last(), Some(Event::Key { pressed: true, .. })) => {}
                Event::Key { pressed: false, .. } => {}
                _ => break,
            }
            let Some(event) = self.waiting.pop_front() else { break };
            self.follow_keys(&event);
            events.push(event);
        }
    }

    /// Removes presses outside an open popup and the matching releases; the popup closes.
    fn close_popups_instead(&mut self, ctx: &Context, events: &mut Vec<Event>) {
        let is_open = Popup::is_any_open(ctx);
        let pointer = ctx.pointer_latest_pos();
        events.retain(|event| match event {
            Event::PointerButton { pos, button, pressed: true, .. } => {
                let swallow = is_open && is_beside_popups(ctx, *pos);
                if swallow {
                    self.swallowed.push(*button);
                    self.close_popups(ctx);
                }
                !swallow
            }
            Event::PointerButton { button, pressed: false, .. } => {
                let place = self.swallowed.iter().position(|swallowed| swallowed == button);
                place.map(|place| self.swallowed.swap_remove(place)).is_none()
            }
            // The wheel does not scroll the content behind a popup either.
            Event::MouseWheel { .. } | Event::Zoom(_) => {
                !(is_open && pointer.is_some_and(|pos| is_beside_popups(ctx, pos)))
            }
            _ => true,
        });
    }

    /// Closes all popups: at once, or after a text field in one of them has taken its text.
    fn close_popups(&mut self, ctx: &Context) {
        if ctx.text_edit_focused() {
            ctx.memory_mut(|memory| memory.stop_text_input());
            self.closing = true;
        } else {
            Popup::close_all(ctx);
        }
    }
}

/// Whether an event needs a later pass than the events before it: a field that loses the focus ignores text of the same
/// pass, and a drag must arrive before the release.
fn comes_later(before: &[Event], event: &Event) -> bool {
    before.iter().any(|event| match event {
        Event::Text(_) | Event::Paste(_) | Event::Cut | Event::Copy | Event::Ime(_) => true,
        Event::Key { pressed, .. } => *pressed,
        _ => false,
    }) || (matches!(event, Event::PointerButton { pressed: false, .. })
        && before.iter().any(|event| matches!(event, Event::PointerMoved(_))))
}

fn is_beside_popups(ctx: &Context, pos: Pos2) -> bool {
    ctx.layer_id_at(pos).is_none_or(|layer| layer.order < Order::Foreground)
}

/// Whether a key does more than edit the text.
fn ends_typing(key: Key, modifiers: Modifiers) -> bool {
    use Key::{
        A, ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Backspace, C, Delete, End, Enter, Escape, Home, Tab, V, X, Y, Z,
    };
    match key {
        Tab | Enter | Escape | ArrowUp | ArrowDown => true,
        A | C | V | X | Y | Z | ArrowLeft | ArrowRight | Backspace | Delete | Home | End => false,
        _ => modifiers.command || is_function_key(key),
    }
}

fn is_function_key(key: Key) -> bool {
    (Key::F1..=Key::F35).contains(&key)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(key: Key, pressed: bool) -> Event {
        Event::Key { key, pressed, repeat: false, modifiers: Modifiers::NONE, physical_key: None }
    }

    fn button(pressed: bool) -> Event {
        Event::PointerButton { pos: Pos2::ZERO, button: PointerButton::Primary, pressed, modifiers: Modifiers::NONE }
    }

    /// The lengths of the groups of events for successive passes.
    fn groups(typing: bool, events: Vec<Event>) -> Vec<usize> {
        let mut order = InputOrder { waiting: events.into(), ..InputOrder::default() };
        std::iter::from_fn(|| {
            (!order.waiting.is_empty()).then(|| {
                order.settling = false;
                order.next_events(typing).len()
            })
        })
        .collect()
    }

    fn text(text: &str) -> Event {
        Event::Text(text.into())
    }

    #[test]
    fn text_stays_together_and_tab_parts_it() {
        let typed = |c: &str, k| [key(k, true), text(c), key(k, false)];
        let mut events = Vec::from(typed("1", Key::Num1));
        events.extend(typed("2", Key::Num2));
        assert_eq!(groups(true, events.clone()), [6]);
        events.insert(3, key(Key::Tab, true));
        assert_eq!(groups(true, events), [3, 1, 3]);
    }

    #[test]
    fn each_button_and_each_shortcut_stands_alone() {
        let moved = || Event::PointerMoved(Pos2::ZERO);
        let drag = vec![moved(), button(true), moved(), moved(), button(false), button(true)];
        assert_eq!(groups(false, drag), [2, 2, 1, 1]);
        let keys = vec![key(Key::X, true), text("x"), key(Key::X, false), key(Key::F2, true), text("a")];
        assert_eq!(groups(false, keys), [3, 2]);
    }

    #[test]
    fn a_held_key_does_not_fill_the_queue() {
        let mut events = vec![key(Key::ArrowDown, true); 100];
        events.push(key(Key::ArrowDown, false));
        assert_eq!(groups(false, events), [1, 100]);
    }
}

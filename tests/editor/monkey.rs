//! A monkey at the editor: seeded keys, clicks, drags and texts. Whatever it does, undo leads back to the first
//! document byte for byte, and redo to the last.

use egui::{Event, Key, Modifiers, OutputCommand, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use isolith::document::Document;
use isolith::editor::Editor;
use isolith::scene::{Scene, file};

use super::scale::note;
use super::{open_in, scene};
use crate::random_scene::Random;

/// Environment variable with the number of events for a long run.
const LONG_RUN: &str = "ISOLITH_MONKEY";
/// Events of the run in the suite.
const SHORT_RUN: usize = 500;
/// Events between two looks at the history: fewer than it holds steps.
const PER_ROUND: usize = 500;
/// Above this many nodes the monkey deletes everything that it can.
const MOST_NODES: usize = 120;
/// The upper end of what it clicks at: the menu File replaces the document, and with it the history.
const BELOW_MENUS: f32 = 34.0;
const WINDOW: egui::Vec2 = vec2(1280.0, 800.0);

struct Monkey {
    random: Random,
    copied: Option<String>,
    /// What it did last, for the message of a failure.
    done: Vec<String>,
}

/// Keys that no shortcut of the menu File has, without F3, which finds its commands by name.
const KEYS: [Key; 40] = [
    Key::A,
    Key::B,
    Key::C,
    Key::D,
    Key::E,
    Key::F,
    Key::G,
    Key::H,
    Key::I,
    Key::K,
    Key::L,
    Key::M,
    Key::R,
    Key::T,
    Key::U,
    Key::V,
    Key::W,
    Key::X,
    Key::Y,
    Key::Z,
    Key::Num1,
    Key::Num3,
    Key::Num7,
    Key::Slash,
    Key::End,
    Key::Home,
    Key::Delete,
    Key::Escape,
    Key::Enter,
    Key::Enter,
    Key::Tab,
    Key::Backspace,
    Key::OpenBracket,
    Key::CloseBracket,
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
    Key::F2,
    Key::Escape,
];

const MODIFIERS: [Modifiers; 5] =
    [Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND, Modifiers::ALT];

impl Monkey {
    fn pos(&mut self) -> Pos2 {
        let (x, y) = (self.random.unit() as f32, self.random.unit() as f32);
        Pos2::new(x * WINDOW.x, BELOW_MENUS + y * (WINDOW.y - BELOW_MENUS))
    }

    fn act(&mut self, harness: &mut Harness<'_, Editor>) {
        let modifiers = self.random.pick(&MODIFIERS);
        let what = match self.random.below(20) {
            0..=6 => self.key(harness, modifiers),
            7..=10 => self.click(harness, modifiers),
            11..=14 => self.drag(harness, modifiers),
            15..=16 => self.text(harness),
            17..=18 => self.clipboard(harness),
            _ => self.history(harness),
        };
        self.done.push(what);
        harness.step();
        self.copied = harness
            .output()
            .platform_output
            .commands
            .iter()
            .find_map(|command| if let OutputCommand::CopyText(text) = command { Some(text.clone()) } else { None })
            .or(self.copied.take());
    }

    /// Selects a node or two: with something selected more can happen.
    fn choose(&mut self, harness: &mut Harness<'_, Editor>) {
        let ids: Vec<_> = harness.state().document().scene().nodes().iter().map(|node| node.id).collect();
        if !ids.is_empty() {
            let chosen = (0..1 + self.random.below(2)).map(|_| self.random.pick(&ids)).collect();
            harness.state_mut().document_mut().select(chosen);
            harness.step();
        }
    }

    fn key(&mut self, harness: &mut Harness<'_, Editor>, modifiers: Modifiers) -> String {
        let key = self.random.pick(&KEYS);
        harness.key_press_modifiers(modifiers, key);
        harness.step();
        format!("{modifiers:?} {key:?}")
    }

    fn button(
        &mut self,
        harness: &mut Harness<'_, Editor>,
        pos: Pos2,
        pressed: bool,
        button: PointerButton,
        modifiers: Modifiers,
    ) {
        harness.event(Event::ModifiersChanged(modifiers));
        harness.event(Event::PointerMoved(pos));
        harness.event(Event::PointerButton { pos, button, pressed, modifiers });
        harness.event(Event::ModifiersChanged(Modifiers::NONE));
        harness.step();
    }

    fn click(&mut self, harness: &mut Harness<'_, Editor>, modifiers: Modifiers) -> String {
        let (pos, right) = (self.pos(), self.random.once_in(5));
        let button = if right { PointerButton::Secondary } else { PointerButton::Primary };
        self.button(harness, pos, true, button, modifiers);
        self.button(harness, pos, false, button, modifiers);
        format!("{modifiers:?} click {button:?} {pos:?}")
    }

    fn drag(&mut self, harness: &mut Harness<'_, Editor>, modifiers: Modifiers) -> String {
        let (from, by) = (self.pos(), vec2(self.random.unit() as f32 - 0.5, self.random.unit() as f32 - 0.5) * 200.0);
        self.button(harness, from, true, PointerButton::Primary, modifiers);
        for step in 1..=3 {
            harness.event(Event::PointerMoved(from + by * (step as f32 / 3.0)));
            harness.step();
        }
        if self.random.once_in(6) {
            harness.key_press(Key::Escape);
            harness.step();
        }
        self.button(harness, from + by, false, PointerButton::Primary, modifiers);
        format!("{modifiers:?} drag {from:?} {by:?}")
    }

    fn text(&mut self, harness: &mut Harness<'_, Editor>) -> String {
        let text = self.random.pick(&["1", "0.5", "-2", "3*2", "x", "y", "box", "sphere", ".", "90"]);
        harness.event(Event::Text(text.into()));
        text.into()
    }

    fn clipboard(&mut self, harness: &mut Harness<'_, Editor>) -> String {
        let event = match (self.random.below(3), &self.copied) {
            (0, Some(text)) => Event::Paste(text.clone()),
            (1, _) => Event::Cut,
            _ => Event::Copy,
        };
        harness.event(event);
        "clipboard".into()
    }

    fn history(&mut self, harness: &mut Harness<'_, Editor>) -> String {
        let keys = [(Modifiers::COMMAND, Key::Z), (Modifiers::COMMAND, Key::Y)];
        let (modifiers, key) = self.random.pick(&keys);
        harness.key_press_modifiers(modifiers, key);
        harness.step();
        format!("{key:?} of the history")
    }
}

fn bytes(harness: &Harness<'_, Editor>) -> String {
    file::to_json(harness.state().document().resting()).expect("a scene has a text")
}

/// One round from a document; returns the last one.
fn round(seed: u64, scene: Scene, events: usize) -> Scene {
    let mut harness = open_in(Document::new(scene), WINDOW);
    let first = bytes(&harness);
    let mut monkey = Monkey { random: Random::new(seed), copied: None, done: Vec::new() };
    for index in 0..events {
        if index % 25 == 0 {
            // Out of whatever has been opened; that deselects, too.
            harness.key_press(Key::Escape);
            harness.step();
        }
        if monkey.random.once_in(4) {
            monkey.choose(&mut harness);
        }
        monkey.act(&mut harness);
        let scene = harness.state().document().scene();
        let told = || format!("seed {seed}, event {index}: {:?}", &monkey.done[monkey.done.len().saturating_sub(6)..]);
        let known = harness.state().document().selection().iter().all(|id| scene.node(*id).is_some());
        assert!(known, "{}", told());
        if scene.nodes().len() > MOST_NODES {
            for (modifiers, key) in [
                (Modifiers::NONE, Key::Escape),
                (Modifiers::NONE, Key::Escape),
                (Modifiers::COMMAND, Key::A),
                (Modifiers::NONE, Key::Delete),
            ] {
                harness.key_press_modifiers(modifiers, key);
                harness.run_steps(2);
            }
            let few = harness.state().document().scene().nodes().len();
            if few > MOST_NODES {
                harness.state_mut().document_mut().undo();
            }
        }
    }
    for _ in 0..3 {
        harness.key_press(Key::Escape);
        harness.run_steps(2);
    }
    let changes = harness.state().document().revision();
    assert!(
        changes >= 5,
        "seed {seed}: {changes} changes from {events} events: a monkey that does nothing shows nothing"
    );
    let last = bytes(&harness);
    let end = Scene::clone(harness.state().document().resting());
    let document = harness.state_mut().document_mut();
    let mut steps = 0;
    while document.undo() {
        steps += 1;
    }
    assert!(bytes(&harness) == first, "seed {seed}: {steps} steps back is not the first document");
    // Steps beyond those were taken back by the monkey itself.
    for _ in 0..steps {
        assert!(harness.state_mut().document_mut().redo(), "seed {seed}: a step is lost");
    }
    assert!(bytes(&harness) == last, "seed {seed}: {steps} steps forward is not the last document");
    note(&format!("seed {seed}: {steps} steps from {events} events, {} nodes", end.nodes().len()));
    end
}

/// The events of a long run, if one is asked for.
fn long_run() -> Option<usize> {
    std::env::var(LONG_RUN).ok().and_then(|text| text.parse().ok())
}

#[test]
fn undo_leads_back_from_whatever_a_monkey_does() {
    let events = long_run().unwrap_or(SHORT_RUN);
    let (mut scene, _) = scene();
    for (seed, _) in (0..events).step_by(PER_ROUND).enumerate() {
        scene = round(seed as u64 + 1, scene, events.min(PER_ROUND));
    }
}

/// Kilobytes that this process has in memory; `None` where the system does not tell.
fn resident() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/statm").ok()?;
    text.split_whitespace().nth(1)?.parse::<f64>().ok().map(|pages| pages * 4.0)
}

/// Judges the memory in a long run only, which has the process for itself.
#[test]
fn edits_and_their_undos_leave_nothing_behind() {
    let pairs = long_run().unwrap_or(100);
    let (scene, [.., ring]) = scene();
    let mut harness = open_in(Document::new(scene.clone()), WINDOW);
    harness.state_mut().document_mut().select(vec![ring]);
    harness.run_steps(4);
    let mut early = None;
    for pair in 0..pairs {
        harness.key_press(Key::N);
        harness.step();
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        harness.step();
        if pair == pairs / 10 {
            early = resident();
        }
    }
    harness.run_steps(8);
    let document = harness.state().document();
    assert_eq!((document.undo_labels().count(), document.redo_labels().count()), (0, 1));
    assert_eq!(*document.scene(), scene);
    assert!(document.revision() >= 2 * pairs as u64, "each key did something: {}", document.revision());
    if let (Some(early), Some(late), Some(_)) = (early, resident(), long_run()) {
        note(&format!("{pairs} edits and undos: {early} KiB after a tenth of them, {late} KiB in the end"));
        assert!(late < 1.05 * early, "{early} KiB became {late} KiB");
    }
}

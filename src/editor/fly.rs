//! Flying through the scene: the right button turns the view around the eye while W, A, S, D, Q and E move it.

use egui::{Key, PointerButton, Response, Ui};
use glam::{DVec2, DVec3};

use super::navigation::Navigation;

/// The keys, with the directions right, up and forward into which they move.
const KEYS: [(Key, DVec3); 6] = [
    (Key::W, DVec3::Z),
    (Key::S, DVec3::NEG_Z),
    (Key::D, DVec3::X),
    (Key::A, DVec3::NEG_X),
    (Key::E, DVec3::Y),
    (Key::Q, DVec3::NEG_Y),
];
/// View distances per second at speed 1.
const PACE: f64 = 0.8;
/// Factor of the speed with Shift.
const FAST: f64 = 4.0;
/// Factor of the speed for a step of the wheel, and the limits of the speed.
const STEP: f64 = 1.25;
const SPEEDS: [f64; 2] = [0.02, 50.0];
/// Points of a step of the wheel.
const NOTCH: f64 = 40.0;
/// Longest time between two frames that counts, in seconds: a slow frame must not throw the view away.
const LONGEST: f64 = 0.1;

/// The speed of flying, which is kept from one flight to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlySpeed(pub f64);

impl Default for FlySpeed {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Whether a flight begins: the right button is down over the picture, and one of the keys.
pub fn begins(ui: &Ui, response: &Response) -> bool {
    response.is_pointer_button_down_on()
        && ui.input(|i| {
            i.pointer.button_down(PointerButton::Secondary)
                && !i.modifiers.command
                && !i.modifiers.alt
                && KEYS.iter().any(|(key, _)| i.key_down(*key))
        })
}

/// Whether it goes on.
pub fn goes_on(ui: &Ui) -> bool {
    ui.input(|i| i.pointer.button_down(PointerButton::Secondary))
}

/// Moves the view for one frame; the pointer has moved by `drag_px`.
pub fn follow(view: &mut Navigation, speed: &mut FlySpeed, ui: &Ui, drag_px: DVec2, height_px: f64) {
    let (scroll, seconds, is_fast, held) = ui.input(|i| {
        let held: DVec3 = KEYS.iter().filter(|(key, _)| i.key_down(*key)).map(|(_, by)| *by).sum();
        (f64::from(i.smooth_scroll_delta().y), f64::from(i.stable_dt), i.modifiers.shift, held)
    });
    // Near things would be far away.
    view.orthographic = false;
    speed.0 = (speed.0 * STEP.powf(scroll / NOTCH)).clamp(SPEEDS[0], SPEEDS[1]);
    view.look_around(drag_px, height_px);
    let pace = speed.0 * PACE * view.distance * if is_fast { FAST } else { 1.0 };
    view.fly(held.normalize_or_zero() * pace * seconds.min(LONGEST));
    ui.ctx().request_repaint();
}

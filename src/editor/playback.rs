//! Playback: the clock that moves the document through its timeline, and the keys that are selected there.

use std::collections::BTreeSet;
use std::time::Duration;

use super::edit_session::EditSession;
use isolith_document::Document;
use isolith_scene::{ParamPath, Timeline, Track};

/// A key: the path of its parameter, and its moment as bits.
pub type KeyId = (ParamPath, u64);

/// The keys that a drag moves.
pub struct KeyDrag {
    /// The tracks of these keys before the drag.
    pub originals: Vec<Track>,
    /// The keys.
    pub keys: BTreeSet<KeyId>,
    /// The moment under the pointer at the start.
    pub from: f64,
    /// Whether copies move instead.
    pub copies: bool,
}

/// The clock, and the state of the timeline.
pub struct Playback {
    is_playing: bool,
    /// Seconds of the timeline in one second; negative plays backward.
    pub speed: f64,
    /// The moment between frames.
    exact: f64,
    /// When the clock was last read.
    read: Option<f64>,
    /// Whether the artist drags the moment.
    pub is_scrubbing: bool,
    /// Selected keys.
    pub selected: BTreeSet<KeyId>,
    /// Whether the pointer is over the keys, so that Delete means them.
    pub is_over_keys: bool,
    /// The keys that are being dragged.
    pub drag: Option<KeyDrag>,
}

impl Default for Playback {
    fn default() -> Self {
        Self {
            is_playing: false,
            speed: 1.0,
            exact: 0.0,
            read: None,
            is_scrubbing: false,
            selected: BTreeSet::new(),
            is_over_keys: false,
            drag: None,
        }
    }
}

impl Playback {
    /// Whether the timeline plays.
    pub fn is_playing(&self) -> bool {
        self.is_playing
    }

    /// Whether the moment changes, by itself or by the artist's hand.
    pub fn is_moving(&self) -> bool {
        self.is_playing || self.is_scrubbing
    }

    /// Whether Delete means the selected keys.
    pub fn deletes_keys(&self) -> bool {
        self.is_over_keys && !self.selected.is_empty()
    }

    /// Stops.
    pub fn pause(&mut self) {
        (self.is_playing, self.read) = (false, None);
    }

    /// Plays from the moment that is shown, or stops. At the end it starts again.
    pub fn toggle(&mut self, document: &mut Document) {
        if self.is_playing {
            return self.pause();
        }
        let Timeline { start, end, .. } = document.scene().animation.timeline;
        let (first, last) = if self.speed < 0.0 { (end, start) } else { (start, end) };
        let is_over = (last - document.time()) * self.speed.signum() <= 0.0;
        if is_over || !(start..=end).contains(&document.time()) {
            document.set_time(first);
        }
        (self.is_playing, self.exact, self.read) = (true, document.time(), None);
    }

    /// Moves the document to the frame of this moment of the clock, in seconds. Returns when the next frame is due;
    /// nothing is due while it stands still. A change of the scene stops it.
    pub fn advance(&mut self, session: &mut EditSession, now: f64) -> Option<Duration> {
        if self.is_playing && session.is_changing() {
            self.pause();
        }
        if !self.is_playing {
            return None;
        }
        let elapsed = self.read.replace(now).map_or(0.0, |read| (now - read).max(0.0));
        self.exact += elapsed * self.speed;
        let timeline = session.document.scene().animation.timeline;
        let Timeline { start, end, is_looping, frames_per_second } = timeline;
        if !(start..=end).contains(&self.exact) {
            if is_looping {
                self.exact = start + (self.exact - start).rem_euclid(end - start);
            } else {
                self.exact = self.exact.clamp(start, end);
                self.pause();
            }
        }
        // A frame is shown from its moment to that of the next one.
        let frame = (timeline.frame_at(self.exact) + 1e-6).floor();
        session.document.set_time(timeline.time_of(frame).clamp(start, end));
        let rate = (self.speed.abs() * frames_per_second).max(1.0);
        self.is_playing.then(|| Duration::from_secs_f64(1.0 / rate.min(1000.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use isolith_document::Edit;
    use isolith_scene::Scene;

    fn session(is_looping: bool) -> EditSession {
        let mut document = Document::new(Scene::new());
        let timeline = Timeline { frames_per_second: 10.0, start: 1.0, end: 2.0, is_looping };
        document.apply(Edit::SetTimeline(timeline)).unwrap();
        EditSession::new(document)
    }

    fn shown(playback: &mut Playback, session: &mut EditSession, clock: &[f64]) -> Vec<f64> {
        let mut moments = Vec::new();
        for now in clock {
            playback.advance(session, *now);
            moments.push((session.document.time() * 1e6).round() / 1e6);
        }
        moments
    }

    #[test]
    fn frames_follow_the_clock_and_start_again() {
        let (mut playback, mut session) = (Playback::default(), session(true));
        assert_eq!(playback.advance(&mut session, 5.0), None, "it stands still");
        playback.toggle(&mut session.document);
        assert_eq!(shown(&mut playback, &mut session, &[5.0, 5.05, 5.11, 5.95, 6.31]), [1.0, 1.0, 1.1, 1.9, 1.3]);
        assert!(playback.advance(&mut session, 6.32).is_some());
        playback.toggle(&mut session.document);
        assert_eq!(shown(&mut playback, &mut session, &[9.0]), [1.3], "it stops where it is");
        playback.speed = -2.0;
        playback.toggle(&mut session.document);
        assert_eq!(shown(&mut playback, &mut session, &[10.0, 10.1, 10.3]), [1.3, 1.1, 1.7]);
    }

    #[test]
    fn without_a_loop_it_ends_and_an_edit_ends_it_too() {
        let (mut playback, mut session) = (Playback::default(), session(false));
        playback.toggle(&mut session.document);
        assert_eq!(shown(&mut playback, &mut session, &[0.0, 0.5, 7.0, 8.0]), [1.0, 1.5, 2.0, 2.0]);
        assert!(!playback.is_playing());
        playback.toggle(&mut session.document);
        assert_eq!(session.document.time(), 1.0, "from the start again");
        session.begin(egui::Id::unique("a drag"));
        assert_eq!(playback.advance(&mut session, 9.0), None);
        assert!(!playback.is_playing());
    }
}

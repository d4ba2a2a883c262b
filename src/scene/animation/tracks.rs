//! All tracks of a scene.

use std::sync::Arc;

use super::timeline::Timeline;
use super::track::Track;
use crate::param_path::ParamPath;

/// The timeline and the tracks of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// What is played.
    pub timeline: Timeline,
    /// Sorted by path, one for each, so that those of one owner stand together.
    pub(super) tracks: Vec<Arc<Track>>,
}

impl Animation {
    /// All tracks, sorted by path.
    pub fn tracks(&self) -> &[Arc<Track>] {
        &self.tracks
    }

    /// Whether nothing is animated.
    pub fn is_empty(&self) -> bool {
        self.tracks.is_empty()
    }

    /// The track with exactly this path.
    pub fn track(&self, path: &ParamPath) -> Option<&Arc<Track>> {
        self.place(path).ok().map(|at| &self.tracks[at])
    }

    /// The tracks that animate a parameter: one of the whole, or those of its elements. For the path of an element,
    /// its own track and that of the whole.
    pub fn tracks_of<'a>(&'a self, path: &'a ParamPath) -> impl Iterator<Item = &'a Arc<Track>> {
        let whole = ParamPath { element: None, ..path.clone() };
        let start = self.tracks.partition_point(|track| track.path < whole);
        let same = move |track: &&Arc<Track>| track.path.owner == whole.owner && track.path.name == whole.name;
        let meets = |track: &&Arc<Track>| {
            track.path.element.is_none() || path.element.is_none() || track.path.element == path.element
        };
        self.tracks[start..].iter().take_while(same).filter(meets)
    }

    /// The number of keys of all tracks.
    pub fn key_count(&self) -> usize {
        self.tracks.iter().map(|track| track.keys.len()).sum()
    }

    /// Puts a track in the place of the one with its path, or takes that one away if the new one has no keys. Checks
    /// nothing.
    pub(crate) fn put(&mut self, track: Track) {
        match (self.place(&track.path), track.keys.is_empty()) {
            (Ok(at), true) => {
                self.tracks.remove(at);
            }
            (Ok(at), false) => self.tracks[at] = Arc::new(track),
            (Err(at), false) => self.tracks.insert(at, Arc::new(track)),
            (Err(_), true) => {}
        }
    }

    fn place(&self, path: &ParamPath) -> Result<usize, usize> {
        self.tracks.binary_search_by(|track| track.path.cmp(path))
    }
}

/// Why a parameter has two sources of its value.
pub(crate) fn doubled(animation: &Animation, path: &ParamPath) -> Option<String> {
    animation.tracks_of(path).nth(1).map(|_| "is animated as a whole and by its elements; only one is possible".into())
}

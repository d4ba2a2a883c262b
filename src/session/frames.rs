//! The frames of an animation: which, when, and the names of their files.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use isolith_scene::limits::{FRAMES_PER_SECOND, KEY_TIME};

/// Most frames of one order.
const MAX_FRAMES: i64 = 1_000_000;

/// The frames from the first to the last, both included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    first: i64,
    last: i64,
}

impl FrameRange {
    /// The frames from `first` to `last`.
    ///
    /// # Errors
    /// They are in the wrong order, or too many.
    pub fn new(first: i64, last: i64) -> Result<Self, String> {
        if first > last {
            return Err(format!("the first frame, {first}, is after the last, {last}"));
        }
        if last.checked_sub(first).is_none_or(|more| more >= MAX_FRAMES) {
            return Err(format!("there are more than {MAX_FRAMES} frames"));
        }
        Ok(Self { first, last })
    }

    /// The frames in their order.
    pub fn iter(self) -> impl ExactSizeIterator<Item = i64> {
        let count = (self.last - self.first + 1) as usize;
        (0..count).map(move |index| self.first + index as i64)
    }

    /// The moment of a frame. Frame 0 is at 0 seconds.
    pub fn time_of(self, frame: i64, frames_per_second: f64) -> Result<f64, String> {
        let time = frame as f64 / frames_per_second;
        match KEY_TIME.accept(time) {
            true => Ok(time),
            false => {
                let [least, most] = KEY_TIME.hard;
                Err(format!("frame {frame} is at {time} s; times are {least} to {most} s"))
            }
        }
    }
}

impl fmt::Display for FrameRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.first, self.last)
    }
}

impl FromStr for FrameRange {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once("..").and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
        let (first, last): (i64, i64) = ends.ok_or("give the first and the last frame, like 1..48")?;
        Self::new(first, last)
    }
}

/// Frames per second as an option.
pub fn parse_fps(text: &str) -> Result<f64, String> {
    let [least, most] = FRAMES_PER_SECOND.hard;
    let number = text.parse().ok().filter(|number| FRAMES_PER_SECOND.accept(*number));
    number.ok_or(format!("give frames per second, {least} to {most}"))
}

/// The output of a frame: the last run of `#` in the name becomes the number, with at least as many digits.
///
/// # Errors
/// The name has no place for the number, so that each frame would replace the one before it.
pub fn numbered(pattern: &Path, frame: i64) -> Result<PathBuf, String> {
    let name = pattern.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let Some(end) = name.rfind('#') else {
        let reason = "frames need a run of # in the name, which becomes the number, like frame.####.png";
        return Err(format!("{}: {reason}", pattern.display()));
    };
    let start =
        name[..end].rfind(|c| c != '#').map_or(0, |at| at + name[at..].chars().next().map_or(1, char::len_utf8));
    let (digits, sign) = (end + 1 - start, if frame < 0 { "-" } else { "" });
    let number = format!("{sign}{:0digits$}", frame.unsigned_abs());
    Ok(pattern.with_file_name(format!("{}{number}{}", &name[..start], &name[end + 1..])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_or_refused() {
        let range: FrameRange = "-1..2".parse().unwrap();
        assert_eq!(range.iter().collect::<Vec<_>>(), [-1, 0, 1, 2]);
        assert_eq!(range.time_of(2, 4.0).unwrap(), 0.5);
        assert_eq!("7..7".parse::<FrameRange>().unwrap().iter().len(), 1);
        for bad in ["", "1", "1..", "..2", "2..1", "a..b", "1..2..3", "0..1000000", "1.5..2"] {
            assert!(bad.parse::<FrameRange>().is_err(), "{bad}");
        }
        assert!("-9223372036854775808..9223372036854775807".parse::<FrameRange>().is_err());
        assert!("999999999..999999999".parse::<FrameRange>().unwrap().time_of(999_999_999, 24.0).is_err());
        assert!(parse_fps("23.976").is_ok() && parse_fps("0").is_err() && parse_fps("nan").is_err());
    }

    #[test]
    fn the_last_run_of_a_name_becomes_the_number() {
        let named = |pattern: &str, frame| numbered(Path::new(pattern), frame).map(|path| path.display().to_string());
        for (pattern, frame, name) in [
            ("a.####.png", 7, "a.0007.png"),
            ("#", 12, "12"),
            ("d##/é#_##.exr", 5, "d##/é#_05.exr"),
            ("a####", -7, "a-0007"),
            ("a.##.png", 12_345, "a.12345.png"),
        ] {
            assert_eq!(named(pattern, frame).unwrap(), name, "{pattern}");
        }
        assert!(named("a.png", 1).is_err() && named("###/a.png", 1).is_err());
    }
}

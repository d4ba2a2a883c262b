//! Frames of an animation from the command line.

use isolith::scene::{KeyInterpolation, Keyframe, ParamValue, Track};

use super::{Place, open, sample};

/// The scene with a ball that falls by a meter in a second.
fn falling() -> Place {
    let place = Place::new();
    let mut scene = sample();
    let key = |time: f64| Keyframe { time, value: ParamValue::Scalar(-time), interpolation: KeyInterpolation::Linear };
    let path = "node.2.transform.translation[1]".parse().expect("a path");
    scene.set_tracks([Track { path, keys: [0.0, 1.0].map(key).into() }]).expect("sound tracks");
    place.write("scene.json", &scene);
    place
}

const SMALL: [&str; 6] = ["render", "scene.json", "--size", "24x24", "--samples", "1"];

fn render(place: &Place, rest: &[&str]) -> super::Outcome {
    place.run(&[&SMALL[..], rest].concat())
}

#[test]
fn frames_are_numbered_pictures_of_their_moments() {
    let place = falling();
    let told = render(&place, &["-o", "f.###.png", "--depth", "d#.exr", "--frames", "-1..12", "--fps", "12"]);
    told.succeeded();
    assert!(told.out.contains("wrote f.000.png") && told.out.contains("14 frames"), "{}", told.out);
    let picture = |name: &str| open(&place.path(name)).to_rgba8();
    assert!(place.path("f.-001.png").exists() && place.path("d12.exr").exists());
    assert!(!place.path("f.013.png").exists());
    // The same moment is the same picture, alone or after others.
    for (name, time) in [("f.-001.png", "-0.08333333333333333"), ("f.006.png", "0.5"), ("f.012.png", "1")] {
        render(&place, &["-o", "one.png", "--time", time]).succeeded();
        assert_eq!(picture("one.png"), picture(name), "{name}");
    }
    assert_ne!(picture("f.000.png"), picture("f.012.png"));
    assert_eq!(picture("f.-001.png"), picture("f.000.png"), "before its first key the ball does not move");
}

#[test]
fn frames_count_by_the_timeline_of_the_scene_unless_told_otherwise() {
    let place = falling();
    let told = render(&place, &["-o", "f#.png", "--frames", "24..24", "--json"]);
    told.succeeded();
    let object = told.object();
    assert_eq!((object["frame"].as_i64(), object["time"].as_f64()), (Some(24), Some(1.0)));
    assert_eq!(object["outputs"][0]["file"], "f24.png");
}

#[test]
fn frames_that_cannot_be_named_or_counted_are_refused() {
    let place = falling();
    let refused = |rest: &[&str], parts: &[&str]| {
        render(&place, rest).failed(2, parts);
    };
    refused(&["-o", "f.png", "--frames", "1..3"], &["f.png", "a run of #"]);
    refused(&["-o", "-", "--frames", "1..3"], &["standard output holds one picture"]);
    refused(&["-o", "f#.png", "--depth", "d.exr", "--frames", "1..3"], &["d.exr", "a run of #"]);
    refused(&["-o", "f#.png", "--frames", "3..1"], &["--frames", "is after the last"]);
    refused(&["-o", "f#.png", "--frames", "1-3"], &["--frames", "like 1..48"]);
    refused(&["-o", "f#.png", "--frames", "1..3", "--time", "1"], &["--time"]);
    refused(&["-o", "f#.png", "--fps", "24"], &["--frames"]);
    refused(&["-o", "f#.png", "--frames", "1..3", "--fps", "0"], &["--fps"]);
    refused(&["-o", "f#.png", "--frames", "999999999..999999999"], &["--frames", "times are"]);
    assert_eq!(place.names(), ["scene.json"]);
}

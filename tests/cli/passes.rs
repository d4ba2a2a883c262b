//! `render --pass`: the picture after a pass over the parts of the scene.

use super::{Place, ids};

#[test]
fn a_pass_shows_the_parts_up_to_it_and_one_beyond_the_last_is_refused_with_the_parts() {
    let place = Place::new();
    let of = |pass: &str| {
        let arguments = ["render", "scene.json", "-o", "p.png", "--size", "64x64", "--samples", "1", "--pass", pass];
        place.run(&[&arguments[..], &["--node-id", "id.exr", "--quiet"]].concat())
    };
    let seen = |pass: &str| {
        of(pass).succeeded();
        let mut ids = ids(&place.path("id.exr"));
        ids.sort_unstable();
        ids.dedup();
        ids
    };
    assert_eq!(seen("0"), [0]);
    assert_eq!(seen("1").len(), 2, "one part and the background");
    assert_eq!(seen("2"), [0, 1, 2]);
    of("3").failed(2, &["there is no pass 3", "\"floor\"", "\"ball\""]);
    place.run(&["render", "scene.json", "-o", "p.png", "--pass", "1", "--reference"]).failed(2, &["--pass"]);
    place.run(&["render", "scene.json", "-o", "p.png", "--pass", "-1"]).failed(2, &["-1"]);
}

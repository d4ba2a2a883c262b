//! `isolith render --shading`.

use super::{Place, open};

#[test]
fn shadings_differ_in_light_and_matter_only() {
    let place = Place::new();
    let render = |arguments: &[&str]| {
        let outputs = ["render", "scene.json", "-o", "out.png", "--depth", "depth.exr", "--size", "24x16"];
        place.run(&[&outputs, arguments].concat()).succeeded();
        (open(&place.path("out.png")).into_rgb8(), std::fs::read(place.path("depth.exr")).expect("a depth"))
    };
    let plain = render(&[]);
    assert_eq!(plain, render(&["--shading", "rendered"]));
    let [solid, material] = ["solid", "material"].map(|shading| render(&["--shading", shading]));
    assert!(solid.1 == plain.1 && material.1 == plain.1, "the same shapes");
    assert!(solid.0 != plain.0 && material.0 != plain.0 && solid.0 != material.0);
    let reference = render(&["--shading", "solid", "--reference"]).0;
    let [ball, other] = [&solid.0, &reference].map(|picture| picture.get_pixel(12, 8).0.map(i32::from));
    assert!((0..3).all(|c| (ball[c] - other[c]).abs() < 4), "{ball:?} {other:?}");
}

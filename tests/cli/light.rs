//! Options of `isolith render` for the light of the picture.

use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use glam::DVec3;
use image::GenericImageView;
use isolith::field::light::display::display_color;
use isolith::scene::{Changed, DisplaySettings, ParamPath, ParamValue, ViewTransform};

use super::{Place, open, sample};

const SIZE: [&str; 4] = ["--size", "24x16", "--camera", "front"];

/// Renders with these options; returns what was printed.
fn render(place: &Place, output: &str, options: &[&str]) -> String {
    let arguments = ["render", "scene.json", "-o", output];
    let all: Vec<&str> = arguments.iter().chain(&SIZE).chain(options).copied().collect();
    place.run(&all).succeeded().out.clone()
}

/// The channels A, B, G and R of an EXR file, and one of its attributes.
fn light(place: &Place, name: &str, attribute: &str) -> ([Vec<f32>; 4], Option<AttributeValue>) {
    let image = read_all_flat_layers_from_file(place.path(name)).expect("an EXR file");
    let layer = &image.layer_data[0];
    let channels = [0, 1, 2, 3].map(|i| match &layer.channel_data.list[i].sample_data {
        FlatSamples::F32(values) => values.clone(),
        other => panic!("not f32: {other:?}"),
    });
    (channels, layer.attributes.other.get(&Text::new_or_panic(attribute)).cloned())
}

#[test]
fn samples_smooth_the_picture_and_leave_the_numbers_alone() {
    let place = Place::new();
    let said = render(&place, "smooth.png", &["--depth", "smooth.exr"]);
    assert!(said.contains("24x16 pixels, 16 samples, "), "{said}");
    let said = render(&place, "single.png", &["--depth", "single.exr", "--samples", "1"]);
    assert!(!said.contains("samples"), "{said}");
    let [smooth, single] = ["smooth", "single"].map(|name| open(&place.path(&format!("{name}.png"))).into_rgba8());
    assert_ne!(smooth, single);
    let depth = |name: &str| std::fs::read(place.path(name)).expect("a file");
    assert!(depth("smooth.exr") == depth("single.exr"), "depth is that of the pixel's center");
    let picture = ["render", "scene.json", "-o", "x.png", "--samples", "4"];
    let with = |options: &[&'static str]| picture.iter().chain(options).copied().collect::<Vec<_>>();
    place.run(&with(&["--reference"])).failed(2, &["--samples", "one sample"]);
    place.run(&with(&["--view", "normals"])).failed(2, &["--samples", "one sample"]);
}

#[test]
fn light_is_written_before_exposure_and_view_transform() {
    let place = Place::new();
    let brighter = ["--exposure", "1", "--view-transform", "pbr_neutral", "--samples", "4"];
    render(&place, "plain.exr", &["--samples", "4"]);
    render(&place, "bright.exr", &brighter);
    render(&place, "bright.png", &brighter);
    let (plain, none) = light(&place, "plain.exr", "isolith.viewTransform");
    let (bright, neutral) = light(&place, "bright.exr", "isolith.viewTransform");
    assert!(plain == bright, "the light is the same whatever the screen shows");
    let named = |name: &str| Some(AttributeValue::Text(Text::new_or_panic(name)));
    assert_eq!((none, neutral), (named("None"), named("Khronos PBR Neutral")));
    let display = DisplaySettings { exposure: 1.0, view_transform: ViewTransform::PbrNeutral };
    let picture = open(&place.path("bright.png")).into_rgba8();
    let [a, b, g, r] = plain;
    for (i, pixel) in picture.pixels().enumerate() {
        let shown = display_color(DVec3::new(r[i].into(), g[i].into(), b[i].into()), &display) * 255.0;
        let drawn = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
        assert!((drawn - shown).abs().max_element() < 0.6, "pixel {i}: {pixel:?}, not {shown}");
        assert_eq!(a[i], 1.0);
    }
    let arguments = ["render", "scene.json", "-o", "x.exr", "--view", "normals"];
    place.run(&arguments).failed(2, &["--output", "no linear light"]);
}

#[test]
fn a_transparent_picture_has_no_background() {
    let place = Place::new();
    for options in [&["--transparent"][..], &["--transparent", "--reference"]] {
        render(&place, "cut.png", options);
        render(&place, "cut.exr", options);
        let picture = open(&place.path("cut.png"));
        assert_eq!(picture.get_pixel(12, 0).0, [0; 4], "{options:?}: the sky is left out");
        assert_eq!(picture.get_pixel(12, 8)[3], 255, "{options:?}: the ball is not");
        let ([a, _, _, r], _) = light(&place, "cut.exr", "isolith.samples");
        assert_eq!((a[12], r[12], a[8 * 24 + 12]), (0.0, 0.0, 1.0));
        let edges = a.iter().filter(|a| **a > 0.0 && **a < 1.0).count();
        assert_eq!(edges > 0, options.len() == 1, "{options:?}: {edges} pixels in part");
    }
    place
        .run(&["render", "scene.json", "-o", "x.png", "--transparent", "--view", "steps"])
        .failed(2, &["--transparent"]);
}

#[test]
fn the_scenes_display_settings_are_used_unless_options_replace_them() {
    let place = Place::new();
    render(&place, "plain.png", &["--samples", "1"]);
    let mut scene = sample();
    scene.display = DisplaySettings { exposure: 2.0, view_transform: ViewTransform::Agx };
    place.write("scene.json", &scene);
    render(&place, "own.png", &["--samples", "1"]);
    render(&place, "other.png", &["--samples", "1", "--exposure", "0", "--view-transform", "none"]);
    let [plain, own, other] = ["plain", "own", "other"].map(|name| open(&place.path(&format!("{name}.png"))));
    assert_ne!(plain, own);
    assert_eq!(plain, other);
}

#[test]
fn a_lens_blurs_stills_of_several_samples_and_is_refused_beyond_its_limit() {
    let place = Place::new();
    let set = |aperture: f64, focus_distance: f64| {
        let mut scene = sample();
        let front = scene.nodes().iter().find(|node| node.name == "front").expect("a camera").id;
        for (name, value) in [("aperture", aperture), ("focus_distance", focus_distance)] {
            let path: ParamPath = format!("node.{}.camera.{name}", front.0).parse().expect("a path");
            let Ok(Changed::Node(node)) = path.changed(&scene, ParamValue::Scalar(value)) else { panic!("{name}") };
            scene.replace(*node).expect("valid");
        }
        place.write("scene.json", &scene);
    };
    let picture = |samples: &str| {
        render(&place, "out.png", &["--samples", samples]);
        open(&place.path("out.png"))
    };
    let (single, sharp) = (picture("1"), picture("8"));
    set(0.4, 2.0);
    assert_eq!(picture("1"), single, "one sample is that of a pinhole");
    assert_ne!(picture("8"), sharp);
    set(100.0, 1e-3);
    let arguments = ["render", "scene.json", "-o", "x.png", "--camera", "front", "--size", "24x16"];
    place.run(&arguments).failed(2, &["aperture", "8192"]);
}

#[test]
fn layers_hold_the_same_numbers_as_files_of_their_own() {
    let place = Place::new();
    let options = ["--samples", "3", "--layers", "--depth", "depth.exr", "--node-id", "id.exr"];
    render(&place, "all.exr", &options);
    render(&place, "light.exr", &["--samples", "3"]);
    let channels = |name: &str| {
        let image = read_all_flat_layers_from_file(place.path(name)).expect("an EXR file");
        let list = image.layer_data[0].channel_data.list.clone();
        list.into_iter().map(|channel| (channel.name.to_string(), channel.sample_data)).collect::<Vec<_>>()
    };
    let all = channels("all.exr");
    let of = |name: &str| &all.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("no {name}")).1;
    for (name, samples) in channels("light.exr") {
        assert_eq!(*of(&name), samples, "{name}");
    }
    assert_eq!(*of("depth.Z"), channels("depth.exr")[0].1);
    assert_eq!(*of("node.id"), channels("id.exr")[0].1);
    let picture = ["render", "scene.json", "-o", "x.png", "--layers"];
    place.run(&picture).failed(2, &["--layers", ".exr"]);
    let reference = ["render", "scene.json", "-o", "x.exr", "--layers", "--reference"];
    place.run(&reference).failed(2, &["--layers"]);
}

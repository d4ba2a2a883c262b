//! Materials have the names, ranges and defaults of OpenPBR, as the crate `openpbr` lists them.

use isolith::scene::{Material, Param, ParamValue, Params as _};
use openpbr::{Bound, Kind, ParamDefault, ParamInfo, Range};

/// Parts of a material that are not OpenPBR's.
const OWN: &[&str] = &["model.", "textures.", "opacity_threshold"];

/// Where a range differs, and why.
const DEVIATIONS: &[(&str, &str)] = &[
    ("specular_ior", "a medium below 1 would be a bubble: it has no use on opaque surfaces"),
    ("coat_ior", "as specular_ior"),
    ("emission_luminance", "pictures are relative to the white of the display, which is 1, and not in nits"),
];

fn specified(name: &str) -> Option<&'static ParamInfo> {
    openpbr::Param::ALL.iter().map(|param| param.info()).find(|info| info.identifier == name)
}

/// The bound as a number, for one side.
fn number(bound: Bound, open: f64) -> f64 {
    match bound {
        Bound::Inclusive(v) | Bound::Exclusive(v) => f64::from(v),
        Bound::Unbounded => open,
    }
}

/// What differs from the specification; empty for nothing.
fn differences(param: &Param, info: &ParamInfo) -> Vec<String> {
    let mut found = Vec::new();
    let default = match (&param.default, info.default) {
        (ParamValue::Scalar(own), ParamDefault::Float(v)) => (own - f64::from(v)).abs() < 1e-6,
        (ParamValue::Vector(own), ParamDefault::Color3(v)) => {
            (*own - glam::DVec3::from(v.map(f64::from))).length() < 1e-6
        }
        _ => false,
    };
    if !default {
        found.push(format!("default {:?}, not {:?}", param.default, info.default));
    }
    if param.is_color != (info.kind == Kind::Color3) {
        found.push(format!("is of kind {:?}", info.kind));
    }
    let range = |range: Range| [number(range.min, f64::NEG_INFINITY), number(range.max, f64::INFINITY)];
    let [low, high] = range(info.range.expect("a number has a range"));
    let hard = param.limits.hard;
    // A range without end ends at the limit of the program.
    let ends = if high.is_finite() { hard[1] == high } else { hard[1] >= 100.0 };
    if hard[0] != low || !ends {
        found.push(format!("range {hard:?}, not {:?}", info.range));
    }
    if info.norm.is_some_and(|norm| range(norm) != param.limits.soft) {
        found.push(format!("usual range {:?}, not {:?}", param.limits.soft, info.norm));
    }
    found
}

/// The parameters of a material, with the names that files have.
fn parameters() -> Vec<(String, Param)> {
    let mut all = Vec::new();
    Material::default().visit("", &mut |prefix, param, _| all.push((format!("{prefix}{}", param.name), param.clone())));
    all
}

#[test]
fn names_ranges_and_defaults_are_those_of_openpbr() {
    assert!(openpbr::SPEC_VERSION.starts_with("1.1"), "{}", openpbr::SPEC_VERSION);
    let all = parameters();
    let mut compared = 0;
    for (name, param) in all.iter().filter(|(name, _)| !OWN.iter().any(|own| name.starts_with(own))) {
        let info = specified(name).unwrap_or_else(|| panic!("OpenPBR has no {name}"));
        let found = differences(param, info);
        let allowed = DEVIATIONS.iter().any(|(deviating, _)| deviating == name);
        assert_eq!(!found.is_empty(), allowed, "{name}: {found:?}");
        assert!(!found.iter().any(|text| text.starts_with("default")), "{name}: {found:?}");
        compared += 1;
    }
    assert!(compared >= 15, "{compared}");
}

#[test]
fn another_name_range_or_default_is_noticed() {
    let all = parameters();
    let (_, param) = all.iter().find(|(name, _)| name == "specular_roughness").expect("it is there");
    let info = specified("specular_roughness").expect("it is specified");
    assert!(differences(param, info).is_empty());
    assert!(!differences(&Param { default: ParamValue::Scalar(0.5), ..param.clone() }, info).is_empty());
    let wider = isolith::scene::Limits::new([0.0, 1.0], [0.0, 2.0], "");
    assert!(!differences(&Param { limits: wider, ..param.clone() }, info).is_empty());
    assert!(!differences(param, specified("specular_ior").expect("it is specified")).is_empty());
    assert!(specified("roughness").is_none());
}

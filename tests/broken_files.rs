//! Scene files broken by hand: the reader refuses each with the node, the field and the reason.

use std::path::Path;

use isolith::scene::file;

/// A scene with one node of every kind.
const GOOD: &str = r#"{
  "isolith": 1,
  "environment": {
    "sky": [0.1, 0.2, 0.3],
    "horizon": [0.1, 0.1, 0.1],
    "ambient": [0.2, 0.2, 0.2]
  },
  "materials": [
    {"id": 1, "name": "Clay", "albedo": [0.5, 0.5, 0.5], "specular": 0.25, "shininess": 48.0, "emission": [0, 0, 0]},
    {"id": 2, "name": "Gold", "albedo": [0.9, 0.8, 0.1], "specular": 0.75, "shininess": 96.0, "emission": [0, 0, 0]}
  ],
  "next_id": 9,
  "nodes": [
    {"id": 1, "name": "Pawn", "group": {"operator": "union", "blend": {"kernel": "circular", "radius": 0.05}}},
    {"id": 2, "parent": 1, "name": "Head", "transform": {"translation": [0, 2, 0], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 1, -2]},
     "object": {"shape": {"type": "sphere", "radius": 0.5}, "material": 1}},
    {"id": 3, "parent": 1, "name": "Foot", "object": {"shape": {"type": "box", "size": [1, 2, 3], "rounding": 0.1}, "material": 2}},
    {"id": 4, "name": "Duck", "mesh": {"path": "models/duck.glb", "material": null}},
    {"id": 5, "name": "Sun", "light": {"color": [1, 1, 1], "intensity": 2, "light": {"type": "directional"}}},
    {"id": 6, "name": "Lamp", "light": {"color": [1, 1, 1], "intensity": 2, "light": {"type": "spot",
      "attenuation": {"constant": 1, "linear": 0, "quadratic": 0.1, "range": 50}, "inner": 20, "outer": 30}}},
    {"id": 7, "name": "View", "camera": {"fov_y": 40, "near": 0.001, "far": 10000}},
    {"id": 8, "name": "Rest", "group": {"operator": "difference", "blend": {"kernel": "cubic", "radius": 0}}}
  ]
}"#;

/// Old and new text, and the node, field and reason that the message must contain.
type Case = (&'static str, &'static str, &'static str, &'static str, &'static str);

const CASES: &[Case] = &[
    // The version.
    (r#""isolith": 1,"#, "", "", "isolith", "is missing"),
    (r#""isolith": 1,"#, r#""isolith": null,"#, "", "isolith", "is missing"),
    (r#""isolith": 1,"#, r#""isolith": 0,"#, "", "isolith", "no version 0"),
    (r#""isolith": 1,"#, r#""isolith": 3,"#, "", "isolith", "version 3 is newer"),
    (r#""isolith": 1,"#, r#""isolith": "one","#, "", "isolith", "must be the number of a version"),
    (r#""isolith": 1,"#, r#""isolith": 1, "isolith": 1,"#, "", "isolith", "duplicate field"),
    // JSON syntax.
    (r#""next_id": 9,"#, r#""next_id": 9"#, "", "", "line 13, column 3: expected `,` or `}`"),
    (r#""name": "Head","#, r#""name": Head,"#, "#2", "nodes[1].name", "expected value"),
    (r#""radius": 0.5}"#, r#""radius": 0.5"#, "Head #2", "nodes[1].object.shape.material", "unknown field"),
    (r#""name": "Sun""#, r#""name": "S\qun""#, "#5", "nodes[4].name", "invalid escape"),
    (r#""name": "Sun""#, r#""name": "S\ud800un""#, "#5", "nodes[4].name", "hex escape"),
    ("  ]\n}", "  ]\n} {}", "", "", "trailing characters"),
    ("  ]\n}", "  ]", "", "", "ends before it is complete"),
    // Fields.
    (r#""name": "Head","#, r#""name": "Head", "color": 3,"#, "Head #2", "nodes[1].color", "unknown field"),
    (r#""radius": 0.5"#, r#""radus": 0.5"#, "Head #2", "nodes[1].object.shape.radus", "unknown field"),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "sphere""#,
        "Head #2",
        "nodes[1].object.shape.radius",
        "missing field",
    ),
    (r#""type": "sphere""#, r#""type": "sfere""#, "Head #2", "nodes[1].object.shape.type", "unknown variant `sfere`"),
    (r#""type": "sphere", "#, "", "Head #2", "nodes[1].object.shape.type", "missing field"),
    (
        r#""operator": "union""#,
        r#""operator": "onion""#,
        "Pawn #1",
        "nodes[0].group.operator",
        "unknown variant `onion`",
    ),
    (
        r#""kernel": "circular""#,
        r#""kernel": "round""#,
        "Pawn #1",
        "nodes[0].group.blend.kernel",
        "unknown variant `round`",
    ),
    (r#""type": "directional""#, r#""type": "moon""#, "Sun #5", "nodes[4].light.light.type", "unknown variant `moon`"),
    (r#""id": 3,"#, "", "Foot", "nodes[2].id", "missing field"),
    (r#""id": 3,"#, r#""id": 3, "id": 3,"#, "Foot #3", "nodes[2].id", "duplicate field"),
    (r#""environment""#, r#""enviroment""#, "", "enviroment", "unknown field"),
    (r#""albedo": [0.9, 0.8, 0.1], "#, "", "", "materials[1].albedo", "missing field"),
    (
        r#""mesh": {"path""#,
        r#""group": {"operator": "union", "blend": {"kernel": "cubic", "radius": 0}}, "mesh": {"path""#,
        "Duck #4",
        "nodes[3]",
        "exactly one of",
    ),
    (r#", "camera": {"fov_y": 40, "near": 0.001, "far": 10000}"#, "", "View #7", "nodes[6]", "exactly one of"),
    // Points.
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "tube", "points": [[0, 0, 0, 1]], "radius": 0.1, "closed": false"#,
        "Head #2",
        "nodes[1].object.shape.points",
        "must be 2 to 256 points, not 1",
    ),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "tube", "points": [[0, 0, 0, 1], [0, 1, 0, -1]], "radius": 0.1, "closed": false"#,
        "Head #2",
        "nodes[1].object.shape.points[1][3]",
        "must be 0 to",
    ),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "tube", "points": [[0, 0, 0, 1], [0, 1], [0, 0, 1, 1]], "radius": 0.1, "closed": false"#,
        "Head #2",
        "nodes[1].object.shape.points[1]",
        "invalid length 2",
    ),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "extrusion", "corners": [[0, 0], [1, 0]], "smooth": false, "depth": 1, "rounding": 0"#,
        "Head #2",
        "nodes[1].object.shape.corners",
        "must be 3 to 256 points, not 2",
    ),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "revolution", "corners": [[0, 0], [1, 0], [1, 1e10]], "smooth": false, "offset": 0"#,
        "Head #2",
        "nodes[1].object.shape.corners[2][1]",
        "must be -1e9 to 1e9 m",
    ),
    (
        r#""type": "sphere", "radius": 0.5"#,
        r#""type": "text", "text": "a\tb", "size": 1, "depth": 1, "rounding": 0"#,
        "Head #2",
        "nodes[1].object.shape.text",
        "must not hold control characters",
    ),
    // Types.
    (r#""radius": 0.5"#, r#""radius": "big""#, "Head #2", "nodes[1].object.shape.radius", "expected a number"),
    (r#""radius": 0.5"#, r#""radius": null"#, "Head #2", "nodes[1].object.shape.radius", "invalid type: null"),
    (r#""radius": 0.5"#, r#""radius": [1]"#, "Head #2", "nodes[1].object.shape.radius", "invalid type: sequence"),
    (r#""size": [1, 2, 3]"#, r#""size": [1, 2]"#, "Foot #3", "nodes[2].object.shape.size", "invalid length 2"),
    (
        r#""size": [1, 2, 3]"#,
        r#""size": [1, true, 3]"#,
        "Foot #3",
        "nodes[2].object.shape.size[1]",
        "invalid type: boolean",
    ),
    (r#""size": [1, 2, 3]"#, r#""size": [1, 2, 3, 4]"#, "Foot #3", "nodes[2].object.shape.size", "invalid length 4"),
    (
        r#""range": 50"#,
        r#""range": false"#,
        "Lamp #6",
        "nodes[5].light.light.attenuation.range",
        "invalid type: boolean",
    ),
    (
        r#""translation": [0, 2, 0]"#,
        r#""translation": [0, "2", 0]"#,
        "Head #2",
        "nodes[1].transform.translation[1]",
        "invalid type: string",
    ),
    (r#""id": 3,"#, r#""id": -3,"#, "Foot", "nodes[2].id", "invalid value: integer `-3`"),
    (r#""id": 3,"#, r#""id": 3.5,"#, "Foot", "nodes[2].id", "floating point"),
    (r#""id": 3,"#, r#""id": 18446744073709551616,"#, "Foot", "nodes[2].id", "floating point"),
    // Numbers.
    (r#""radius": 0.5"#, r#""radius": 1e999"#, "#2", "nodes[1].object.shape.radius", "number out of range"),
    (r#""radius": 0.5"#, r#""radius": NaN"#, "#2", "nodes[1].object.shape.radius", "expected"),
    (
        r#""radius": 0.5"#,
        r#""radius": 1e300"#,
        "Head #2",
        "nodes[1].object.shape.radius",
        "must be 0 to 1000000 m, not 1e300",
    ),
    (r#""radius": 0.5"#, r#""radius": -0.5"#, "Head #2", "nodes[1].object.shape.radius", "must be 0 to"),
    (r#""size": [1, 2, 3]"#, r#""size": [1, 2, -3]"#, "Foot #3", "nodes[2].object.shape.size[2]", "must be 0 to"),
    (r#""radius": 0.05"#, r#""radius": 0.05, "steps": 0"#, "Pawn #1", "nodes[0].group.blend.steps", "must be 1 to"),
    (r#""radius": 0.05"#, r#""radius": -1"#, "Pawn #1", "nodes[0].group.blend.radius", "must be 0 to"),
    (
        r#"[0, 2, 0]"#,
        r#"[0, 2e10, 0]"#,
        "Head #2",
        "nodes[1].transform.translation[1]",
        "must be -1e9 to 1e9 m, not 2e10",
    ),
    (
        r#""scale": [1, 1, -2]"#,
        r#""scale": [1, 0, -2]"#,
        "Head #2",
        "nodes[1].transform.scale[1]",
        "in magnitude, not 0",
    ),
    (r#"[0, 0, 0.6, 0.8]"#, r#"[0, 0, 0.6, 0.9]"#, "Head #2", "nodes[1].transform.rotation", "quaternion of length 1"),
    (r#"[0, 0, 0.6, 0.8]"#, r#"[0, 0, 0, 0]"#, "Head #2", "nodes[1].transform.rotation", "quaternion of length 1"),
    (r#""inner": 20"#, r#""inner": 40"#, "Lamp #6", "nodes[5].light.light.outer", "at least the inner angle of 40"),
    (r#""outer": 30"#, r#""outer": 95"#, "Lamp #6", "nodes[5].light.light.outer", "must be 0 to 89.9°, not 95"),
    (
        r#""constant": 1, "linear": 0, "quadratic": 0.1"#,
        r#""constant": 0, "linear": 0, "quadratic": 0"#,
        "Lamp #6",
        "nodes[5].light.light.attenuation.constant",
        "must not be 0",
    ),
    (r#""color": [1, 1, 1]"#, r#""color": [1, -1, 1]"#, "Sun #5", "nodes[4].light.color[1]", "must be 0 to"),
    (r#""fov_y": 40"#, r#""fov_y": 180"#, "View #7", "nodes[6].camera.fov_y", "must be 0.1 to 170°"),
    (r#""far": 10000"#, r#""far": 0.001"#, "View #7", "nodes[6].camera.far", "more than the near limit"),
    (r#""sky": [0.1, 0.2, 0.3]"#, r#""sky": [0.1, -0.2, 0.3]"#, "", "environment.sky[1]", "must be 0 to"),
    (r#""specular": 0.75"#, r#""specular": 1.5"#, "", "materials[1].specular", "must be 0 to 1, not 1.5"),
    (r#""shininess": 96.0"#, r#""shininess": 0.5"#, "", "materials[1].shininess", "must be 1 to"),
    // Attachments.
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": {"name": "x.png", "base64": "AAAA"}, "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image",
        "\"x.png\" must be a PNG, JPEG or EXR image",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": {"name": "x.png", "base64": "*"}, "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image",
        "\"x.png\" is not base 64",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "text", "text": "a", "font": {"name": "a\tb.ttf", "base64": "AAAA"}, "size": 1, "depth": 1, "rounding": 0}"#,
        "Head #2",
        "nodes[1].object.shape.font",
        "\"ab.ttf\" must be a TrueType or OpenType font",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": {"name": "x.png"}, "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image.base64",
        "missing field",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": {"base64": "AAAA"}, "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image.name",
        "missing field",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": {"name": "x", "base64": "", "size": 3}, "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image.size",
        "unknown field",
    ),
    (
        r#"{"type": "sphere", "radius": 0.5}"#,
        r#"{"type": "heightmap", "image": "x.png", "size": [1, 1, 1], "height": 1}"#,
        "Head #2",
        "nodes[1].object.shape.image",
        "expected a file in braces",
    ),
    // The second of two modifiers; its file has the same name as the first one's.
    (
        r#""name": "Foot","#,
        concat!(
            r#""name": "Foot", "modifiers": ["#,
            r#"{"modifier": {"type": "displacement", "image": null, "height": 1, "tile": 1, "axis": "y"}}, "#,
            r#"{"modifier": {"type": "displacement", "image": {"name": "x.png", "base64": "AAAA"}, "height": 1, "#,
            r#""tile": 1, "axis": "y"}}],"#
        ),
        "Foot #3",
        "nodes[2].modifiers[1].modifier.image",
        "\"x.png\" must be a PNG, JPEG or EXR image",
    ),
    (
        r#""name": "Foot","#,
        concat!(
            r#""name": "Foot", "modifiers": [{"modifier": "#,
            r#"{"type": "displacement", "image": null, "height": 1, "tile": 0, "axis": "y"}}],"#
        ),
        "Foot #3",
        "nodes[2].modifiers[0].modifier.tile",
        "must be 0.0001 to",
    ),
    (
        r#""name": "Foot","#,
        concat!(
            r#""name": "Foot", "modifiers": [{"modifier": "#,
            r#"{"type": "displacement", "image": null, "height": 1, "tile": 1, "axis": "w"}}],"#
        ),
        "Foot #3",
        "nodes[2].modifiers[0].modifier.axis",
        "unknown variant `w`",
    ),
    // Ids and references.
    (r#""id": 3,"#, r#""id": 2,"#, "Foot #2", "nodes[2].id", "another node has the id #2"),
    (r#""id": 3,"#, r#""id": 9007199254740992,"#, "Foot #9007199254740992", "nodes[2].id", "must be at most"),
    (r#""next_id": 9"#, r#""next_id": 18446744073709551615"#, "", "next_id", "must be at most"),
    (
        r#""id": 2, "name": "Gold""#,
        r#""id": 1, "name": "Gold""#,
        "",
        "materials[1].id",
        "another material has the id #1",
    ),
    (
        r#""id": 2, "name": "Gold""#,
        r#""id": 9007199254740992, "name": "Gold""#,
        "",
        "materials[1].id",
        "must be at most",
    ),
    (r#""material": 2"#, r#""material": 7"#, "Foot #3", "nodes[2].object.material", "there is no material #7"),
    (r#""material": null"#, r#""material": 7"#, "Duck #4", "nodes[3].mesh.material", "there is no material #7"),
    (r#""id": 3, "parent": 1"#, r#""id": 3, "parent": 77"#, "Foot #3", "nodes[2].parent", "there is no node #77"),
    (
        r#""id": 3, "parent": 1"#,
        r#""id": 3, "parent": 2"#,
        "Foot #3",
        "nodes[2].parent",
        "node #2 is neither a group nor",
    ),
    (r#""id": 8,"#, r#""id": 8, "parent": 8,"#, "Rest #8", "nodes[7].parent", "in a circle"),
    (
        r#""id": 1, "name": "Pawn""#,
        r#""id": 1, "parent": 1, "name": "Pawn""#,
        "Pawn #1",
        "nodes[0].parent",
        "in a circle",
    ),
    // Names and paths.
    (r#""Head""#, "\"He\\nad\"", "He\u{fffd}ad #2", "nodes[1].name", "control characters"),
    (r#""Gold""#, "\"Go\\u0000ld\"", "", "materials[1].name", "control characters"),
    ("models/duck.glb", "/models/duck.glb", "Duck #4", "nodes[3].mesh.path", "relative to the scene's folder"),
    ("models/duck.glb", "models/../../duck.glb", "Duck #4", "nodes[3].mesh.path", "inside the scene's folder"),
    ("models/duck.glb", "models\\\\duck.glb", "Duck #4", "nodes[3].mesh.path", "forward slashes"),
    ("models/duck.glb", "C:/duck.glb", "Duck #4", "nodes[3].mesh.path", "relative to the scene's folder"),
    (
        "models/duck.glb",
        "https://example.org/duck.glb",
        "Duck #4",
        "nodes[3].mesh.path",
        "relative to the scene's folder",
    ),
    ("models/duck.glb", "", "Duck #4", "nodes[3].mesh.path", "must name a file"),
    (
        r#""name": "Duck""#,
        r#""name": "Duck", "negative": true"#,
        "Duck #4",
        "nodes[3].operation",
        "only objects and groups",
    ),
];

fn refused(bytes: &[u8]) -> file::FileError {
    match file::parse(bytes, Path::new("dir/scene.json")) {
        Ok(_) => panic!("was read: {}", String::from_utf8_lossy(&bytes[..bytes.len().min(3_000)])),
        Err(error) => error,
    }
}

/// Whether the message contains all three.
fn names(error: &file::FileError, node: &str, field: &str, reason: &str) -> bool {
    error.file == "dir/scene.json"
        && error.node.is_some() != node.is_empty()
        && error.node.as_deref().unwrap_or("").ends_with(node)
        && error.field.as_deref().unwrap_or("") == field
        && error.reason.contains(reason)
}

#[test]
fn every_broken_file_is_refused_with_its_place() {
    assert!(file::parse(GOOD.as_bytes(), Path::new("x")).is_ok());
    let mut wrong = Vec::new();
    for (from, to, node, field, reason) in CASES {
        let text = GOOD.replacen(from, to, 1);
        assert_ne!(text, GOOD, "{from} is not in the file");
        let error = refused(text.as_bytes());
        if !names(&error, node, field, reason) {
            wrong.push(format!("expected {node}: {field}: {reason}\n     got {error}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    assert!(CASES.len() >= 50);
}

#[test]
fn files_that_are_no_json_are_refused() {
    let cases: [(&[u8], &str); 10] = [
        (b"", "ends before it is complete"),
        (b"   \n", "ends before it is complete"),
        (b"\x00\x01\x02", "line 1, column 1"),
        (b"{\n\"isolith\": 1, \"\xff\": 2}", "line 2, column 16: is not text in UTF-8"),
        (b"\xff\xfe{\x00}\x00", "is not text in UTF-8"),
        (b"[]", "expected"),
        (b"1", "expected"),
        (b"null", "expected"),
        (b"\"isolith\"", "expected"),
        (b"glTF\x02\x00\x00\x00", "expected"),
    ];
    for (bytes, reason) in cases {
        let error = refused(bytes);
        assert!(error.reason.contains(reason), "{reason}: {error}");
    }
}

#[test]
fn long_circles_of_parents_are_found() {
    let count = 5_000;
    let nodes: Vec<String> = (0..count)
        .map(|i| {
            let parent = (i + 1) % count;
            let blend = r#"{"kernel": "cubic", "radius": 0}"#;
            format!(r#"{{"id": {i}, "parent": {parent}, "group": {{"operator": "union", "blend": {blend}}}}}"#)
        })
        .collect();
    let text = format!("{{\"isolith\": 1, \"nodes\": [{}]}}", nodes.join(",\n"));
    assert!(names(&refused(text.as_bytes()), "#0", "nodes[0].parent", "in a circle"));
}

#[test]
fn bombs_are_refused_before_they_grow() {
    // Nesting, both in values that the reader skips and in those that it reads.
    let deep = "[".repeat(1_000_000);
    for text in [deep.clone(), GOOD.replacen("0.5}", &format!("{deep}}}"), 1), format!("{{\"isolith\": {deep}")] {
        let reason = refused(text.as_bytes()).reason;
        let reasons = ["recursion limit", "invalid type", "holds more than 65536 values"];
        assert!(reasons.iter().any(|part| reason.contains(part)), "{reason}");
    }
    // More entries than allowed.
    let camera = r#"{"id": 1, "camera": {"fov_y": 40, "near": 1, "far": 2}}"#;
    let many = format!("{{\"isolith\": 1, \"nodes\": [{}{camera}]}}", format!("{camera},").repeat(100_000));
    assert!(names(&refused(many.as_bytes()), "", "nodes", "more than 100000 entries"));
    // Names.
    let long = GOOD.replacen("\"Head\"", &format!("\"{}\"", "x".repeat(257)), 1);
    let error = refused(long.as_bytes());
    assert!(names(&error, "#2", "nodes[1].name", "at most 256 characters"), "{error}");
    assert!(error.node.expect("named").len() < 100);
}

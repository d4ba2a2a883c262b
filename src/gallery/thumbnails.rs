//! Small pictures of the example scenes and templates. Those of the examples are the pictures of the golden tests, made
//! smaller; a test of the editor compares them, and says how to make one again.

/// A scene and its picture, a JPEG.
macro_rules! pictures {
    ($($name:literal),* $(,)?) => {
        const PICTURES: &[(&str, &[u8])] = &[$(($name, include_bytes!(concat!("thumbnails/", $name, ".jpg")))),*];
    };
}

pictures![
    "asteroids",
    "boolean-operations",
    "character",
    "chessboard",
    "city",
    "drawn",
    "dynamics-2d",
    "fractals",
    "image-lit",
    "keyframes",
    "light-figures",
    "lights",
    "machine",
    "materials",
    "mesh-and-fields",
    "modifiers",
    "ocean",
    "operators",
    "painted",
    "pawn",
    "puppet",
    "shadows",
    "shapes",
    "showcase",
    "stanford",
    "template-character",
    "template-landscape",
    "template-studio",
    "terrain",
    "textures",
    "transparency",
];

/// The bytes of a JPEG that shows the scene of this file name, or the template of this name in lower case behind
/// `template-`; `None` for test scenes.
pub fn thumbnail(name: &str) -> Option<&'static [u8]> {
    PICTURES.iter().find(|(other, _)| *other == name).map(|(_, bytes)| *bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{all, is_test_scene, templates};

    #[test]
    fn every_example_and_template_has_a_picture_and_no_picture_is_left_over() {
        let examples = all().into_iter().map(|(name, _)| name.to_owned()).filter(|name| !is_test_scene(name));
        let templates = templates().into_iter().map(|template| format!("template-{}", template.name.to_lowercase()));
        let mut named: Vec<String> = examples.chain(templates).collect();
        named.sort();
        assert_eq!(PICTURES.iter().map(|(name, _)| *name).collect::<Vec<_>>(), named);
        assert!(thumbnail("random-37").is_none());
    }
}

//! Linear light in OpenEXR: f32 channels R, G, B and A, with the view of the scene as attributes.

use std::io::{Cursor, Error};

use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage};

use super::exr_header::sort_attributes;
use crate::scene::DisplaySettings;

/// An image of `radiance`: light before exposure and view transform, multiplied by coverage, and coverage. The
/// attributes name what was left out: `isolith.exposure` in stops, `isolith.viewTransform`, and `isolith.samples`.
pub fn encode(
    [width, height]: [u32; 2],
    radiance: &[[f32; 4]],
    display: &DisplaySettings,
    samples: u32,
) -> Result<Vec<u8>, Error> {
    let pixel = |Vec2(x, y): Vec2<usize>| {
        let [r, g, b, a] = radiance[y * width as usize + x];
        (r, g, b, a)
    };
    let mut attributes = LayerAttributes { software_name: Some(Text::new_or_panic("Isolith")), ..Default::default() };
    attributes.other.extend(view_attributes(display, samples));
    let size = (width as usize, height as usize);
    let layer = Layer::new(size, attributes, Encoding::FAST_LOSSLESS, SpecificChannels::rgba(pixel));
    let mut bytes = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.map_err(|error| Error::other(error.to_string()))?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// The attributes about the view of the scene.
pub fn view_attributes(display: &DisplaySettings, samples: u32) -> [(Text, AttributeValue); 3] {
    let view_transform = Text::new_or_panic(display.view_transform.label());
    [
        ("isolith.exposure", AttributeValue::F32(display.exposure as f32)),
        ("isolith.viewTransform", AttributeValue::Text(view_transform)),
        ("isolith.samples", AttributeValue::I32(samples.try_into().unwrap_or(i32::MAX))),
    ]
    .map(|(name, value)| (Text::new_or_panic(name), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ViewTransform;
    use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};

    #[test]
    fn light_is_kept_to_the_last_bit_with_its_attributes() {
        let radiance = [[1e-12, 0.1, 70_000.0, 1.0], [0.25, 0.0, 3.0, 0.5]];
        let display = DisplaySettings { exposure: -1.5, view_transform: ViewTransform::Agx };
        let bytes = encode([2, 1], &radiance, &display, 16).expect("written");
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), bytes).expect("written");
        let layer = &read_all_flat_layers_from_file(file.path()).expect("it reads back").layer_data[0];
        for (channel, name, index) in layer
            .channel_data
            .list
            .iter()
            .zip(["A", "B", "G", "R"])
            .zip([3, 2, 1, 0])
            .map(|((channel, name), index)| (channel, name, index))
        {
            assert_eq!(channel.name.to_string(), name);
            let FlatSamples::F32(values) = &channel.sample_data else { panic!("not f32: {name}") };
            assert_eq!(*values, radiance.map(|pixel| pixel[index]), "{name}");
        }
        let attribute = |name: &str| layer.attributes.other.get(&Text::new_or_panic(name)).cloned();
        assert_eq!(attribute("isolith.exposure"), Some(AttributeValue::F32(-1.5)));
        assert_eq!(attribute("isolith.viewTransform"), Some(AttributeValue::Text(Text::new_or_panic("AgX"))));
        assert_eq!(attribute("isolith.samples"), Some(AttributeValue::I32(16)));
    }
}

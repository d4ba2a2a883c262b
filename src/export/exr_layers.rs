//! A whole picture in one OpenEXR file: linear light and what compositing needs, as channels `layer.channel` of one
//! part, which every reader of OpenEXR shows as layers.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Cursor, Error};

use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage,
};

use super::exr_header::sort_attributes;
use super::exr_light::view_attributes;
use super::still::Drawn;
use crate::scene::DisplaySettings;

/// Channels R, G, B, A: light as in a file without layers. `depth.Z` in meters along the ray, infinite for the
/// background; `normal.X`, `.Y`, `.Z` in the world; `albedo.R`, `.G`, `.B`, the linear base color; `node.id`, a whole
/// number, 0 for the background, and `node.high` with the bits from 2^32 on where there are any. The attribute
/// `isolith.nodes` names the nodes that are seen, as a JSON object from id to name.
pub fn encode(
    picture: &Drawn,
    ids: &[u64],
    names: &BTreeMap<u64, String>,
    display: &DisplaySettings,
    samples: u32,
) -> Result<Vec<u8>, Error> {
    let Drawn { buffers, base_colors } = picture;
    let floats = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let mut channels = SmallVec::new();
    for (index, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
        channels.push(floats(name, buffers.radiance.iter().map(|pixel| pixel[index]).collect()));
    }
    channels.push(floats("depth.Z", buffers.depth.clone()));
    for (layer, axes, values) in
        [("normal", ["X", "Y", "Z"], &buffers.normal), ("albedo", ["R", "G", "B"], base_colors)]
    {
        for (index, axis) in axes.into_iter().enumerate() {
            channels.push(floats(&format!("{layer}.{axis}"), values.iter().map(|pixel| pixel[index]).collect()));
        }
    }
    let words = |shift: u32| FlatSamples::U32(ids.iter().map(|id| (id >> shift) as u32).collect());
    channels.push(AnyChannel::new("node.id", words(0)));
    if ids.iter().any(|id| id >> 32 != 0) {
        channels.push(AnyChannel::new("node.high", words(32)));
    }
    let mut attributes = LayerAttributes { software_name: Some(Text::new_or_panic("Isolith")), ..Default::default() };
    attributes.other.extend(view_attributes(display, samples));
    attributes.other.insert(Text::new_or_panic("isolith.nodes"), AttributeValue::Text(legend(ids, names)));
    let size = (buffers.width as usize, buffers.height as usize);
    let layer = Layer::new(size, attributes, Encoding::FAST_LOSSLESS, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.map_err(|error| Error::other(error.to_string()))?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes);
    Ok(bytes)
}

/// The names of the ids that occur, as JSON in ASCII: attributes hold bytes, and readers disagree about the rest.
fn legend(ids: &[u64], names: &BTreeMap<u64, String>) -> Text {
    let seen: BTreeSet<u64> = ids.iter().copied().filter(|id| *id != 0).collect();
    let named = seen.iter().map(|id| (id.to_string(), names.get(id).cloned().unwrap_or_default().into()));
    let json = serde_json::Value::Object(named.collect()).to_string();
    let mut ascii = String::with_capacity(json.len());
    for unit in json.chars() {
        match unit.is_ascii() {
            true => ascii.push(unit),
            false => unit.encode_utf16(&mut [0; 2]).iter().for_each(|u| ascii += &format!("\\u{u:04x}")),
        }
    }
    Text::new_or_panic(ascii)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::GBuffer;
    use exr::prelude::read_all_flat_layers_from_file;

    #[test]
    fn every_layer_reads_back_to_the_last_bit_with_the_names_of_its_nodes() {
        let radiance = vec![[1e-12, 0.1, 70_000.0, 1.0], [0.25, 0.0, 3.0, 0.5]];
        let normal = vec![[0.6, 0.0, 0.8], [0.0; 3]];
        let buffers = GBuffer { depth: vec![1.5, f32::INFINITY], normal, radiance, ..GBuffer::empty(2, 1) };
        let picture = Drawn { buffers, base_colors: vec![[0.1, 0.2, 0.3], [0.0; 3]] };
        let ids = [(1 << 33) + 7, 0];
        let names = BTreeMap::from([(ids[0], "Kugel \"ß\" 😀".to_owned()), (5, "unseen".to_owned())]);
        let bytes = encode(&picture, &ids, &names, &DisplaySettings::default(), 4).expect("written");
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), bytes).expect("written");
        let layer = &read_all_flat_layers_from_file(file.path()).expect("it reads back").layer_data[0];
        let channel = |name: &str| {
            let found = layer.channel_data.list.iter().find(|channel| channel.name.to_string() == name);
            &found.unwrap_or_else(|| panic!("no channel {name}")).sample_data
        };
        let floats = |name: &str| match channel(name) {
            FlatSamples::F32(values) => values.clone(),
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!(floats("B"), [70_000.0, 3.0]);
        assert_eq!(floats("depth.Z"), [1.5, f32::INFINITY]);
        assert_eq!((floats("normal.X"), floats("albedo.G")), (vec![0.6, 0.0], vec![0.2, 0.0]));
        let words = |name: &str| match channel(name) {
            FlatSamples::U32(values) => values.clone(),
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!((words("node.id"), words("node.high")), (vec![7, 0], vec![2, 0]));
        let attribute = layer.attributes.other.get(&Text::new_or_panic("isolith.nodes"));
        let Some(AttributeValue::Text(text)) = attribute else { panic!("no names") };
        let named: BTreeMap<u64, String> = serde_json::from_str(&text.to_string()).expect("JSON");
        assert_eq!(named, BTreeMap::from([(ids[0], "Kugel \"ß\" 😀".to_owned())]));
    }
}

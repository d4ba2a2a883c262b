//! OpenEXR images: selects the channels that make up the height or the color.

use std::io::Cursor;

use exr::image::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, Layers};
use exr::meta::MetaData;
use exr::meta::attribute::IntegerBounds;
use exr::prelude::{ReadChannels, ReadLayers};
use image::{ImageBuffer, Luma};

use crate::decode_budget::{check_size, spend};

/// The weights of red, green and blue in the luminance: those of Rec. 709, the default of EXR.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// A luminance image.
type Gray = ImageBuffer<Luma<f32>, Vec<f32>>;

/// Luminance from 0 to 1 within the display window, black where there is no data; and the number of decoded pixels.
pub fn read(bytes: &[u8]) -> Result<(Gray, u64), String> {
    let Decoded { image, window, pixels } = decode(bytes)?;
    let shown = Shown::new(&image, window)?;
    let value = |x: u32, y: u32| Luma([shown.weighted(x, y, &LUMINANCE) as f32]);
    Ok((ImageBuffer::from_fn(window.size.0 as u32, window.size.1 as u32, value), pixels))
}

/// The size of the display window, red, green and blue of its pixels from 0 to 1, black where there is no data; and the
/// number of decoded pixels. An image of one channel is gray.
pub fn read_colors(bytes: &[u8]) -> Result<([u32; 2], Vec<f64>, u64), String> {
    let Decoded { image, window, pixels } = decode(bytes)?;
    let shown = Shown::new(&image, window)?;
    let size = [window.size.0 as u32, window.size.1 as u32];
    let mut colors = Vec::with_capacity(3 * size[0] as usize * size[1] as usize);
    for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
        colors.extend([0, 1, 2].map(|channel| {
            let mut weights = [0.0; 3];
            weights[channel] = 1.0;
            shown.weighted(x, y, &weights)
        }));
    }
    Ok((size, colors, pixels))
}

/// A decoded file.
struct Decoded {
    image: Image<Layers<AnyChannels<FlatSamples>>>,
    /// The display window.
    window: IntegerBounds,
    /// Number of decoded pixels.
    pixels: u64,
}

fn decode(bytes: &[u8]) -> Result<Decoded, String> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| e.to_string())?;
    let (mut pixels, mut size) = (0_u64, 0_u64);
    for header in &meta.headers {
        if header.deep {
            return Err("it has deep data, many samples in a pixel".to_owned());
        }
        let area = header.layer_size.0 as u64 * header.layer_size.1 as u64;
        size = size.saturating_add(area.saturating_mul(header.channels.bytes_per_pixel as u64));
        pixels += check_size([header.layer_size.0 as u64, header.layer_size.1 as u64], size)?;
    }
    let window = meta.headers.first().ok_or("it is empty")?.shared_attributes.display_window;
    let shown = check_size([window.size.0 as u64, window.size.1 as u64], size)?;
    spend(pixels.max(shown))?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    Ok(Decoded { image, window, pixels: pixels.max(shown) })
}

/// The channels that an image shows, and where they are.
struct Shown<'a> {
    layer: &'a Layer<AnyChannels<FlatSamples>>,
    /// Red, green and blue, or one for all.
    sources: Vec<&'a FlatSamples>,
    /// From the display window to the data.
    offset: [i64; 2],
}

impl<'a> Shown<'a> {
    fn new(image: &'a Image<Layers<AnyChannels<FlatSamples>>>, window: IntegerBounds) -> Result<Self, String> {
        let (layer, sources) =
            image.layer_data.iter().find_map(|layer| Some((layer, sources(layer)?))).ok_or_else(|| {
                let channels = image.layer_data.iter().flat_map(|layer| &layer.channel_data.list);
                let names: Vec<String> =
                    channels.map(|channel| format!("{:?}", channel.name.to_string())).take(8).collect();
                format!(
                    "of its channels {} none is Y, none are R, G and B, and more than one could be meant",
                    names.join(", ")
                )
            })?;
        let offset = [0, 1].map(|axis| {
            let [data, shown] =
                [layer.attributes.layer_position, window.position].map(|p| if axis == 0 { p.0 } else { p.1 });
            i64::from(shown) - i64::from(data)
        });
        Ok(Self { layer, sources, offset })
    }

    /// The sum of the channels of a pixel of the window, each between 0 and 1, with these weights.
    fn weighted(&self, x: u32, y: u32, weights: &[f64; 3]) -> f64 {
        let [x, y] = [i64::from(x) + self.offset[0], i64::from(y) + self.offset[1]];
        let size = self.layer.size;
        if x < 0 || y < 0 || x >= size.0 as i64 || y >= size.1 as i64 {
            return 0.0;
        }
        let i = y as usize * size.0 + x as usize;
        let sum: f64 = match self.sources[..] {
            [only] => sample(only, i),
            _ => self.sources.iter().zip(weights).map(|(samples, weight)| sample(samples, i) * weight).sum(),
        };
        // NaN becomes 0.
        if sum > 0.0 { sum.min(1.0) } else { 0.0 }
    }
}

fn sample(samples: &FlatSamples, i: usize) -> f64 {
    match samples {
        FlatSamples::F16(values) => values.get(i).map_or(0.0, |v| v.to_f32().into()),
        FlatSamples::F32(values) => values.get(i).copied().map_or(0.0, f64::from),
        FlatSamples::U32(values) => values.get(i).copied().map_or(0.0, f64::from),
    }
}

/// The channels of a layer that are shown: R, G and B, or Y, or the only one besides alpha. The part of a channel's name before the last dot is the name of a layer within the file.
fn sources(layer: &Layer<AnyChannels<FlatSamples>>) -> Option<Vec<&FlatSamples>> {
    let name = |channel: &AnyChannel<FlatSamples>| {
        let whole = channel.name.to_string();
        whole.rsplit('.').next().unwrap_or_default().to_owned()
    };
    let full = |channel: &&AnyChannel<FlatSamples>| channel.sampling.0 == 1 && channel.sampling.1 == 1;
    let all: Vec<_> = layer.channel_data.list.iter().filter(full).collect();
    let find = |wanted: &str| all.iter().find(|channel| name(channel) == wanted).map(|channel| &channel.sample_data);
    if let (Some(r), Some(g), Some(b)) = (find("R"), find("G"), find("B")) {
        return Some(vec![r, g, b]);
    }
    if let Some(y) = find("Y") {
        return Some(vec![y]);
    }
    let others: Vec<_> = all.iter().filter(|channel| name(channel) != "A").collect();
    match others[..] {
        [only] => Some(vec![&only.sample_data]),
        _ => None,
    }
}

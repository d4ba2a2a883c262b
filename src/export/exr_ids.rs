//! Ids as whole numbers in OpenEXR: 32-bit channels, without rounding.

use std::io::{Cursor, Error};

use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, SmallVec, WritableImage};

/// An image with the channel `id`, and, if ids exceed 32 bits, `id.high` with the upper bits.
pub fn encode(width: u32, height: u32, ids: &[u64]) -> Result<Vec<u8>, Error> {
    let channel = |name: &str, shift: u32| {
        AnyChannel::new(name, FlatSamples::U32(ids.iter().map(|id| (id >> shift) as u32).collect()))
    };
    let mut channels = SmallVec::from_vec(vec![channel("id", 0)]);
    if ids.iter().any(|id| id >> 32 != 0) {
        channels.push(channel("id.high", 32));
    }
    let image = Image::from_channels((width as usize, height as usize), AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).map_err(|error| Error::other(error.to_string()))?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::read_all_flat_layers_from_file;

    /// The channels of a file with these bytes.
    fn read(bytes: &[u8]) -> Vec<(String, Vec<u32>)> {
        let file = tempfile::NamedTempFile::new().expect("a temporary file");
        std::fs::write(file.path(), bytes).expect("written");
        let image = read_all_flat_layers_from_file(file.path()).expect("it reads back");
        let values = |samples: &FlatSamples| match samples {
            FlatSamples::U32(values) => values.clone(),
            other => panic!("not whole numbers: {other:?}"),
        };
        image.layer_data[0].channel_data.list.iter().map(|c| (c.name.to_string(), values(&c.sample_data))).collect()
    }

    #[test]
    fn ids_that_a_float_would_round_are_kept() {
        let ids = [0, 1, (1 << 24) + 1, u64::from(u32::MAX)];
        let found = read(&encode(2, 2, &ids).expect("written"));
        assert_eq!(found, [("id".to_owned(), ids.map(|id| id as u32).to_vec())]);
        let large = [(1 << 53) - 1, 7];
        let found = read(&encode(2, 1, &large).expect("written"));
        assert_eq!(found[0], ("id".to_owned(), vec![u32::MAX, 7]));
        assert_eq!(found[1], ("id.high".to_owned(), vec![(1 << 21) - 1, 0]));
    }
}

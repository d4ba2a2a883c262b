//! The same picture is the same file: attributes of an OpenEXR header in the order of their names. The encoder writes
//! them in an order that changes from run to run.

/// Bytes before the first attribute: the magic number, and the version with its flags.
const PREFIX: usize = 8;

/// Sorts the attributes of a file of one part. What is not understood stays as it is.
pub fn sort_attributes(bytes: &mut [u8]) {
    let Some((attributes, end)) = attributes(bytes) else { return };
    let mut sorted: Vec<Vec<u8>> = attributes.into_iter().map(|range| bytes[range].to_vec()).collect();
    sorted.sort();
    // As long as before, so that the offsets of the pixels stay right.
    bytes[PREFIX..end].copy_from_slice(&sorted.concat());
}

/// The ranges of the attributes, and the end of the last: a name and a type, each ended by 0, the length of the value in
/// four bytes, and the value.
fn attributes(bytes: &[u8]) -> Option<(Vec<std::ops::Range<usize>>, usize)> {
    let (mut found, mut at) = (Vec::new(), PREFIX);
    while *bytes.get(at)? != 0 {
        let ended = |from: usize| bytes.get(from..)?.iter().position(|byte| *byte == 0).map(|length| from + length + 1);
        let value = ended(ended(at)?)?;
        let length = i32::from_le_bytes(bytes.get(value..value + 4)?.try_into().ok()?);
        let end = (value + 4).checked_add(usize::try_from(length).ok()?).filter(|end| *end < bytes.len())?;
        found.push(at..end);
        at = end;
    }
    Some((found, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header with these attributes, of one byte each, and a pixel.
    fn file(names: &[&str]) -> Vec<u8> {
        let mut bytes = vec![0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0];
        for name in names {
            bytes.extend([name.as_bytes(), b"\0int\0", &[1, 0, 0, 0], &[7]].concat());
        }
        bytes.extend([0, 99]);
        bytes
    }

    #[test]
    fn attributes_are_sorted_and_nothing_else_changes() {
        let mut bytes = file(&["width", "a", "channels"]);
        sort_attributes(&mut bytes);
        assert_eq!(bytes, file(&["a", "channels", "width"]));
        let broken = file(&["width", "a"])[..14].to_vec();
        let mut same = broken.clone();
        sort_attributes(&mut same);
        assert_eq!(same, broken);
    }
}

//! A hash of contents, the same on every machine and in every version, because files store it.

/// 128 bits that identify contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ContentKey(pub [u64; 2]);

impl std::fmt::Display for ContentKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}{:016x}", self.0[0], self.0[1])
    }
}

/// A hash under way: two lanes of multiplications whose halves are folded, as in wyhash (Wang Yi). It finds accidents,
/// not forgeries.
#[derive(Clone, Debug)]
pub struct ContentHash {
    lanes: [u64; 2],
    words: u64,
}

/// Digits of the square roots of 2 and 3, odd.
const KEYS: [u64; 2] = [0x6a09_e667_f3bc_c909, 0xbb67_ae85_84ca_a73b];

impl Default for ContentHash {
    fn default() -> Self {
        Self { lanes: [KEYS[1], KEYS[0]], words: 0 }
    }
}

impl ContentHash {
    /// Adds a number.
    pub fn word(&mut self, word: u64) {
        let [a, b] = self.lanes;
        self.lanes = [fold(a ^ word, KEYS[0]).wrapping_add(b), fold(b.rotate_left(29) ^ word, KEYS[1]) ^ word];
        self.words += 1;
    }

    /// Adds bytes and their number.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.word(bytes.len() as u64);
        let (words, rest) = bytes.as_chunks::<8>();
        words.iter().for_each(|word| self.word(u64::from_le_bytes(*word)));
        let mut last = [0; 8];
        last[..rest.len()].copy_from_slice(rest);
        self.word(u64::from_le_bytes(last));
    }

    /// The hash of all that was added.
    pub fn key(mut self) -> ContentKey {
        for end in [self.words, !self.words] {
            self.word(end);
        }
        ContentKey(self.lanes)
    }
}

fn fold(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    product as u64 ^ (product >> 64) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(bytes: &[u8]) -> ContentKey {
        let mut hash = ContentHash::default();
        hash.bytes(bytes);
        hash.key()
    }

    #[test]
    fn every_bit_counts_and_so_does_the_length() {
        let bytes: Vec<u8> = (0..100).collect();
        let mut keys: Vec<_> = (0..bytes.len()).map(|length| key(&bytes[..length])).collect();
        for bit in 0..8 * bytes.len() {
            let mut other = bytes.clone();
            other[bit / 8] ^= 1 << (bit % 8);
            keys.push(key(&other));
        }
        keys.push(key(&[0; 8]));
        keys.push(key(&[0; 16]));
        let count = keys.len();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}

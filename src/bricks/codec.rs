//! Bricks as bytes. Nothing of them is trusted: what is read back is complete, undamaged, of the expected contents, and
//! names no texel that is not there.

use glam::DVec3;
use isolith_geometry::Aabb;

use super::{BRICK_TEXELS, BrickGrid, Bricks, ContentHash, ContentKey, INSIDE, Looks, MAX_BRICK_TEXELS};

/// The first bytes of a file of bricks.
pub const CODEC_MAGIC: [u8; 8] = *b"isobrick";
/// The version of the layout.
const VERSION: u32 = 2;
/// Bytes before the texels.
const HEADER: usize = 8 + 4 + 4 + 16 + 8 * 10 + 4 * 4 + 3 * 8;
/// Bytes behind them.
const CHECKSUM: usize = 16;

/// Why bytes are not the expected bricks.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CodecError {
    /// They are something else.
    #[error("is not a file of bricks")]
    Foreign,
    /// They are of a version that this program does not read.
    #[error("is of version {0}, and this program reads {VERSION}")]
    Version(u32),
    /// There are too few or too many.
    #[error("has {found} bytes instead of {expected}")]
    Length {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// They have changed since.
    #[error("is damaged: its checksum differs")]
    Damaged,
    /// They were made of something else.
    #[error("was made of other contents")]
    Stale,
    /// They contradict themselves.
    #[error("contradicts itself: {0}")]
    Inconsistent(&'static str),
}

/// Bricks of the contents with this key, as bytes.
pub fn to_bytes(bricks: &Bricks, key: ContentKey) -> Vec<u8> {
    let looks = bricks.looks.as_ref().map_or(&[][..], |looks| &looks.texels);
    let mut out = Vec::with_capacity(HEADER + CHECKSUM + 16 * (bricks.texels.len() + looks.len()));
    out.extend(CODEC_MAGIC);
    out.extend(VERSION.to_le_bytes());
    out.extend(u32::from(bricks.looks.is_some()).to_le_bytes());
    out.extend(key.0.iter().flat_map(|word| word.to_le_bytes()));
    let Bricks { grid, bounds, .. } = bricks;
    let points = [grid.origin, bounds.min, bounds.max].into_iter().flat_map(|p| p.to_array());
    let numbers = points.chain([grid.voxel]);
    out.extend(numbers.flat_map(f64::to_le_bytes));
    out.extend(grid.cells.into_iter().chain([bricks.first_brick]).flat_map(u32::to_le_bytes));
    let first_look = bricks.looks.as_ref().map_or(0, |looks| looks.first_look as usize);
    out.extend([bricks.texels.len(), looks.len(), first_look].iter().flat_map(|n| (*n as u64).to_le_bytes()));
    out.extend(bricks.texels.iter().chain(looks).flatten().flat_map(|word| word.to_le_bytes()));
    let sum = checksum(&out);
    out.extend(sum.0.iter().flat_map(|word| word.to_le_bytes()));
    out
}

/// The bricks that these bytes hold, if they were made of the contents with this key.
///
/// # Errors
/// The reason why they are not.
pub fn from_bytes(bytes: &[u8], key: ContentKey) -> Result<Bricks, CodecError> {
    if !bytes.starts_with(&CODEC_MAGIC) {
        return Err(CodecError::Foreign);
    }
    let mut read = Words { bytes, at: CODEC_MAGIC.len() };
    let too_short = CodecError::Length { found: bytes.len(), expected: HEADER + CHECKSUM };
    if bytes.len() < CODEC_MAGIC.len() + 4 {
        return Err(too_short);
    }
    let version = read.word();
    if version != VERSION {
        return Err(CodecError::Version(version));
    }
    if bytes.len() < HEADER + CHECKSUM {
        return Err(too_short);
    }
    let has_looks = read.word() == 1;
    let own_key = ContentKey([read.long(), read.long()]);
    let [origin, min, max] = [0; 3].map(|_| DVec3::new(read.number(), read.number(), read.number()));
    let voxel = read.number();
    let [x, y, z, first_brick] = [0; 4].map(|_| read.word());
    let [texels, looks, first_look] = [0; 3].map(|_| read.long());
    let is_possible = texels <= MAX_BRICK_TEXELS as u64 && looks <= 2 * MAX_BRICK_TEXELS as u64;
    let expected = HEADER + CHECKSUM + 16 * (texels.saturating_add(looks)).min(1 << 40) as usize;
    if !is_possible || bytes.len() != expected {
        return Err(CodecError::Length { found: bytes.len(), expected });
    }
    let (content, sum) = bytes.split_at(bytes.len() - CHECKSUM);
    let mut stored = Words { bytes: sum, at: 0 };
    if checksum(content) != ContentKey([stored.long(), stored.long()]) {
        return Err(CodecError::Damaged);
    }
    if own_key != key {
        return Err(CodecError::Stale);
    }
    let mut texel = || [0; 4].map(|_| read.word());
    let all: Vec<[u32; 4]> = (0..texels).map(|_| texel()).collect();
    let looks = Looks { texels: (0..looks).map(|_| texel()).collect(), first_look: first_look as u32 };
    let bricks = Bricks {
        grid: BrickGrid { origin, voxel, cells: [x, y, z] },
        bounds: Aabb::new(min, max),
        first_brick,
        texels: all,
        looks: has_looks.then_some(looks),
    };
    bricks.check().map_err(CodecError::Inconsistent)?;
    Ok(bricks)
}

impl Bricks {
    /// Checks that every number is finite and every place within the texels, so that nobody reads outside of them.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), &'static str> {
        let ensure = |is_so: bool, what| if is_so { Ok(()) } else { Err(what) };
        let Self { grid, bounds, .. } = self;
        let sides = grid.cells.iter().try_fold(1_usize, |all, n| all.checked_mul(*n as usize));
        let cells = sides.filter(|n| (1..=MAX_BRICK_TEXELS).contains(n)).ok_or("its grid has no cells, or too many")?;
        let is_grid = grid.origin.is_finite() && grid.voxel > 0.0 && grid.voxel.is_finite();
        ensure(is_grid && grid.bounds().is_finite(), "its grid is nowhere")?;
        ensure(bounds.is_finite() && !bounds.is_empty(), "its bounds are none")?;
        let within = grid.bounds().expanded(grid.voxel);
        ensure(within.contains(bounds.min) && within.contains(bounds.max), "its bounds exceed its grid")?;
        let entries = cells.div_ceil(4);
        let first = self.first_brick as usize;
        ensure(entries <= first && first <= self.texels.len(), "its samples start elsewhere")?;
        ensure((first - entries).is_multiple_of(2), "half of a cell's entries is missing")?;
        ensure((self.texels.len() - first).is_multiple_of(BRICK_TEXELS), "a part of a brick is missing")?;
        ensure(self.texels.len() <= MAX_BRICK_TEXELS, "it is too large")?;
        let with_entries = (first - entries) / 2;
        let is_place = |place: &u32| *place >= INSIDE || (*place as usize) < with_entries;
        ensure(self.texels[..entries].iter().flatten().all(is_place), "a cell's entries are nowhere")?;
        let count = self.count();
        let is_entry = |entry: &u32| entry >> 31 == 0 || ((entry & 0xff_ffff) as usize) < count;
        ensure(self.texels[entries..first].iter().flatten().all(is_entry), "a brick is nowhere")?;

        self.looks.as_ref().map_or(Ok(()), |looks| looks.check(count))
    }
}

fn checksum(bytes: &[u8]) -> ContentKey {
    let mut hash = ContentHash::default();
    hash.bytes(bytes);
    hash.key()
}

/// Reads numbers; the length was checked before.
struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Words<'_> {
    fn next<const N: usize>(&mut self) -> [u8; N] {
        let mut out = [0; N];
        let there = self.bytes.get(self.at..self.at + N).unwrap_or(&[0; N]);
        out.copy_from_slice(there);
        self.at += N;
        out
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.next())
    }

    fn long(&mut self) -> u64 {
        u64::from_le_bytes(self.next())
    }

    fn number(&mut self) -> f64 {
        f64::from_le_bytes(self.next())
    }
}

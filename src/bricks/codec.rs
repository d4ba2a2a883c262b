//! Bricks as bytes. Nothing of them is trusted: what is read back is complete, undamaged, of the expected contents, and
//! names no texel that is not there.

use std::sync::Arc;

use glam::DVec3;
use isolith_geometry::Aabb;

use super::{
    BRICK_COARSER, BRICK_INSIDE, BRICK_TEXELS, BrickGrid, Bricks, COARSER, ContentHash, ContentKey, HAS_SAMPLES,
    INSIDE, LEVEL_RATIO, Looks, MAX_BRICK_TEXELS, MAX_LEVELS,
};

/// The first bytes of a file of bricks.
pub const CODEC_MAGIC: [u8; 8] = *b"isobrick";
/// The version of the layout.
const VERSION: u32 = 3;
/// Bytes before the levels: the first bytes, the version, the number of levels, the number of bytes, the key.
const HEADER: usize = 8 + 4 + 4 + 8 + 16;
/// Bytes of a level before its texels.
const LEVEL_HEADER: usize = 8 * 10 + 5 * 4 + 3 * 8;
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

/// Bricks of the contents with this key, and all coarser ones, as bytes.
pub fn to_bytes(bricks: &Bricks, key: ContentKey) -> Vec<u8> {
    let levels = || std::iter::successors(Some(bricks), |level| level.coarser.as_deref());
    let length = HEADER + CHECKSUM + levels().map(level_bytes).sum::<usize>();
    let mut out = Vec::with_capacity(length);
    out.extend(CODEC_MAGIC);
    out.extend(VERSION.to_le_bytes());
    out.extend((levels().count() as u32).to_le_bytes());
    out.extend((length as u64).to_le_bytes());
    out.extend(key.0.iter().flat_map(|word| word.to_le_bytes()));
    levels().for_each(|level| write_level(level, &mut out));
    let sum = checksum(&out);
    out.extend(sum.0.iter().flat_map(|word| word.to_le_bytes()));
    out
}

fn looks_of(level: &Bricks) -> &[[u32; 4]] {
    level.looks.as_ref().map_or(&[], |looks| &looks.texels)
}

fn level_bytes(level: &Bricks) -> usize {
    LEVEL_HEADER + 16 * (level.texels.len() + looks_of(level).len())
}

fn write_level(level: &Bricks, out: &mut Vec<u8>) {
    let Bricks { grid, bounds, .. } = level;
    let looks = looks_of(level);
    let points = [grid.origin, bounds.min, bounds.max].into_iter().flat_map(|p| p.to_array());
    out.extend(points.chain([grid.voxel]).flat_map(f64::to_le_bytes));
    let words = grid.cells.into_iter().chain([level.first_brick, u32::from(level.looks.is_some())]);
    out.extend(words.flat_map(u32::to_le_bytes));
    let first_look = level.looks.as_ref().map_or(0, |looks| looks.first_look as usize);
    out.extend([level.texels.len(), looks.len(), first_look].iter().flat_map(|n| (*n as u64).to_le_bytes()));
    out.extend(level.texels.iter().chain(looks).flatten().flat_map(|word| word.to_le_bytes()));
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
    let levels = read.word();
    let expected = read.long().min(1 << 40) as usize;
    if bytes.len() != expected {
        return Err(CodecError::Length { found: bytes.len(), expected });
    }
    let own_key = ContentKey([read.long(), read.long()]);
    let (content, sum) = bytes.split_at(bytes.len() - CHECKSUM);
    let mut stored = Words { bytes: sum, at: 0 };
    if checksum(content) != ContentKey([stored.long(), stored.long()]) {
        return Err(CodecError::Damaged);
    }
    if own_key != key {
        return Err(CodecError::Stale);
    }
    let mut read = Words { bytes: content, at: read.at };
    let all = (0..levels.min(MAX_LEVELS as u32 + 1)).map(|_| read_level(&mut read));
    let all: Vec<Bricks> = all.collect::<Result<_, _>>().map_err(CodecError::Inconsistent)?;
    if levels as usize != all.len() || read.at != content.len() {
        return Err(CodecError::Inconsistent("something follows its levels"));
    }
    let bricks = all
        .into_iter()
        .rev()
        .fold(None, |coarser: Option<Bricks>, level| Some(Bricks { coarser: coarser.map(Arc::new), ..level }));
    let bricks = bricks.ok_or(CodecError::Inconsistent("it has no levels"))?;
    bricks.check().map_err(CodecError::Inconsistent)?;
    Ok(bricks)
}

fn read_level(read: &mut Words<'_>) -> Result<Bricks, &'static str> {
    const CUT: &str = "a level is cut off";
    if read.left() < LEVEL_HEADER {
        return Err(CUT);
    }
    let [origin, min, max] = [0; 3].map(|_| DVec3::new(read.number(), read.number(), read.number()));
    let voxel = read.number();
    let [x, y, z, first_brick, has_looks] = [0; 5].map(|_| read.word());
    let [texels, looks, first_look] = [0; 3].map(|_| read.long());
    if texels.saturating_add(looks) > (read.left() / 16) as u64 {
        return Err(CUT);
    }
    let mut texel = || [0; 4].map(|_| read.word());
    let all: Vec<[u32; 4]> = (0..texels).map(|_| texel()).collect();
    let looks = Looks { texels: (0..looks).map(|_| texel()).collect(), first_look: first_look as u32 };
    Ok(Bricks {
        grid: BrickGrid { origin, voxel, cells: [x, y, z] },
        bounds: Aabb::new(min, max),
        first_brick,
        texels: all,
        looks: (has_looks == 1).then_some(looks),
        coarser: None,
    })
}

impl Bricks {
    /// Checks of all levels that every number is finite and every place within the texels, so that nobody reads outside of
    /// them.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(&self) -> Result<(), &'static str> {
        let mut levels = 0;
        let mut next = Some(self);
        while let Some(level) = next {
            level.check_own()?;
            next = level.coarser.as_deref();
            if next.is_some_and(|next| next.voxel() != LEVEL_RATIO * level.voxel()) {
                return Err("its levels are not twice as coarse each");
            }
            levels += 1;
        }
        if levels > MAX_LEVELS { Err("it has too many levels") } else { Ok(()) }
    }

    fn check_own(&self) -> Result<(), &'static str> {
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
        let has_coarser = self.coarser.is_some();
        let is_place =
            |place: &u32| *place >= INSIDE || (*place == COARSER && has_coarser) || (*place as usize) < with_entries;
        ensure(self.texels[..entries].iter().flatten().all(is_place), "a cell's entries are nowhere")?;
        let count = self.count();
        let is_entry = |entry: &u32| match *entry {
            0 | BRICK_INSIDE => true,
            BRICK_COARSER => has_coarser,
            entry => entry & HAS_SAMPLES != 0 && ((entry & 0xff_ffff) as usize) < count,
        };
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
    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

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

//! Builds small TrueType fonts in code.

/// The font's height in font units.
pub const EM: u16 = 1_000;

/// A glyph of rectangles, each given by two corners.
pub fn rectangles(parts: &[[i16; 4]]) -> Vec<u8> {
    let points: Vec<[i16; 2]> =
        parts.iter().flat_map(|[x0, y0, x1, y1]| [[*x0, *y0], [*x0, *y1], [*x1, *y1], [*x1, *y0]]).collect();
    polygons(&points, 4)
}

/// A glyph of straight lines; each closed curve has `each` points.
pub fn polygons(points: &[[i16; 2]], each: usize) -> Vec<u8> {
    let contours = points.len() / each;
    let mut out = words(&[contours as i16]);
    out.extend(words(&bounds(points)));
    for i in 1..=contours {
        out.extend(((i * each - 1) as u16).to_be_bytes());
    }
    out.extend([0, 0]);
    out.extend(vec![1; points.len()]);
    for axis in 0..2 {
        let mut last = 0;
        for point in points {
            out.extend((point[axis] - last).to_be_bytes());
            last = point[axis];
        }
    }
    out
}

/// A glyph composed of other glyphs, all at the same place.
pub fn composite(parts: &[u16]) -> Vec<u8> {
    let mut out = words(&[-1, 0, 0, 10, 10]);
    for (i, part) in parts.iter().enumerate() {
        // Flags: offsets are words; more parts follow.
        let more = if i + 1 < parts.len() { 0x20 } else { 0 };
        out.extend((0x0003_u16 | more).to_be_bytes());
        out.extend(part.to_be_bytes());
        out.extend([0; 4]);
    }
    out
}

fn bounds(points: &[[i16; 2]]) -> [i16; 4] {
    let least = |axis: usize| points.iter().map(|p| p[axis]).min().unwrap_or(0);
    let most = |axis: usize| points.iter().map(|p| p[axis]).max().unwrap_or(0);
    [least(0), least(1), most(0), most(1)]
}

fn words(numbers: &[i16]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

/// A font under construction.
#[derive(Default)]
pub struct Font {
    /// Glyph data as in the file; the first glyph is for missing letters.
    pub glyphs: Vec<Vec<u8>>,
    /// Advance width and left side bearing of each glyph.
    pub widths: Vec<(u16, i16)>,
    /// First and last letter, and the glyph of the first; in ascending order.
    pub letters: Vec<(u32, u32, u32)>,
    /// Further tables.
    pub tables: Vec<([u8; 4], Vec<u8>)>,
}

impl Font {
    /// A font with a box for missing letters.
    pub fn new() -> Self {
        Self::default().glyph(rectangles(&[[0, 0, 500, 700]]), 600)
    }

    /// Adds a glyph of this width.
    pub fn glyph(mut self, glyph: Vec<u8>, width: u16) -> Self {
        let ink = if glyph.len() > 4 { i16::from_be_bytes([glyph[2], glyph[3]]) } else { 0 };
        self.glyphs.push(glyph);
        self.widths.push((width, ink));
        self
    }

    /// Maps a letter to this glyph.
    pub fn letter(mut self, letter: char, glyph: u32) -> Self {
        self.letters.push((letter.into(), letter.into(), glyph));
        self
    }

    /// Adds a table.
    pub fn table(mut self, tag: &[u8; 4], table: Vec<u8>) -> Self {
        self.tables.push((*tag, table));
        self
    }

    /// The bytes of the font file.
    pub fn file(&self) -> Vec<u8> {
        let count = self.glyphs.len() as u16;
        let mut glyf = Vec::new();
        let mut loca = vec![0_u32];
        for glyph in &self.glyphs {
            glyf.extend(glyph);
            glyf.resize(glyf.len().next_multiple_of(4), 0);
            loca.push(glyf.len() as u32);
        }
        let mut head = vec![0; 54];
        head[1] = 1;
        head[12..16].copy_from_slice(&0x5f0f_3cf5_u32.to_be_bytes());
        head[18..20].copy_from_slice(&EM.to_be_bytes());
        // Glyph offsets take 4 bytes.
        head[51] = 1;
        let mut hhea = vec![0; 36];
        hhea[1] = 1;
        hhea[4..8].copy_from_slice(&[3, 32, 255, 56]);
        hhea[34..36].copy_from_slice(&count.to_be_bytes());
        let mut maxp = vec![0; 32];
        maxp[1] = 1;
        maxp[4..6].copy_from_slice(&count.to_be_bytes());
        let mut tables = vec![
            (*b"cmap", self.cmap()),
            (*b"glyf", glyf),
            (*b"head", head),
            (*b"hhea", hhea),
            (*b"hmtx", self.widths.iter().flat_map(|(w, l)| [w.to_be_bytes(), l.to_be_bytes()].concat()).collect()),
            (*b"loca", loca.iter().flat_map(|at| at.to_be_bytes()).collect()),
            (*b"maxp", maxp),
        ];
        tables.extend(self.tables.iter().cloned());
        tables.sort();
        assembled(&tables)
    }

    /// The letter map, as groups in the format for all of Unicode.
    fn cmap(&self) -> Vec<u8> {
        let mut out: Vec<u8> = [0_u16, 1, 3, 10, 0, 12, 12, 0].iter().flat_map(|n| n.to_be_bytes()).collect();
        let count = self.letters.len() as u32;
        out.extend([16 + 12 * count, 0, count].iter().flat_map(|n| n.to_be_bytes()));
        for (first, last, glyph) in &self.letters {
            out.extend([*first, *last, *glyph].iter().flat_map(|n| n.to_be_bytes()));
        }
        out
    }
}

fn assembled(tables: &[([u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut out = vec![0, 1, 0, 0, 0, tables.len() as u8, 0, 0, 0, 0, 0, 0];
    let mut at = (12 + 16 * tables.len()) as u32;
    for (tag, table) in tables {
        out.extend(tag);
        out.extend([0, at, table.len() as u32].iter().flat_map(|n| n.to_be_bytes()));
        at += (table.len() as u32).next_multiple_of(4);
    }
    for (_, table) in tables {
        out.extend(table);
        out.resize(out.len().next_multiple_of(4), 0);
    }
    out
}

/// A substitution table for the Arabic script: each feature replaces glyph 1 by another one.
pub fn arabic_forms(forms: &[(&[u8; 4], u16)]) -> Vec<u8> {
    let count = forms.len() as u16;
    let [scripts, features] = [10_u16, 10 + 2 + 6 + 4 + 6 + 2 * count];
    let lookups = features + 2 + 6 * count + 6 * count;
    let mut out: Vec<u16> = vec![1, 0, scripts, features, lookups];
    // One script with one language that has all features.
    out.extend([1, 0x6172, 0x6162, 8, 4, 0, 0, 0xffff, count]);
    out.extend(0..count);
    out.push(count);
    for (i, (tag, _)) in forms.iter().enumerate() {
        let at = 2 + 6 * count + 6 * i as u16;
        out.extend([u16::from_be_bytes([tag[0], tag[1]]), u16::from_be_bytes([tag[2], tag[3]]), at]);
    }
    for i in 0..count {
        out.extend([0, 1, i]);
    }
    out.push(count);
    out.extend((0..count).map(|i| 2 + 2 * count + 22 * i));
    for (_, glyph) in forms {
        // A lookup with one part: single substitution of glyph 1.
        out.extend([1, 0, 1, 8, 2, 8, 1, *glyph, 1, 1, 1]);
    }
    out.iter().flat_map(|word| word.to_be_bytes()).collect()
}

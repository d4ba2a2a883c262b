//! A closed grid of points as a glTF file with one strip of triangles, in few bytes: positions in 16 bits, normals in 8.

use glam::DVec3;

/// A grid of points around an axis; the first and the last row each close at a point.
#[derive(Clone, Debug)]
pub(super) struct Sculpture {
    pub(super) name: &'static str,
    /// Points of a row.
    pub(super) around: usize,
    /// Row after row from the bottom, counter-clockwise from above.
    pub(super) points: Vec<DVec3>,
    /// The material: linear color, metalness, roughness.
    pub(super) look: ([f64; 3], f64, f64),
}

/// Steps of a position from the middle to the border, and of a normal.
const STEPS: [f64; 2] = [32_767.0, 127.0];

impl Sculpture {
    fn rows(&self) -> usize {
        self.points.len() / self.around
    }

    fn at(&self, row: usize, column: usize) -> DVec3 {
        self.points[row * self.around + column % self.around]
    }

    /// The outward normal, by the neighbors.
    fn normal(&self, row: usize, column: usize) -> DVec3 {
        let (below, above) = (row.saturating_sub(1), (row + 1).min(self.rows() - 1));
        let up = self.at(above, column) - self.at(below, column);
        let along = self.at(row, column + 1) - self.at(row, column + self.around - 1);
        let at_end = if row == 0 { DVec3::NEG_Y } else { DVec3::Y };
        // At its ends a row is a point.
        if row == 0 || row + 1 == self.rows() { at_end } else { along.cross(up).try_normalize().unwrap_or(at_end) }
    }

    /// The triangles between all rows as one strip. Each row starts and ends with triangles without area.
    fn strip(&self) -> Vec<u16> {
        let mut out = Vec::new();
        for row in 0..self.rows() - 1 {
            let pairs = (0..=self.around).map(|column| column % self.around);
            let own: Vec<usize> =
                pairs.flat_map(|column| [(row + 1) * self.around + column, row * self.around + column]).collect();
            if row > 0 {
                out.extend([out[out.len() - 1], own[0] as u16]);
            }
            out.extend(own.iter().map(|index| *index as u16));
        }
        out
    }

    /// The triangles of the strip, those without area too.
    #[cfg(test)]
    pub(super) fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let strip = self.strip();
        (0..strip.len() - 2).map(move |i| {
            let [a, b, c] = [strip[i], strip[i + 1], strip[i + 2]].map(|index| self.points[usize::from(index)]);
            if i % 2 == 0 { [a, b, c] } else { [b, a, c] }
        })
    }

    /// The bytes of a .glb file.
    pub fn file(&self) -> Vec<u8> {
        let least = self.points.iter().fold(DVec3::INFINITY, |a, b| a.min(*b));
        let most = self.points.iter().fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
        let (middle, half) = (0.5 * (least + most), (0.5 * (most - least)).max_element());
        let step = |v: f64, steps: f64| (v.clamp(-1.0, 1.0) * steps).round() as i16;
        let whole: Vec<[i16; 3]> =
            self.points.iter().map(|p| ((*p - middle) / half).to_array().map(|v| step(v, STEPS[0]))).collect();
        let mut bytes: Vec<u8> =
            whole.iter().flat_map(|[x, y, z]| [*x, *y, *z, 0]).flat_map(i16::to_le_bytes).collect();
        let count = self.points.len();
        let normals = (0..count).map(|i| self.normal(i / self.around, i % self.around));
        let normals = normals.flat_map(|n| {
            let [x, y, z] = n.to_array().map(|v| step(v, STEPS[1]) as i8);
            [x, y, z, 0].map(|v| v as u8)
        });
        bytes.extend(normals);
        let strip = self.strip();
        bytes.extend(strip.iter().flat_map(|index| index.to_le_bytes()));
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let edge = |fold: fn(i16, i16) -> i16| {
            let numbers = [0, 1, 2].map(|i| whole.iter().map(|p| p[i]).reduce(fold).unwrap_or(0));
            numbers.map(|v| v.to_string()).join(",")
        };
        let json = self.json(count, strip.len(), bytes.len(), [edge(i16::min), edge(i16::max)], (middle, half));
        container(json.as_bytes(), &bytes)
    }

    fn json(
        &self,
        count: usize,
        strip: usize,
        bytes: usize,
        [least, most]: [String; 2],
        (middle, half): (DVec3, f64),
    ) -> String {
        let Self { name, look: ([r, g, b], metalness, roughness), .. } = self;
        let [positions, normals] = [8 * count, 4 * count];
        let place = middle.to_array().map(|v| v.to_string()).join(",");
        let parts = [
            r#"{"asset":{"version":"2.0","generator":"Isolith"},"extensionsUsed":["KHR_mesh_quantization"],"#.to_owned(),
            r#""extensionsRequired":["KHR_mesh_quantization"],"scene":0,"scenes":[{"nodes":[0]}],"#.to_owned(),
            format!(r#""nodes":[{{"name":"{name}","mesh":0,"translation":[{place}],"scale":[{half},{half},{half}]}}],"#),
            r#""meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"mode":5,"material":0}]}],"#
                .to_owned(),
            format!(r#""materials":[{{"name":"{name}","pbrMetallicRoughness":{{"baseColorFactor":[{r},{g},{b},1],"#),
            format!(r#""metallicFactor":{metalness},"roughnessFactor":{roughness}}}}}],"#),
            r#""accessors":[{"bufferView":0,"componentType":5122,"normalized":true,"type":"VEC3","#.to_owned(),
            format!(r#""count":{count},"min":[{least}],"max":[{most}]}},"#),
            format!(r#"{{"bufferView":1,"componentType":5120,"normalized":true,"type":"VEC3","count":{count}}},"#),
            format!(r#"{{"bufferView":2,"componentType":5123,"type":"SCALAR","count":{strip}}}],"#),
            format!(r#""bufferViews":[{{"buffer":0,"byteLength":{positions},"byteStride":8,"target":34962}},"#),
            format!(r#"{{"buffer":0,"byteOffset":{positions},"byteLength":{normals},"byteStride":4,"target":34962}},"#),
            format!(r#"{{"buffer":0,"byteOffset":{},"byteLength":{},"#, positions + normals, 2 * strip),
            format!(r#""target":34963}}],"buffers":[{{"byteLength":{bytes}}}]}}"#),
        ];
        parts.concat()
    }
}

/// The two chunks of a .glb file.
fn container(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let mut json = json.to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut out = Vec::with_capacity(28 + json.len() + binary.len());
    out.extend(b"glTF");
    out.extend([2_u32, (28 + json.len() + binary.len()) as u32].iter().flat_map(|n| n.to_le_bytes()));
    for (chunk, kind) in [(&json[..], b"JSON"), (binary, b"BIN\0")] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    out
}

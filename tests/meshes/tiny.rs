//! Small glTF files made by hand.

use serde_json::{Value, json};

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const FLOAT: u32 = 5126;

/// A glTF file under construction: one buffer, one view per accessor.
pub struct Tiny {
    pub bytes: Vec<u8>,
    pub json: Value,
}

impl Tiny {
    pub fn new() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        });
        Self { bytes: Vec::new(), json }
    }

    /// Appends bytes as a separate view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        while !self.bytes.len().is_multiple_of(4) {
            self.bytes.push(0);
        }
        let view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend_from_slice(bytes);
        push(&mut self.json["bufferViews"], view)
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessor = json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        push(&mut self.json["accessors"], accessor)
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let index = self.accessor(&bytes, FLOAT, ["", "SCALAR", "VEC2", "VEC3", "VEC4"][N], values.len());
        if N == 3 {
            let edge = |fold: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).map(|c| values.iter().map(|v| v[c]).reduce(fold).unwrap_or(0.0)).collect()
            };
            self.json["accessors"][index]["min"] = json!(edge(f32::min));
            self.json["accessors"][index]["max"] = json!(edge(f32::max));
        }
        index
    }

    pub fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(&bytes, U16, "SCALAR", values.len())
    }

    /// Adds a mesh with one primitive.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        push(&mut self.json["meshes"], json!({ "primitives": [primitive] }))
    }

    /// The bytes of a .gltf file with an embedded buffer.
    pub fn gltf(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        if json["buffers"] == json!([]) {
            let uri = format!("data:application/octet-stream;base64,{}", base64(&self.bytes));
            json["buffers"] = json!([{ "byteLength": self.bytes.len(), "uri": uri }]);
        }
        serde_json::to_vec(&json).unwrap()
    }

    /// The bytes of a .glb file.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        container(&serde_json::to_vec(&json).unwrap(), &self.bytes)
    }
}

/// A unit right triangle in the XY plane, with indices, facing +Z.
pub fn triangle() -> Tiny {
    let mut tiny = Tiny::new();
    let positions = tiny.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let indices = tiny.indices(&[0, 1, 2]);
    tiny.mesh(json!({ "attributes": { "POSITION": positions }, "indices": indices }));
    tiny
}

/// A quad with all features of the reader: normals, colors, a texture, a sparse accessor, a second mesh as a strip, a
/// tree of nodes.
pub fn everything() -> Tiny {
    let mut tiny = Tiny::new();
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let positions = tiny.floats(&corners);
    let normals = tiny.floats(&[[0.0, 0.0, 1.0]; 4]);
    let uvs = tiny.floats(&[[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]]);
    let colors = tiny.accessor(&[255, 128, 0, 255].repeat(4), U8, "VEC4", 4);
    tiny.json["accessors"][colors]["normalized"] = json!(true);
    let indices = tiny.indices(&[0, 1, 2, 2, 1, 3]);
    let sparse = tiny.floats(&corners);
    let (targets, values) = (tiny.view(&[3, 0, 0, 0]), tiny.view(&[2.0_f32, 2.0, 0.5].map(f32::to_le_bytes).concat()));
    tiny.json["accessors"][sparse]["sparse"] = json!({
        "count": 1,
        "indices": { "bufferView": targets, "componentType": U8 },
        "values": { "bufferView": values },
    });
    let image = tiny.view(&png(2, 2));
    tiny.json["images"] = json!([{ "bufferView": image, "mimeType": "image/png" }]);
    tiny.json["textures"] = json!([{ "source": 0 }]);
    let pbr = json!({ "baseColorFactor": [0.5, 1.0, 1.0, 1.0], "baseColorTexture": { "index": 0 } });
    tiny.json["materials"] = json!([{ "pbrMetallicRoughness": pbr }]);
    let attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colors });
    tiny.mesh(json!({ "attributes": attributes, "indices": indices, "material": 0 }));
    tiny.mesh(json!({ "attributes": { "POSITION": sparse }, "mode": 5 }));
    tiny.json["nodes"] = json!([
        { "mesh": 0, "children": [1], "translation": [0.0, 0.0, 1.0] },
        { "mesh": 1, "scale": [1.0, 2.0, 1.0] },
    ]);
    tiny
}

/// The same with a skin, morph targets, a sampler, a transformed masked texture, and features that are not drawn.
pub fn posed() -> Tiny {
    let mut tiny = everything();
    let joints = tiny.accessor(&[0, 1, 0, 0].repeat(4), U8, "VEC4", 4);
    let weights = tiny.floats(&[[0.5, 0.5, 0.0, 0.0]; 4]);
    let matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let bytes: Vec<u8> = [matrix; 2].iter().flatten().flat_map(|v: &f32| v.to_le_bytes()).collect();
    let inverse = tiny.accessor(&bytes, FLOAT, "MAT4", 2);
    let [moved, turned] = [[1.0, 0.0, 0.0], [0.1, 0.0, 0.0]].map(|offset| tiny.floats(&[offset; 4]));
    let primitive = &mut tiny.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    primitive["targets"] = json!([{ "POSITION": moved, "NORMAL": turned }, { "POSITION": moved }]);
    tiny.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    tiny.json["nodes"][0]["skin"] = json!(0);
    let nodes = tiny.json["nodes"].as_array_mut().unwrap();
    nodes.extend([json!({ "translation": [1, 2, 3] }), json!({ "scale": [2, 1, 1] })]);
    tiny.json["skins"] = json!([{ "joints": [2, 3], "inverseBindMatrices": inverse }]);
    tiny.json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }]);
    tiny.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    tiny.json["materials"][0]["alphaMode"] = json!("MASK");
    tiny.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "offset": [0.5, 0.25], "rotation": 0.5, "scale": [2, 3] } });
    tiny.json["animations"] = json!([{}]);
    tiny.json["extensionsUsed"] = json!(["KHR_texture_transform", "KHR_materials_unlit"]);
    tiny
}

/// A PNG of this size.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    of_color([width, height], [200, 100, 50, 255])
}

/// A PNG of one color.
pub fn of_color([width, height]: [u32; 2], color: [u8; 4]) -> Vec<u8> {
    let mut out = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(width, height, image::Rgba(color))
        .write_to(&mut out, image::ImageFormat::Png)
        .unwrap();
    out.into_inner()
}

pub fn container(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let chunk = |kind: &[u8; 4], bytes: &[u8], fill: u8| {
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(4), fill);
        [&(padded.len() as u32).to_le_bytes()[..], kind, &padded].concat()
    };
    let body = [chunk(b"JSON", json, b' '), chunk(b"BIN\0", binary, 0)].concat();
    let length = (12 + body.len()) as u32;
    [&b"glTF"[..], &2_u32.to_le_bytes(), &length.to_le_bytes(), &body].concat()
}

pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().chain([&0, &0]).take(3).fold(0_u32, |w, b| w << 8 | u32::from(*b));
        for i in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * i) & 63) as usize];
            out.push(if i <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    out
}

pub fn push(list: &mut Value, entry: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(entry);
    list.len() - 1
}

/// SplitMix64 (Steele, Lea and Flood, 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

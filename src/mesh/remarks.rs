//! Remarks: contents of a file that are not drawn, or drawn differently. Each is listed once.

use std::collections::BTreeMap;

use super::document::SUPPORTED;
use super::error::{LONGEST_TEXT, name, shown};
use super::forest::shown_scene;
use super::limits::MAX_WARNINGS;
use super::material_schema::{GltfMaterial, MaterialExtensions};
use super::schema::Root;

/// Extensions without visible effect, or with plain data as a fallback.
const WITHOUT_EFFECT: &[&str] = &[
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_meshopt_compression",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// Collects the remarks about one file.
#[derive(Debug, Default)]
pub(super) struct Remarks {
    texts: Vec<String>,
    /// Number of remarks dropped.
    omitted: usize,
    /// Materials with features that are not drawn: for each feature, titles by material index.
    materials: BTreeMap<&'static str, BTreeMap<usize, String>>,
    points_and_lines: usize,
}

impl Remarks {
    /// The remarks about the document as a whole.
    pub fn of(root: &Root) -> Self {
        let mut remarks = Self::default();
        for extension in &root.extensions_used {
            if let Some(effect) = effect(extension) {
                remarks.add(format!("{}: {effect}", name(extension)));
            }
        }
        let count = |n: usize, word: &str| if n == 1 { format!("1 {word}") } else { format!("{n} {word}s") };
        if !root.cameras.is_empty() {
            remarks.add(format!("{} not used", count(root.cameras.len(), "camera")));
        }
        if root.scenes.len() > 1 {
            let shown = shown_scene(root);
            let title = root.scenes.get(shown).and_then(|scene| scene.name.as_deref());
            let title = title.map_or(String::new(), |title| format!(" “{}”", name(title)));
            remarks.add(format!("of its {} scenes only scenes[{shown}]{title} is drawn", root.scenes.len()));
        }
        remarks
    }

    /// Adds a remark, unless it exists already.
    pub fn add(&mut self, text: String) {
        if self.texts.contains(&text) {
            return;
        }
        if self.texts.len() < 2 * MAX_WARNINGS { self.texts.push(text) } else { self.omitted += 1 }
    }

    /// Counts a primitive that has no surface.
    pub fn points_or_lines(&mut self) {
        self.points_and_lines += 1;
    }

    /// Adds the features of a used material that are not drawn.
    pub fn material(&mut self, index: usize, material: &GltfMaterial) {
        let MaterialExtensions { specular_glossiness, specular, clearcoat, .. } = &material.extensions;
        let older = specular_glossiness.as_ref();
        let specular = specular.as_ref();
        let coat = clearcoat.as_ref();
        let is_bright = |color: &[f64; 3]| color.iter().any(|channel| *channel > 1.0);
        let bright = specular.and_then(|s| s.specular_color_factor.as_ref()).is_some_and(is_bright);
        let things = [
            (bright, "specular colors above 1 of KHR_materials_specular"),
            (older.is_some_and(|o| o.specular_glossiness_texture.is_some()), "specular-glossiness textures"),
            (specular.is_some_and(|s| s.specular_texture.is_some()), "textures of KHR_materials_specular"),
            (specular.is_some_and(|s| s.specular_color_texture.is_some()), "textures of KHR_materials_specular"),
            (coat.is_some_and(|c| c.clearcoat_texture.is_some()), "textures of KHR_materials_clearcoat"),
            (coat.is_some_and(|c| c.clearcoat_roughness_texture.is_some()), "textures of KHR_materials_clearcoat"),
            (coat.is_some_and(|c| c.clearcoat_normal_texture.is_some()), "textures of KHR_materials_clearcoat"),
        ];
        for (has, what) in things {
            if has {
                let title = || material.name.as_deref().map_or(String::new(), |title| format!(" “{}”", name(title)));
                let users = self.materials.entry(what).or_default();
                users.entry(index).or_insert_with(|| format!("materials[{index}]{}", title()));
            }
        }
    }

    /// The remarks as texts, bounded in number and length.
    pub fn finish(mut self) -> Vec<String> {
        const NAMED: usize = 3;
        if self.points_and_lines > 0 {
            let count = self.points_and_lines;
            self.add(format!("{count} primitives made of points or lines not drawn"));
        }
        for (what, users) in std::mem::take(&mut self.materials) {
            let named: Vec<&str> = users.values().take(NAMED).map(String::as_str).collect();
            let more = users.len() - named.len();
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            self.add(format!("{what} not drawn: {}{more}", named.join(", ")));
        }
        let mut texts = self.texts;
        if texts.len() > MAX_WARNINGS {
            let more = texts.len() + 1 - MAX_WARNINGS + self.omitted;
            texts.truncate(MAX_WARNINGS - 1);
            texts.push(format!("{more} more things are not drawn"));
        }
        texts.iter().map(|text| shown(text, LONGEST_TEXT)).collect()
    }
}

/// The effect on the picture if an extension is not supported; `None` for no effect.
fn effect(extension: &str) -> Option<&'static str> {
    Some(match extension {
        "KHR_materials_pbrSpecularGlossiness" => "only its diffuse color and glossiness factor are drawn",
        "KHR_lights_punctual" => "the lights of the file are not used",
        "KHR_materials_variants" => "only the first variant is drawn",
        "EXT_mesh_gpu_instancing" => "not supported: each instanced mesh is drawn once",
        "CESIUM_RTC" => "not supported: the model stands without its offset",
        known if SUPPORTED.contains(&known) || WITHOUT_EFFECT.contains(&known) => return None,
        _ => "not supported, drawn without",
    })
}

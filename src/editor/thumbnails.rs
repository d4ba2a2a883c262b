//! Thumbnails of materials: rendered by jobs beside the frames, and kept until the material changes.

use std::collections::HashMap;

use egui::{Color32, ColorImage, Context, Rect, TextureHandle, TextureOptions, Ui, pos2, vec2};

use super::theme;
use isolith_field::FlatMaterial;
use isolith_field::light::material_ball::material_ball;
use isolith_jobs::{Job, JobEnd, Jobs, Task};
use isolith_scene::{Material, MaterialId};

/// Width and height of a thumbnail in pixels.
const SIDE: usize = 96;
/// Most thumbnails of one job: a frame shows what is ready, so several short jobs look faster than a long one.
const MOST_OF_A_JOB: usize = 4;

/// What a thumbnail shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ThumbnailKey {
    /// A material of the scene.
    OfScene(MaterialId),
    /// A preset, by its place in the list.
    OfPreset(usize),
}

struct Thumbnail {
    /// The material as it was rendered.
    of: Material,
    texture: TextureHandle,
}

/// A rendered thumbnail.
struct Rendered {
    key: ThumbnailKey,
    of: Material,
    image: ColorImage,
}

/// The thumbnails so far, and the job that renders more.
#[derive(Default)]
pub struct Thumbnails {
    ready: HashMap<ThumbnailKey, Thumbnail>,
    /// Shown in this frame, but missing or out of date.
    wanted: Vec<(ThumbnailKey, Material)>,
    job: Option<Job<Vec<Rendered>>>,
}

impl Thumbnails {
    /// Paints the thumbnail of a material, or a patch of its color until there is one. While the material changes, the
    /// last one stays.
    pub fn paint(&mut self, ui: &Ui, rect: Rect, key: ThumbnailKey, material: &Material) {
        let ready = self.ready.get(&key);
        if ready.is_none_or(|ready| !looks_alike(&ready.of, material)) && !self.wanted.iter().any(|(of, _)| *of == key)
        {
            self.wanted.push((key, material.clone()));
        }
        let radius = (rect.width() * 0.12).clamp(3.0, 7.0);
        match ready {
            Some(Thumbnail { texture, .. }) => {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                let shape = egui::epaint::RectShape::filled(rect, radius, Color32::WHITE);
                ui.painter().add(shape.with_texture(texture.id(), whole));
            }
            None => {
                ui.painter().rect_filled(rect, radius, theme::LINE);
                let [r, g, b] = material.base_color.map(|v| v.clamp(0.0, 1.0) as f32);
                let color = egui::Rgba::from_rgb(r, g, b);
                ui.painter().circle_filled(rect.center() + vec2(0.0, rect.height() * 0.02), rect.width() * 0.36, color);
            }
        }
    }

    /// Takes what has been rendered, and starts the job for what is missing. Call once a frame, after all panels.
    pub fn update(&mut self, ctx: &Context, jobs: &Jobs) {
        if let Some(end) = self.job.as_ref().and_then(Job::poll) {
            self.job = None;
            if let JobEnd::Done(rendered) = end {
                for Rendered { key, of, image } in rendered {
                    self.keep(ctx, key, of, image);
                }
                ctx.request_repaint();
            }
        }
        let wanted: Vec<_> = self.wanted.drain(..).take(MOST_OF_A_JOB).collect();
        if self.job.is_none() && !wanted.is_empty() {
            self.job = Some(jobs.start(Task::hidden("Rendering materials"), move |task| {
                let wanted = wanted.into_iter().take_while(|_| !task.is_canceled());
                wanted.map(|(key, of)| Rendered { key, image: render(&of), of }).collect()
            }));
        }
    }

    /// Forgets the thumbnails of the scene: another document has other materials under the same ids.
    pub fn forget_scene(&mut self) {
        self.ready.retain(|key, _| matches!(key, ThumbnailKey::OfPreset(_)));
        self.wanted.clear();
        self.job = None;
    }

    fn keep(&mut self, ctx: &Context, key: ThumbnailKey, of: Material, image: ColorImage) {
        match self.ready.get_mut(&key) {
            Some(ready) => {
                ready.texture.set(image, TextureOptions::LINEAR);
                ready.of = of;
            }
            None => {
                let texture = ctx.load_texture("material", image, TextureOptions::LINEAR);
                self.ready.insert(key, Thumbnail { of, texture });
            }
        }
    }
}

/// Whether two materials differ in no more than their names.
fn looks_alike(a: &Material, b: &Material) -> bool {
    // Comparing first the cheap way, because most materials change rarely.
    a == b || *a == Material { id: a.id, name: a.name.clone(), ..b.clone() }
}

fn render(material: &Material) -> ColorImage {
    let pixels = material_ball(&FlatMaterial::new(material), SIDE);
    let pixels = pixels.into_iter().map(|[r, g, b, _]| Color32::from_rgb(r, g, b)).collect();
    ColorImage::new([SIDE, SIDE], pixels)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// Runs frames until the job is done; returns the version of the texture.
    fn shown(ctx: &Context, thumbnails: &mut Thumbnails, material: &Material) -> (egui::TextureId, Material) {
        let jobs = Jobs::default();
        let key = ThumbnailKey::OfScene(material.id);
        for _ in 0..2_000 {
            let mut output = ctx.run_ui(egui::RawInput::default(), |ui| {
                thumbnails.paint(ui, Rect::from_min_size(pos2(0.0, 0.0), vec2(40.0, 40.0)), key, material);
                thumbnails.update(ui.ctx(), &jobs);
            });
            output.textures_delta.clear();
            match thumbnails.ready.get(&key) {
                Some(ready) if looks_alike(&ready.of, material) => return (ready.texture.id(), ready.of.clone()),
                _ => std::thread::sleep(Duration::from_millis(5)),
            }
        }
        panic!("no thumbnail");
    }

    #[test]
    fn a_thumbnail_follows_its_material_and_is_made_once() {
        let (ctx, mut thumbnails) = (Context::default(), Thumbnails::default());
        let clay = Material::default();
        let (texture, of) = shown(&ctx, &mut thumbnails, &clay);
        assert_eq!(of, clay);
        let renamed = Material { name: "Other".into(), ..clay.clone() };
        assert_eq!(shown(&ctx, &mut thumbnails, &renamed), (texture, clay.clone()), "a name does not show");
        let red = Material { base_color: [0.9, 0.05, 0.05], ..clay.clone() };
        assert_eq!(shown(&ctx, &mut thumbnails, &red), (texture, red.clone()), "the same texture, other pixels");
        assert_ne!(render(&red).pixels, render(&clay).pixels);
        thumbnails.forget_scene();
        assert!(thumbnails.ready.is_empty());
    }
}

//! Isolith's renderer inside another wgpu program. That program owns the device. Isolith renders a scene into a texture
//! on it, and the program uses that texture: here it copies the texture into one of its own and reads that one back.
//!
//! `cargo run -p isolith-render --example embed -- picture.png`

use std::error::Error;
use std::time::Duration;

use glam::DVec3;
use isolith_field::{FlatScene, flatten};
use isolith_geometry::Camera;
use isolith_render::{EvalStrategy, Gpu, OverlaySettings, Renderer, Slot, device_descriptor};
use isolith_scene::{Blend, BlendKernel, Group, Light, Node, NodeKind, Object, Operator, Scene, SceneError, Shape};

/// Width and height of the picture. Rows of 256 pixels need no padding on readback.
pub const SIZE: [u32; 2] = [256, 192];

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("name the picture to write")?;
    let pixels = render_on_foreign_device()?;
    image::save_buffer(path, &pixels, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
    Ok(())
}

/// A sphere blended into a box, and a sun.
///
/// # Errors
/// Never, for these values.
pub fn scene() -> Result<Scene, SceneError> {
    let mut scene = Scene::new();
    let material = scene.materials()[0].id;
    let object = |name: &str, shape: Shape| Node::new(name, NodeKind::Object(Object { shape, material }));
    let blend = Blend::new(BlendKernel::Circular, 0.4);
    let group = scene.insert(None, 0, Node::new("Drop", NodeKind::Group(Group::new(Operator::Union, blend))))?;
    scene.insert(Some(group), 0, object("Slab", Shape::Box { size: [2.0, 0.4, 2.0], rounding: 0.1 }))?;
    scene.insert(Some(group), 1, object("Ball", Shape::Sphere { radius: 0.6 }).at(DVec3::Y * 0.7))?;
    let sun = Light { color: [1.0, 0.95, 0.85], ..Light::sun() };
    let from = Camera::looking_at(DVec3::new(2.0, 3.0, 1.0), DVec3::ZERO, 1.0).rotation;
    scene.insert(None, 1, Node::new("Sun", NodeKind::Light(sun)).rotated(from))?;
    Ok(scene)
}

/// The camera of the picture.
pub fn camera() -> Camera {
    Camera::looking_at(DVec3::new(2.5, 2.0, 3.0), DVec3::Y * 0.3, 40_f64.to_radians())
}

/// The picture, four bytes a pixel: Isolith renders it, and the program that owns the device copies it.
///
/// # Errors
/// No adapter exists, or the device reports an error.
pub fn render_on_foreign_device() -> Result<Vec<u8>, Box<dyn Error>> {
    // The program opens its own device. The renderer needs the limits of `device_descriptor`; the program may ask for
    // more.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&device_descriptor(&adapter)))?;

    // Isolith: flatten turns the scene into arrays, and the renderer draws them in several dispatches.
    let gpu = Gpu::watch(device.clone(), queue.clone(), adapter.get_info());
    let mut renderer = Renderer::new(&gpu)?;
    // A single picture does not justify compiling a pipeline for each component.
    renderer.set_strategy(EvalStrategy::Tape);
    let flat: FlatScene = flatten(&scene()?, 0.0)?;
    let mut frame = renderer.begin(Slot::Full, &flat, &[], &camera(), SIZE, OverlaySettings::default())?;
    while !frame.is_done() {
        renderer.advance(&mut frame, Duration::from_millis(10))?;
    }
    let (rendered, _) = renderer.picture(Slot::Full).ok_or("a frame that is done has a picture")?;

    // Back in the program, which uses the texture like any other.
    let extent = wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 };
    let own = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("the program's own"),
        size: extent,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let view = own.create_view(&wgpu::TextureViewDescriptor::default());
    wgpu::util::TextureBlitter::new(&device, own.format()).copy(&device, &mut encoder, rendered, &view);
    read_back(&device, &queue, encoder, &own, extent)
}

fn read_back(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    texture: &wgpu::Texture,
    extent: wgpu::Extent3d,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let row = 4 * extent.width;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size: u64::from(row * extent.height),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let target = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), target, extent);
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    device.poll(wgpu::PollType::wait_indefinitely())?;
    Ok(buffer.slice(..).get_mapped_range()?.to_vec())
}

//! Textures of meshes on the device.

use std::borrow::Cow;
use std::collections::HashMap;

use wgpu::TextureFormat;
use wgpu::util::DeviceExt as _;

use isolith_mesh::{Sampler, Texture, Wrap};

/// Uploads a texture, of colors in sRGB or of numbers.
pub(super) fn upload_texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &Texture,
    is_color: bool,
) -> wgpu::TextureView {
    let texture = fitting(texture, device.limits().max_texture_dimension_2d);
    let descriptor = wgpu::TextureDescriptor {
        label: Some("mesh texture"),
        size: wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: if is_color { TextureFormat::Rgba8UnormSrgb } else { TextureFormat::Rgba8Unorm },
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    device
        .create_texture_with_data(queue, &descriptor, order, &texture.rgba)
        .create_view(&wgpu::TextureViewDescriptor::default())
}

/// The texture, halved until it fits the device's limit.
fn fitting(texture: &Texture, longest: u32) -> Cow<'_, Texture> {
    let mut fitting = Cow::Borrowed(texture);
    while fitting.width.max(fitting.height) > longest {
        let [width, height] = [fitting.width, fitting.height].map(|side| side.div_ceil(2));
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let start = |(x, y): (u32, u32)| 4 * (2 * y as usize * fitting.width as usize + 2 * x as usize);
        let rgba = pixels.map(start).flat_map(|at| fitting.rgba[at..at + 4].iter().copied()).collect();
        fitting = Cow::Owned(Texture { width, height, rgba });
    }
    fitting
}

/// A sampler of each kind.
pub(super) fn samplers(device: &wgpu::Device) -> HashMap<Sampler, wgpu::Sampler> {
    const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp];
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let ways = WRAPS.iter().flat_map(|u| WRAPS.iter().map(move |v| [*u, *v]));
    let ways = ways.flat_map(|wrap| [false, true].map(|nearest| Sampler { wrap, nearest }));
    ways.map(|way| {
        let filter = if way.nearest { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("mesh"),
            address_mode_u: address(way.wrap[0]),
            address_mode_v: address(way.wrap[1]),
            mag_filter: filter,
            min_filter: filter,
            ..Default::default()
        });
        (way, sampler)
    })
    .collect()
}

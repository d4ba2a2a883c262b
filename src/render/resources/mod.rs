//! Resources on the device: buffers, textures, targets, layouts of bind groups, and the structs of the shaders.

pub mod accumulation;
pub mod brick_texture;
pub mod buffers;
pub mod hierarchy;
pub mod layouts;
pub mod mesh_rays;
pub mod shadows;
pub mod tape_texture;
pub mod targets;
pub mod texture_resources;
pub mod uniforms;

//! Translates WGSL to SPIR-V like wgpu 30 for a card whose driver checks bounds of buffers and images (`robustness2`).

use std::collections::BTreeMap;

use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ImageClass, Module, ShaderStage, TypeInner};
use serde::{Deserialize, Serialize};

use crate::Error;

/// The resource at a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Resource {
    /// A uniform buffer.
    Uniform,
    /// A uniform buffer with a dynamic offset.
    DynamicUniform,
    /// A storage buffer.
    Storage,
    /// A storage texture.
    StorageImage,
    /// A texture.
    SampledImage,
    /// A sampler.
    Sampler,
}

/// A shader in the form that a driver takes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SpirvStage {
    /// Name of its entry point.
    pub entry_point: String,
    /// `compute`, `vertex` or `fragment`.
    pub kind: String,
    /// The SPIR-V words.
    pub words: Vec<u32>,
}

/// A validated module.
#[derive(Debug)]
pub struct Shader {
    module: Module,
    info: ModuleInfo,
    name: String,
}

impl Shader {
    /// Parses and validates `source`; `name` is for messages.
    pub fn new(name: &str, source: &str) -> Result<Self, Error> {
        let refused = |reason: String| Error::Refused { what: name.to_owned(), reason };
        let module = naga::front::wgsl::parse_str(source).map_err(|error| refused(error.emit_to_string(source)))?;
        let capabilities = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module);
        let info = info.map_err(|error| refused(error.emit_to_string(source)))?;
        Ok(Self { module, info, name: name.to_owned() })
    }

    /// Names of the entry points of a kind.
    pub fn entry_points(&self, kind: ShaderStage) -> Vec<String> {
        let all = self.module.entry_points.iter();
        all.filter(|entry| entry.stage == kind).map(|entry| entry.name.clone()).collect()
    }

    /// Resources of the module by group and binding. The bindings in `dynamic` have dynamic offsets.
    pub fn bindings(&self, dynamic: &[[u32; 2]]) -> BTreeMap<[u32; 2], Resource> {
        let globals = self.module.global_variables.iter().map(|(_, variable)| variable);
        let bound = globals.filter_map(|variable| Some((variable.binding?, variable)));
        bound
            .map(|(at, v)| ([at.group, at.binding], self.resource(v, dynamic.contains(&[at.group, at.binding]))))
            .collect()
    }

    fn resource(&self, variable: &naga::GlobalVariable, is_dynamic: bool) -> Resource {
        match (variable.space, &self.module.types[variable.ty].inner) {
            (AddressSpace::Uniform, _) if is_dynamic => Resource::DynamicUniform,
            (AddressSpace::Uniform, _) => Resource::Uniform,
            (AddressSpace::Storage { .. }, _) => Resource::Storage,
            (_, TypeInner::Image { class: ImageClass::Storage { .. }, .. }) => Resource::StorageImage,
            (_, TypeInner::Sampler { .. }) => Resource::Sampler,
            _ => Resource::SampledImage,
        }
    }

    /// Translates one entry point to SPIR-V.
    pub fn stage(&self, entry_point: &str, kind: ShaderStage) -> Result<SpirvStage, Error> {
        let pipeline = spv::PipelineOptions { shader_stage: kind, entry_point: entry_point.to_owned() };
        let words = spv::write_vec(&self.module, &self.info, &options(&self.module), Some(&pipeline));
        let refused = |error: spv::Error| Error::Refused { what: self.name.clone(), reason: error.to_string() };
        let kind = format!("{kind:?}").to_lowercase();
        Ok(SpirvStage { entry_point: entry_point.to_owned(), kind, words: words.map_err(refused)? })
    }
}

/// The options that `wgpu-hal` 30.0.1 passes to naga in `src/vulkan/adapter.rs`, with a Vulkan 1.3 driver.
fn options(module: &Module) -> spv::Options<'static> {
    let capabilities = [
        spv::Capability::Shader,
        spv::Capability::Matrix,
        spv::Capability::Sampled1D,
        spv::Capability::Image1D,
        spv::Capability::ImageQuery,
        spv::Capability::DerivativeControl,
        spv::Capability::StorageImageExtendedFormats,
        spv::Capability::SampledCubeArray,
        spv::Capability::SampleRateShading,
        spv::Capability::DotProductInputAllKHR,
        spv::Capability::DotProductInput4x8BitKHR,
        spv::Capability::DotProductInput4x8BitPackedKHR,
        spv::Capability::DotProductKHR,
        spv::Capability::Int8,
    ];
    let bound = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    let same = |at: naga::ResourceBinding| {
        (at, spv::BindingInfo { descriptor_set: at.group, binding: at.binding, binding_array_size: None })
    };
    spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::LABEL_VARYINGS | spv::WriterFlags::FORCE_POINT_SIZE,
        fake_missing_bindings: false,
        binding_map: bound.map(same).collect(),
        capabilities: Some(capabilities.into_iter().collect()),
        bounds_check_policies: BoundsCheckPolicies {
            index: BoundsCheckPolicy::Restrict,
            buffer: BoundsCheckPolicy::Unchecked,
            image_load: BoundsCheckPolicy::Unchecked,
            binding_array: BoundsCheckPolicy::Unchecked,
        },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::Native,
        force_loop_bounding: true,
        use_storage_input_output_16: false,
        ..spv::Options::default()
    }
}

//! Compiles pipelines on the environment's device and reads the driver's statistics.

#![allow(unsafe_code, reason = "Vulkan is a C interface, and wgpu does not pass its statistics on")]

use std::ffi::CString;
use std::time::Instant;

use ash::{khr, vk};

use crate::spirv::{Resource, SpirvStage};
use crate::subjects::{Format, Pipeline};
use crate::{Error, StageMetrics, Statistics};

/// A device for compiling.
pub struct Device {
    instance: ash::Instance,
    device: ash::Device,
    executables: khr::pipeline_executable_properties::Device,
    /// Description of the card and the driver.
    pub name: String,
    // Last, because the other fields depend on it.
    _entry: ash::Entry,
}

impl Device {
    /// Opens RADV's first device.
    pub fn open() -> Result<Self, Error> {
        // SAFETY: the loader is the system's; it outlives everything created with it.
        let entry = unsafe { ash::Entry::load() }.map_err(|error| missing("the Vulkan loader", &error))?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let create = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: the structure is valid, and the instance is destroyed with the device.
        let instance = unsafe { entry.create_instance(&create, None) };
        let instance = instance.map_err(|error| missing("an instance", &error))?;
        match open_on(&instance) {
            Ok((device, name)) => {
                let executables = khr::pipeline_executable_properties::Device::new(&instance, &device);
                Ok(Self { instance, device, executables, name, _entry: entry })
            }
            Err(error) => {
                // SAFETY: nothing was created with the instance.
                unsafe { instance.destroy_instance(None) };
                Err(error)
            }
        }
    }

    /// Compiles a pipeline and returns the statistics of each stage.
    pub fn compile(&self, pipeline: &Pipeline) -> Result<Vec<Statistics>, Error> {
        let mut made =
            Made { device: &self.device, modules: Vec::new(), sets: Vec::new(), layout: None, pipeline: None };
        let refused = |reason: String| Error::Refused { what: pipeline.name.clone(), reason };
        let (handle, compile_ms) =
            made.compile(pipeline).map_err(|error| refused(format!("the driver says {error}")))?;
        statistics(&self.executables, handle, compile_ms).map_err(refused)
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: everything created with them is destroyed.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

fn missing(what: &str, error: &dyn std::fmt::Display) -> Error {
    Error::NoDriver(format!("{what}: {error}"))
}

/// A device that captures statistics, with the bounds checks that wgpu requests, and its name.
fn open_on(instance: &ash::Instance) -> Result<(ash::Device, String), Error> {
    // SAFETY: the instance is alive.
    let found = unsafe { instance.enumerate_physical_devices() }.map_err(|error| missing("a device", &error))?;
    let radv = found.into_iter().find_map(|physical| {
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: the chain is valid, and `physical` is of this instance.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        let card = properties.properties.device_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned();
        let version = driver.driver_info_as_c_str().unwrap_or_default().to_string_lossy().into_owned();
        (driver.driver_id == vk::DriverId::MESA_RADV).then(|| (physical, format!("{card}, {version}")))
    });
    let (physical, name) = radv.ok_or_else(|| Error::NoDriver("no device is of RADV".into()))?;
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
    let extensions = [khr::pipeline_executable_properties::NAME.as_ptr(), ash::ext::robustness2::NAME.as_ptr()];
    let features = vk::PhysicalDeviceFeatures::default().robust_buffer_access(true);
    let mut robustness =
        vk::PhysicalDeviceRobustness2FeaturesEXT::default().robust_buffer_access2(true).robust_image_access2(true);
    let mut executables =
        vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default().pipeline_executable_info(true);
    let mut newer = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .robust_image_access(true)
        .shader_zero_initialize_workgroup_memory(true);
    let create = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&features)
        .push_next(&mut robustness)
        .push_next(&mut executables)
        .push_next(&mut newer);
    // SAFETY: the chain is valid, and `physical` is of this instance.
    let device = unsafe { instance.create_device(physical, &create, None) };
    Ok((device.map_err(|error| missing(&name, &error))?, name))
}

/// The parts of a pipeline, destroyed together with it.
struct Made<'a> {
    device: &'a ash::Device,
    modules: Vec<vk::ShaderModule>,
    sets: Vec<vk::DescriptorSetLayout>,
    layout: Option<vk::PipelineLayout>,
    pipeline: Option<vk::Pipeline>,
}

impl Made<'_> {
    /// Compiles the pipeline; returns it and the compile time.
    fn compile(&mut self, wanted: &Pipeline) -> Result<(vk::Pipeline, f64), vk::Result> {
        let layout = self.layout(wanted)?;
        let names: Vec<CString> =
            wanted.stages.iter().map(|stage| CString::new(stage.entry_point.as_str()).unwrap_or_default()).collect();
        let mut stages = Vec::new();
        for (stage, name) in wanted.stages.iter().zip(&names) {
            let module = self.module(stage)?;
            stages
                .push(vk::PipelineShaderStageCreateInfo::default().stage(flag(&stage.kind)).module(module).name(name));
        }
        let started = Instant::now();
        let pipeline = match wanted.stages.as_slice() {
            [only] if only.kind == "compute" => self.compute(layout, stages[0])?,
            _ => self.graphics(layout, &stages, wanted)?,
        };
        let compile_ms = started.elapsed().as_secs_f64() * 1e3;
        self.pipeline = Some(pipeline);
        Ok((pipeline, compile_ms))
    }

    fn module(&mut self, stage: &SpirvStage) -> Result<vk::ShaderModule, vk::Result> {
        let create = vk::ShaderModuleCreateInfo::default().code(&stage.words);
        // SAFETY: naga generated the words from a valid module.
        let module = unsafe { self.device.create_shader_module(&create, None) }?;
        self.modules.push(module);
        Ok(module)
    }

    fn layout(&mut self, wanted: &Pipeline) -> Result<vk::PipelineLayout, vk::Result> {
        let groups = wanted.bindings.iter().map(|(at, _)| at[0] + 1).max().unwrap_or(0);
        for group in 0..groups {
            let here = wanted.bindings.iter().filter(|(at, _)| at[0] == group);
            let bindings: Vec<_> = here.map(|(at, resource)| binding(at[1], *resource)).collect();
            let create = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the bindings are valid and live until the call ends.
            self.sets.push(unsafe { self.device.create_descriptor_set_layout(&create, None) }?);
        }
        let create = vk::PipelineLayoutCreateInfo::default().set_layouts(&self.sets);
        // SAFETY: the set layouts are alive.
        let layout = unsafe { self.device.create_pipeline_layout(&create, None) }?;
        self.layout = Some(layout);
        Ok(layout)
    }

    fn compute(
        &self,
        layout: vk::PipelineLayout,
        stage: vk::PipelineShaderStageCreateInfo<'_>,
    ) -> Result<vk::Pipeline, vk::Result> {
        let create = vk::ComputePipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .layout(layout)
            .stage(stage);
        // SAFETY: layout and module are alive, and the module contains the entry point.
        let made = unsafe { self.device.create_compute_pipelines(vk::PipelineCache::null(), &[create], None) };
        made.map(|all| all[0]).map_err(|(_, error)| error)
    }

    /// A render pipeline with wgpu's state for opaque triangles.
    fn graphics(
        &self,
        layout: vk::PipelineLayout,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
        wanted: &Pipeline,
    ) -> Result<vk::Pipeline, vk::Result> {
        let (mut buffers, mut attributes) = (Vec::new(), Vec::new());
        for (at, format) in (0..).zip(&wanted.vertex_formats) {
            let buffer = vk::VertexInputBindingDescription::default().binding(at).stride(format.size());
            buffers.push(buffer.input_rate(vk::VertexInputRate::VERTEX));
            attributes.push(
                vk::VertexInputAttributeDescription::default().binding(at).location(at).format(vk_format(*format)),
            );
        }
        let input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&buffers)
            .vertex_attribute_descriptions(&attributes);
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let blends: Vec<_> = wanted
            .color_formats
            .iter()
            .map(|_| vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA))
            .collect();
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(wanted.has_depth)
            .depth_write_enable(wanted.has_depth)
            .depth_compare_op(vk::CompareOp::GREATER);
        let dynamic = vk::PipelineDynamicStateCreateInfo::default()
            .dynamic_states(&[vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR]);
        let colors: Vec<_> = wanted.color_formats.iter().map(|format| vk_format(*format)).collect();
        let depth_format = if wanted.has_depth { vk::Format::D32_SFLOAT } else { vk::Format::UNDEFINED };
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&colors)
            .depth_attachment_format(depth_format);
        let create = vk::GraphicsPipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stages(stages)
            .vertex_input_state(&input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .color_blend_state(&blend)
            .depth_stencil_state(&depth)
            .dynamic_state(&dynamic)
            .layout(layout)
            .push_next(&mut rendering);
        // SAFETY: layout and modules are alive, all states are given, and the modules contain the entry points.
        let made = unsafe { self.device.create_graphics_pipelines(vk::PipelineCache::null(), &[create], None) };
        made.map(|all| all[0]).map_err(|(_, error)| error)
    }
}

impl Drop for Made<'_> {
    fn drop(&mut self) {
        // SAFETY: all of them belong to this device, nothing else uses them, and each is destroyed once.
        unsafe {
            self.pipeline.into_iter().for_each(|pipeline| self.device.destroy_pipeline(pipeline, None));
            self.layout.into_iter().for_each(|layout| self.device.destroy_pipeline_layout(layout, None));
            self.sets.iter().for_each(|set| self.device.destroy_descriptor_set_layout(*set, None));
            self.modules.iter().for_each(|module| self.device.destroy_shader_module(*module, None));
        }
    }
}

fn binding(at: u32, resource: Resource) -> vk::DescriptorSetLayoutBinding<'static> {
    let ty = match resource {
        Resource::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        Resource::DynamicUniform => vk::DescriptorType::UNIFORM_BUFFER_DYNAMIC,
        Resource::Storage => vk::DescriptorType::STORAGE_BUFFER,
        Resource::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
        Resource::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
        Resource::Sampler => vk::DescriptorType::SAMPLER,
    };
    let binding = vk::DescriptorSetLayoutBinding::default().binding(at).descriptor_type(ty).descriptor_count(1);
    binding.stage_flags(vk::ShaderStageFlags::ALL)
}

fn flag(kind: &str) -> vk::ShaderStageFlags {
    match kind {
        "vertex" => vk::ShaderStageFlags::VERTEX,
        "fragment" => vk::ShaderStageFlags::FRAGMENT,
        _ => vk::ShaderStageFlags::COMPUTE,
    }
}

fn vk_format(format: Format) -> vk::Format {
    match format {
        Format::Float2 => vk::Format::R32G32_SFLOAT,
        Format::Float3 => vk::Format::R32G32B32_SFLOAT,
        Format::Float4 => vk::Format::R32G32B32A32_SFLOAT,
        Format::Float => vk::Format::R32_SFLOAT,
        Format::Uint => vk::Format::R32_UINT,
        Format::Half4 => vk::Format::R16G16B16A16_SFLOAT,
        Format::Unorm4 => vk::Format::R8G8B8A8_UNORM,
    }
}

/// The driver's statistics for each stage of a pipeline.
fn statistics(
    executables: &khr::pipeline_executable_properties::Device,
    pipeline: vk::Pipeline,
    compile_ms: f64,
) -> Result<Vec<Statistics>, String> {
    let failed = |error: vk::Result| format!("the driver tells nothing of it: {error}");
    let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
    // SAFETY: the pipeline is alive and was created with the flag that captures statistics.
    let stages = unsafe { executables.get_pipeline_executable_properties(&info) }.map_err(failed)?;
    let mut all = Vec::new();
    for (index, stage) in (0..).zip(stages) {
        let info = vk::PipelineExecutableInfoKHR::default().pipeline(pipeline).executable_index(index);
        // SAFETY: as above, and the index is that of an executable.
        let found = unsafe { executables.get_pipeline_executable_statistics(&info) }.map_err(failed)?;
        let value = |name: &str| number(&found, name).ok_or_else(|| format!("the driver does not say its \"{name}\""));
        all.push(Statistics {
            stage: stage.name_as_c_str().unwrap_or_default().to_string_lossy().into_owned(),
            metrics: StageMetrics {
                vgprs: value("VGPRs")?,
                sgprs: value("SGPRs")?,
                spilled_vgprs: value("Spilled VGPRs")?,
                spilled_sgprs: value("Spilled SGPRs")?,
                scratch: value("Scratch size")?,
                waves: value("Subgroups per SIMD")?,
                inverse_throughput: value("Inverse Throughput")?,
                code_size: value("Code size")?,
                compile_ms,
            },
        });
    }
    Ok(all)
}

/// The value of the statistic with this name.
fn number(found: &[vk::PipelineExecutableStatisticKHR<'_>], name: &str) -> Option<u64> {
    let is_it = |one: &&vk::PipelineExecutableStatisticKHR<'_>| {
        one.name_as_c_str().is_ok_and(|found| found.to_bytes() == name.as_bytes())
    };
    let one = found.iter().find(is_it)?;
    let is_number = one.format == vk::PipelineExecutableStatisticFormatKHR::UINT64;
    if !is_number {
        return None;
    }
    // SAFETY: the format says which member of the union is set.
    Some(unsafe { one.value.u64 })
}

//! The graphics adapters of this machine, and the choice among them.

use std::fmt;

use super::error::GpuError;

/// Environment variable that names an adapter, if the command line does not.
const ADAPTER_VARIABLE: &str = "WGPU_ADAPTER_NAME";

/// Description of an adapter that is not open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Name of the graphics card, or of a software driver.
    pub name: String,
    /// Vulkan, Metal or DirectX 12.
    pub backend: String,
    /// Discrete, integrated, virtual, CPU or other.
    pub kind: String,
    /// Driver and its version.
    pub driver: String,
}

impl From<&wgpu::AdapterInfo> for AdapterSummary {
    fn from(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Cpu => "CPU",
            wgpu::DeviceType::Other => "other",
        };
        let driver = format!("{} {}", info.driver, info.driver_info);
        Self { name: info.name.clone(), backend: info.backend.to_string(), kind: kind.into(), driver }
    }
}

impl fmt::Display for AdapterSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}, {}, {})", self.name, self.backend, self.kind, self.driver.trim())
    }
}

/// Selects an adapter: one whose name contains a text (in any case), or the fastest.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AdapterChoice {
    wanted: Option<String>,
}

impl AdapterChoice {
    /// Selects the adapter of this name, else the one that the environment's `WGPU_ADAPTER_NAME` names, else the
    /// fastest.
    pub fn new(name: Option<&str>) -> Self {
        let of_environment = || std::env::var(ADAPTER_VARIABLE).ok();
        Self { wanted: name.map(str::to_owned).or_else(of_environment).filter(|name| !name.trim().is_empty()) }
    }

    /// The text that the adapter's name must contain, if any.
    pub fn wanted(&self) -> Option<&str> {
        self.wanted.as_deref()
    }

    /// Picks among those of `adapters` that satisfy `fits`.
    pub fn pick(
        &self,
        adapters: &[wgpu::Adapter],
        fits: impl Fn(&wgpu::Adapter) -> bool,
    ) -> Result<wgpu::Adapter, GpuError> {
        let infos: Vec<wgpu::AdapterInfo> = adapters.iter().map(wgpu::Adapter::get_info).collect();
        let usable = |i: &usize| fits(&adapters[*i]);
        let found = best((0..infos.len()).filter(usable).map(|i| (i, &infos[i])), self.wanted.as_deref());
        found.map(|i| adapters[i].clone()).ok_or_else(|| match &self.wanted {
            Some(wanted) if !infos.is_empty() => GpuError::NoSuchAdapter {
                wanted: wanted.clone(),
                found: infos.iter().map(|info| AdapterSummary::from(info).to_string()).collect::<Vec<_>>().join("; "),
            },
            _ => GpuError::NoAdapter,
        })
    }

    /// The choice in the form that a window's setup needs: it picks among the adapters that can present to the window.
    pub fn selector(
        &self,
    ) -> impl Fn(&[wgpu::Adapter], Option<&wgpu::Surface<'_>>) -> Result<wgpu::Adapter, String> + Send + Sync + use<>
    {
        let choice = self.clone();
        move |adapters, surface| {
            let shows = |adapter: &wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
            choice.pick(adapters, shows).map_err(|error| error.to_string())
        }
    }
}

/// All adapters of this machine.
pub fn adapters() -> Vec<AdapterSummary> {
    all(&instance()).iter().map(|adapter| AdapterSummary::from(&adapter.get_info())).collect()
}

/// Descriptor of an instance, with or without a window.
pub fn instance_descriptor() -> wgpu::InstanceDescriptor {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    // Validation layers are off unless a developer enables them through the environment.
    descriptor.flags = wgpu::InstanceFlags::empty().with_env();
    descriptor
}

/// An instance made with [`instance_descriptor`].
pub fn instance() -> wgpu::Instance {
    wgpu::Instance::new(instance_descriptor())
}

/// All adapters of the instance.
pub fn all(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// The fastest kind among those whose name contains `wanted`; within a kind the first, which is the system's
/// preference.
fn best<'a>(infos: impl Iterator<Item = (usize, &'a wgpu::AdapterInfo)>, wanted: Option<&str>) -> Option<usize> {
    let rank = |info: &wgpu::AdapterInfo| match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    let is_wanted = |name: &str| wanted.is_none_or(|wanted| name.to_lowercase().contains(&wanted.to_lowercase()));
    infos.filter(|(_, info)| is_wanted(&info.name)).min_by_key(|(i, info)| (rank(info), *i)).map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(name: &str, device_type: wgpu::DeviceType) -> wgpu::AdapterInfo {
        wgpu::AdapterInfo { name: name.into(), ..wgpu::AdapterInfo::new(device_type, wgpu::Backend::Vulkan) }
    }

    #[test]
    fn a_card_comes_before_the_processor_and_a_name_before_both() {
        let all = [
            info("llvmpipe", wgpu::DeviceType::Cpu),
            info("Intel Iris", wgpu::DeviceType::IntegratedGpu),
            info("GeForce A", wgpu::DeviceType::DiscreteGpu),
            info("GeForce B", wgpu::DeviceType::DiscreteGpu),
        ];
        let best = |wanted: Option<&str>| best(all.iter().enumerate(), wanted);
        assert_eq!(best(None), Some(2));
        assert_eq!(best(Some("LLVM")), Some(0));
        assert_eq!(best(Some("geforce b")), Some(3));
        assert_eq!(best(Some("Radeon")), None);
    }

    #[test]
    fn a_name_that_matches_nothing_is_told_with_what_there_is() {
        let instance = instance();
        let adapters = all(&instance);
        assert!(!adapters.is_empty(), "no graphics driver answers; apt-get install mesa-vulkan-drivers");
        let error = AdapterChoice::new(Some("no such card")).pick(&adapters, |_| true).expect_err("no such card");
        let text = error.to_string();
        assert!(text.contains("no such card") && text.contains(&adapters[0].get_info().name), "{text}");
        assert_eq!(text.lines().count(), 1, "{text}");
        assert!(matches!(AdapterChoice::new(None).pick(&[], |_| true), Err(GpuError::NoAdapter)));
    }
}

//! `isolith adapters`: lists the graphics adapters.

use serde_json::json;

use super::failure::Failure;
use super::text::say;
use crate::render::{AdapterChoice, GpuError, adapters};

/// Arguments of `isolith adapters`.
#[derive(Debug, clap::Args)]
pub struct AdaptersArguments {
    /// Print one JSON array: [{name, backend, kind, driver}]
    #[arg(long)]
    json: bool,
}

/// The adapter option of every command that draws.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AdapterArguments {
    /// Graphics adapter to draw on: part of a name from `isolith adapters`, in any case. Without it that of the
    /// environment's WGPU_ADAPTER_NAME, or the fastest
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
}

impl AdapterArguments {
    /// The chosen adapter.
    pub fn choice(&self) -> AdapterChoice {
        AdapterChoice::new(self.adapter.as_deref())
    }
}

/// Lists the adapters, one per line.
pub fn list(arguments: &AdaptersArguments) -> Result<(), Failure> {
    let found = adapters();
    if arguments.json {
        let row = |a: &crate::render::AdapterSummary| json!({ "name": a.name, "backend": a.backend, "kind": a.kind, "driver": a.driver });
        return say(&serde_json::Value::Array(found.iter().map(row).collect()).to_string());
    }
    if found.is_empty() {
        return Err(GpuError::NoAdapter.into());
    }
    found.iter().try_for_each(|adapter| say(&adapter.to_string()))
}

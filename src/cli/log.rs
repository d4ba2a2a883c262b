//! Logging: spans and events of `tracing` on standard error, enabled by `RUST_LOG`.
//! `RUST_LOG=isolith_field=debug,isolith_render=debug` times flattening, planning, uploads and each pass.

use std::io;

use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::FmtSpan;

/// Installs a subscriber if `RUST_LOG` is set. Without one, spans cost next to nothing.
pub fn listen() {
    let Ok(filter) = EnvFilter::try_from_default_env() else { return };
    let subscriber = tracing_subscriber::fmt().with_env_filter(filter).with_span_events(FmtSpan::CLOSE);
    // Tests may have installed a subscriber already.
    let _ = subscriber.with_writer(io::stderr).with_ansi(false).try_init();
}

//! What the program says about its own work: spans and events by `tracing`, on standard error, where `RUST_LOG` asks for
//! them. `RUST_LOG=isolith_field=debug,isolith_render=debug` times flattening, planning, uploads and each pass.

use std::io;

use tracing_subscriber::EnvFilter;
use tracing_subscriber::fmt::format::FmtSpan;

/// Listens, if the environment asks for it. Nothing is listened to otherwise, so that spans cost next to nothing.
pub fn listen() {
    let Ok(filter) = EnvFilter::try_from_default_env() else { return };
    let subscriber = tracing_subscriber::fmt().with_env_filter(filter).with_span_events(FmtSpan::CLOSE);
    // Another subscriber may be there already, in tests.
    let _ = subscriber.with_writer(io::stderr).with_ansi(false).try_init();
}

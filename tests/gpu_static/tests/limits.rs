//! No shader spills, and none takes so many registers that a graphics card has too few waves left.
//!
//! `make gpu-static` writes the figures into `benches/README.md`.

#![cfg(target_os = "linux")] // Where Mesa has that driver.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use gpu_static::cards::{CARDS, NO_DRIVER, Report, measure};
use gpu_static::gate::{EXCEPTIONS, faults, rows};
use gpu_static::subjects::{Pipeline, compute, subjects};
use gpu_static::table::{replaced, table};
use rayon::prelude::*;

/// The program for a card's process.
fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_gpu-static"))
}

#[test]
fn every_shader_is_within_the_limits_of_each_card() {
    let subjects = subjects().unwrap_or_else(|error| panic!("{error}"));
    assert!(subjects.pipelines.len() > 100, "only {} pipelines", subjects.pipelines.len());
    let reports: Result<Vec<Report>, _> =
        CARDS.par_iter().map(|card| measure(card, program(), &subjects.pipelines)).collect();
    let reports = reports.unwrap_or_else(|error| panic!("{error}"));
    let all: Vec<_> = CARDS.iter().zip(&reports).flat_map(|(card, report)| rows(card, &subjects, report)).collect();
    if std::env::var_os("ISOLITH_ACCEPT_GPU_STATIC").is_some_and(|value| value == "1") {
        let devices: Vec<_> = reports.iter().map(|report| report.device.as_str()).collect();
        let rows = table(&all, CARDS.len());
        let text = format!("{}; {} pipelines.\n\n{rows}", devices.join(", "), subjects.pipelines.len());
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../benches/README.md");
        let document = std::fs::read_to_string(&path).expect("benches/README.md is part of the source");
        let document = replaced(&document, "gpu-static", &text).expect("it has a place for the table");
        std::fs::write(&path, document).expect("benches/README.md can be written");
    }
    let faults = faults(&all, EXCEPTIONS);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// A shader with `count` values alive at once.
fn crowded(count: usize) -> Pipeline {
    let mut text = String::from("@group(0) @binding(0) var<storage, read_write> data: array<f32>;\n");
    text += "@compute @workgroup_size(64)\nfn crowd(@builtin(global_invocation_id) id: vec3u) {\n";
    for i in 0..count {
        writeln!(text, "    var v{i} = data[id.x * {count}u + {i}u];").expect("strings take all");
    }
    text += "    for (var round = 0u; round < u32(data[0]); round += 1u) {\n";
    for i in 0..count {
        writeln!(text, "        v{i} = sin(v{i} * v{});", (i + 1) % count).expect("strings take all");
    }
    text += "    }\n";
    for i in 0..count {
        writeln!(text, "    data[id.x * {count}u + {i}u] = v{i};").expect("strings take all");
    }
    text += "}\n";
    compute("crowd", &text, "crowd", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The figures depend on the shader: more live values take more registers, and too many spill.
#[test]
fn crowded_shaders_are_seen_to_take_more_registers_and_to_spill() {
    for card in &CARDS {
        let report = measure(card, program(), &[crowded(8), crowded(80), crowded(400)]);
        let report = report.unwrap_or_else(|error| panic!("{error}"));
        let [few, many, too_many] = [0, 1, 2].map(|i| report.statistics[i][0].metrics);
        assert!(few.vgprs < 40 && few.spilled_vgprs == 0, "{few:?}");
        assert!(many.vgprs > few.vgprs && many.spilled_vgprs == 0, "{many:?}");
        assert!(too_many.spilled_vgprs > 0 && too_many.scratch > 0, "{too_many:?}");
        assert!(few.waves > many.waves && few.code_size < many.code_size, "{few:?}, {many:?}");
        assert!(few.inverse_throughput < many.inverse_throughput, "{few:?}, {many:?}");
    }
}

#[test]
fn what_the_driver_refuses_is_named() {
    let mut broken = crowded(8);
    broken.stages[0].words.truncate(20);
    broken.name = "half a shader".to_owned();
    let error = measure(&CARDS[0], program(), &[broken]).expect_err("it is cut off");
    assert!(!error.to_string().contains("apt-get"), "{error}");
}

#[test]
fn a_missing_driver_says_how_to_install_it() {
    let orders = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(orders.path(), "[]").expect("it can be written");
    let nowhere = "no-such-driver.json";
    let mut command = Command::new(program());
    command.arg(orders.path()).env("VK_DRIVER_FILES", nowhere).env("VK_ICD_FILENAMES", nowhere);
    let output = command.output().expect("the process starts");
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && complaint.starts_with(NO_DRIVER), "{complaint}");
    let error = gpu_static::Error::NoDriver(complaint).to_string();
    assert!(error.contains("apt-get install mesa-vulkan-drivers"), "{error}");
}

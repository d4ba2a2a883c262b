//! `gpu-static FILE` is the process for a card: it compiles the pipelines of a file and prints the driver's statistics;
//! the test beside it starts one for each card. `gpu-static --shader FILE` prints each card's statistics for the field
//! passes of one WGSL file, such as the output of `isolith shader`.

use std::path::Path;
use std::process::ExitCode;

use gpu_static::cards::{CARDS, measure, serve};
use gpu_static::subjects::of_file;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let report = match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        ["--shader", file] => shader(Path::new(file)),
        [orders] => serve(Path::new(orders)),
        _ => Err("gpu-static --shader FILE".to_owned()),
    };
    match report {
        Ok(report) => {
            println!("{report}");
            ExitCode::SUCCESS
        }
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::FAILURE
        }
    }
}

/// Statistics of each card for a file, one line each.
fn shader(file: &Path) -> Result<String, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let pipelines = of_file(&file.display().to_string(), &text).map_err(|error| error.to_string())?;
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut lines = Vec::new();
    for card in &CARDS {
        let report = measure(card, &program, &pipelines).map_err(|error| error.to_string())?;
        for (pipeline, stages) in pipelines.iter().zip(report.statistics) {
            lines.extend(stages.iter().map(|stage| format!("{}, {}: {stage:?}", card.name, pipeline.name)));
        }
    }
    Ok(lines.join("\n"))
}

//! `isolith bench`: run time against error, for every scene, method and quality.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{ImageFormat, RgbImage};

use super::adapters::AdapterArguments;
use super::failure::Failure;
use super::progress::{Interrupts, Progress};
use super::text::{complain, say};
use crate::bench::{
    Baseline, Bench, BenchError, BenchRow, BenchScene, Metrics, ReferenceCache, cases, csv, first_of_each, growth,
    markdown, noise, stress_sheet, stress_table, time_against_error, worst_first,
};
use crate::export::outputs::write_bytes;
use crate::gallery;
use crate::jobs::Task;
use crate::mesh::MeshLibrary;
use crate::render::driver::loop_iterations;
use crate::render::{EvalStrategy, Gpu, Renderer};
use crate::scene::{Scene, file};
use crate::session::ModelFields;
use crate::wgsl::Quality;

/// Smallest and largest side of a measured picture, in pixels.
const SIDES: std::ops::RangeInclusive<u32> = 16..=4096;
/// Numbers of leaves of the scenes for `--growth`, each eight times the one before.
const GROWTH_LEAVES: [usize; 5] = [8, 32, 128, 1024, 8192];
/// Seed of these scenes.
const GROWTH_SEED: u64 = 5;

/// Arguments of `isolith bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArguments {
    /// Scene files; without any, the example scenes
    scenes: Vec<PathBuf>,
    /// Methods, separated by commas: thesis, baked, interpreter, tape, straight-line, limit, auto
    #[arg(long, value_delimiter = ',', default_values_t = [Baseline::Interpreter, Baseline::Tape, Baseline::StraightLine, Baseline::Limit, Baseline::Auto].map(|w| w.name().to_owned()))]
    methods: Vec<String>,
    /// Qualities, separated by commas: draft, default, fine
    #[arg(long, value_delimiter = ',', default_values_t = ["default".to_owned()])]
    qualities: Vec<String>,
    /// Width and height of the pictures in pixels
    #[arg(long, value_name = "N", default_value_t = 512, value_parser = clap::value_parser!(u32).range(i64::from(*SIDES.start())..=i64::from(*SIDES.end())))]
    size: u32,
    /// Measure random scenes of 10 to 10 000 nodes instead, and draw how time grows
    #[arg(long, conflicts_with = "scenes")]
    growth: bool,
    /// Measure large blends instead: 256 and 2 000 leaves in one union, blended and hard, 186 boxes, 1 001 spheres
    #[arg(long, conflicts_with_all = ["scenes", "growth"])]
    blends: bool,
    /// Draw every shape, operator and modifier where numbers get difficult, and compare with the reference
    #[arg(long, conflicts_with_all = ["scenes", "growth", "blends", "json", "methods", "qualities", "size"])]
    stress: bool,
    /// Write tables (bench.md, bench.csv) and charts (SCENE.png) into this folder
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Print one JSON object a line instead of the tables
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    adapter: AdapterArguments,
}

/// Measures, prints, and writes the requested files. Reports and skips measurements that fail, such as a scene too
/// large for a method.
pub fn bench(arguments: &BenchArguments) -> Result<(), Failure> {
    arguments.output.as_deref().map_or(Ok(()), create_folder)?;
    if arguments.stress {
        return stress(arguments);
    }
    let baselines: Vec<Baseline> = parsed(&arguments.methods, |name| name.parse())?;
    let qualities: Vec<Quality> = parsed(&arguments.qualities, |name| {
        let found = Quality::ALL.into_iter().find(|quality| quality.name() == name);
        found.ok_or_else(|| format!("{name} is none of draft, default, fine"))
    })?;
    let bench_scenes = bench_scenes(arguments)?;
    if arguments.output.is_some() {
        one_chart_each(&bench_scenes)?;
    }
    let gpu = Gpu::open(&arguments.adapter.choice())?;
    loop_iterations(&gpu)?;
    let bench = Bench::new(gpu);
    let mut references = ReferenceCache::default();
    let mut rows: Vec<BenchRow> = Vec::new();
    let mut progress = Progress::start("measuring", arguments.json, Interrupts::StopTheTask);
    let all = (bench_scenes.len() * baselines.len() * qualities.len()).max(1);
    let mut done = 0;
    for bench_scene in &bench_scenes {
        let reference = references.of(bench_scene, arguments.size).map_err(failed)?;
        for (baseline, quality) in
            baselines.iter().flat_map(|baseline| qualities.iter().map(move |quality| (*baseline, *quality)))
        {
            if !progress.update(done as f64 / all as f64) {
                return Err(Failure::Canceled);
            }
            done += 1;
            match bench.measure(bench_scene, baseline, quality, arguments.size, &reference) {
                Ok(row) => {
                    if arguments.json {
                        say(&row.to_json_line())?;
                    }
                    rows.push(row);
                }
                Err(BenchError::Scene(error)) => {
                    complain(&format!("left out: {}: {}: {error}", bench_scene.name, baseline.name()))
                }
                Err(error) => return Err(failed(error)),
            }
        }
    }
    progress.finish();
    if !arguments.json {
        say(&markdown(&rows))?;
    }
    for line in noise(&rows) {
        complain(&format!("noise: {line}"));
    }
    arguments.output.as_ref().map_or(Ok(()), |folder| write(folder, &bench, &rows, arguments.growth))
}

/// Number of nodes whose worst case appears in the picture.
const SHOWN: usize = 10;
/// Number of printed cases.
const PRINTED: usize = 40;

/// Draws every case of numerical stress and prints the worst ones. `stress.md` lists all cases, `stress.png` shows the
/// worst case of each of the ten worst nodes.
fn stress(arguments: &BenchArguments) -> Result<(), Failure> {
    let gpu = Gpu::open(&arguments.adapter.choice())?;
    loop_iterations(&gpu)?;
    let mut renderer = Renderer::new(&gpu)?;
    renderer.tape_cache().build_all();
    let mut progress = Progress::start("stressing", false, Interrupts::StopTheTask);
    let all = cases();
    let mut metrics: Vec<Metrics> = Vec::new();
    let (mut unseen, mut left_out) = (0, 0);
    for (i, case) in all.iter().enumerate() {
        if !progress.update(i as f64 / all.len() as f64) {
            return Err(Failure::Canceled);
        }
        let name = || format!("{}, {}", case.name(), case.circumstance);
        match case.measure(&mut renderer, &[EvalStrategy::Interpreter, EvalStrategy::Tape, EvalStrategy::StraightLine])
        {
            Ok(Some(found)) => metrics.push(found),
            Ok(None) => unseen += 1,
            Err(error @ (BenchError::Scene(_) | BenchError::View(_) | BenchError::Reference { .. })) => {
                complain(&format!("left out: {}: {error}", name()));
                left_out += 1;
            }
            Err(error) => return Err(Failure::Other(format!("{}: {error}", name()))),
        }
    }
    progress.finish();
    worst_first(&mut metrics);
    say(&stress_table(&metrics, PRINTED))?;
    say(&format!("{unseen} cases show no surface, {left_out} were left out."))?;
    let Some(folder) = arguments.output.as_deref() else { return Ok(()) };
    write_text(folder, "stress.md", &stress_table(&metrics, metrics.len()))?;
    write_picture(folder, "stress.png", &stress_sheet(&first_of_each(&metrics), SHOWN))
}

fn parsed<T>(names: &[String], parse: impl Fn(&str) -> Result<T, String>) -> Result<Vec<T>, Failure> {
    names.iter().map(|name| parse(name.trim()).map_err(Failure::Usage)).collect()
}

fn failed(error: BenchError) -> Failure {
    match error {
        BenchError::Render(error) => error.into(),
        error => Failure::Other(error.to_string()),
    }
}

fn bench_scenes(arguments: &BenchArguments) -> Result<Vec<BenchScene>, Failure> {
    if arguments.growth {
        let random = |leaves: &usize| {
            let scene = gallery::random(*leaves, GROWTH_SEED);
            let name = format!("random-{}", scene.nodes().len());
            BenchScene::new(&name, scene, &mut MeshLibrary::new(None)).map_err(failed)
        };
        return GROWTH_LEAVES.iter().map(random).collect();
    }
    if arguments.blends {
        let crowd = |leaves, is_blended| gallery::crowd(leaves, is_blended, GROWTH_SEED);
        let all = [
            ("hard-256", crowd(256, false)),
            ("blend-256", crowd(256, true)),
            ("hard-2000", crowd(2000, false)),
            ("blend-2000", crowd(2000, true)),
            ("boxes-186", gallery::boxes(186, GROWTH_SEED)),
            ("spheres-1001", gallery::spheres(GROWTH_SEED)),
        ];
        let bench_scene = |(name, scene)| BenchScene::new(name, scene, &mut MeshLibrary::new(None)).map_err(failed);
        return all.into_iter().map(bench_scene).collect();
    }
    if arguments.scenes.is_empty() {
        let examples = Path::new("scenes");
        let mut library = MeshLibrary::new(examples.is_dir().then(|| examples.to_path_buf()));
        let all = gallery::all().into_iter();
        let bench_scene = |(name, scene): (&str, Scene)| {
            BenchScene::new(name, with_fields(&scene, &mut library), &mut library).map_err(failed)
        };
        return all.map(bench_scene).collect();
    }
    let load = |path: &PathBuf| {
        let scene = file::load(path).map_err(Failure::Scene)?;
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let mut library = MeshLibrary::new(path.parent().map(Path::to_path_buf));
        let scene = with_fields(&scene, &mut library);
        BenchScene::new(&name, scene, &mut library).map_err(|error| match error {
            BenchError::Scene(error) => Failure::beyond_limit(path, &error),
            error => failed(error),
        })
    };
    arguments.scenes.iter().map(load).collect()
}

/// The scene with its models as fields.
fn with_fields(scene: &Scene, library: &mut MeshLibrary) -> Scene {
    let mut fields = ModelFields::new(library.folder().map(Path::to_path_buf));
    fields.make_all(scene, library, &Task::new("Making bricks"));
    fields.filled(scene).into_owned()
}

fn write(folder: &Path, bench: &Bench, rows: &[BenchRow], grown: bool) -> Result<(), Failure> {
    let info = &bench.gpu().info;
    let heading = format!("On {} ({}).\n\n", info.name, info.driver_info);
    write_text(folder, "bench.md", &(heading + &markdown(rows)))?;
    write_text(folder, "bench.csv", &csv(rows))?;
    if grown {
        write_picture(folder, "growth.png", &growth(rows))?;
    }
    for of_scene in rows.chunk_by(|a, b| a.scene == b.scene) {
        write_picture(folder, &format!("{}.png", of_scene[0].scene), &time_against_error(of_scene))?;
    }
    Ok(())
}

/// Refuses two scenes of the same name: charts are named after scenes, so one would be lost.
fn one_chart_each(bench_scenes: &[BenchScene]) -> Result<(), Failure> {
    let repeated = bench_scenes.iter().enumerate().find(|(i, a)| bench_scenes[..*i].iter().any(|b| b.name == a.name));
    repeated.map_or(Ok(()), |(_, bench_scene)| {
        Err(Failure::Usage(format!(
            "two scenes are called {0}, and {0}.png could show only one of them",
            bench_scene.name
        )))
    })
}

fn not_written(path: &Path, error: &dyn std::error::Error) -> Failure {
    Failure::Write { path: path.to_path_buf(), reason: error.to_string() }
}

fn create_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| not_written(folder, &error))
}

fn write_text(folder: &Path, name: &str, text: &str) -> Result<(), Failure> {
    Ok(write_bytes(&folder.join(name), text.as_bytes())?)
}

fn write_picture(folder: &Path, name: &str, picture: &RgbImage) -> Result<(), Failure> {
    let path = folder.join(name);
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| not_written(&path, &error))?;
    Ok(write_bytes(&path, bytes.get_ref())?)
}

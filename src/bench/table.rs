//! Measurements as text: Markdown for people, CSV for programs, and warnings about insignificant differences.

use std::collections::BTreeMap;

use super::row::BenchRow;

/// The column headings of the Markdown tables. The first two columns hold text, the others numbers.
const HEADS: [&str; 20] = [
    "method",
    "quality",
    "CPU ms",
    "±",
    "× auto",
    "wall ms",
    "steps/px",
    "p99",
    "max",
    "evals/px",
    "of surfaces",
    "cells/px",
    "entries/px",
    "wrong %",
    "grazing %",
    "depth p50",
    "depth p99",
    "depth max",
    "normal p50°",
    "normal p99°",
];
const WORDS: usize = 2;

/// One table for each scene and size, in order of first appearance. "±" is half the spread of the runs, "× auto" the
/// CPU time divided by that of `auto` at the default quality in the same table. Depths are in pixel footprints, normals
/// in degrees. "p99" and "max" of steps are the 99th percentile and the maximum over pixels. "evals/px" counts the
/// evaluations of all passes, "of surfaces" the part of them for normal and material.
pub fn markdown(rows: &[BenchRow]) -> String {
    let tables: Vec<String> = scenes(rows).iter().map(|rows| scene_table(rows)).collect();
    tables.join("\n")
}

/// The rows grouped by scene and size, in order of appearance.
fn scenes(rows: &[BenchRow]) -> Vec<Vec<&BenchRow>> {
    let mut scenes: Vec<Vec<&BenchRow>> = Vec::new();
    for row in rows {
        match scenes.iter_mut().find(|scene| scene[0].scene == row.scene && scene[0].size == row.size) {
            Some(scene) => scene.push(row),
            None => scenes.push(vec![row]),
        }
    }
    scenes
}

fn scene_table(rows: &[&BenchRow]) -> String {
    let auto = rows.iter().find(|row| row.is_the_default()).map(|row| row.cpu_ms);
    let mut lines: Vec<Vec<String>> = vec![HEADS.map(String::from).to_vec()];
    lines.extend(rows.iter().map(|row| cells(row, auto)));
    let widths: Vec<usize> =
        (0..HEADS.len()).map(|i| lines.iter().map(|line| line[i].chars().count()).max().unwrap_or(0)).collect();
    let first = rows[0];
    let mut text = format!("### {}: {}, {} × {} pixels\n\n", first.scene, first.node_count(), first.size, first.size);
    for (i, line) in lines.iter().enumerate() {
        text += &aligned(line, &widths);
        if i == 0 {
            let rules: Vec<String> =
                widths.iter().enumerate().map(|(i, &w)| if i < WORDS { "-".repeat(w) } else { rule(w) }).collect();
            text += &aligned(&rules, &widths);
        }
    }
    text
}

/// The Markdown separator of a right-aligned column.
fn rule(width: usize) -> String {
    format!("{}:", "-".repeat(width.saturating_sub(1)))
}

fn aligned(cells: &[String], widths: &[usize]) -> String {
    let mut line = String::from("|");
    for (i, (cell, &width)) in cells.iter().zip(widths).enumerate() {
        line += &if i < WORDS { format!(" {cell:<width$} |") } else { format!(" {cell:>width$} |") };
    }
    line + "\n"
}

fn cells(row: &BenchRow, auto: Option<f64>) -> Vec<String> {
    let ratio = auto.filter(|&ms| ms > 0.0).map_or("–".into(), |ms| format!("{:.2}", row.cpu_ms / ms));
    vec![
        row.method.replace('|', "\\|"),
        row.quality.replace('|', "\\|"),
        significant(row.cpu_ms),
        significant(row.cpu_ms_spread / 2.0),
        ratio,
        significant(row.wall_ms),
        significant(row.steps_per_px),
        significant(row.steps_p99),
        significant(row.steps_max),
        significant(row.evals_per_px),
        significant(row.surface_evals_per_px),
        significant(row.cells_per_px),
        significant(row.entries_per_px),
        format!("{:.4}", row.wrong_share * 100.0),
        format!("{:.4}", row.grazing_share * 100.0),
        format!("{:.5}", row.depth_p50),
        format!("{:.5}", row.depth_p99),
        format!("{:.4}", row.depth_max),
        format!("{:.4}", row.normal_p50),
        format!("{:.3}", row.normal_p99),
    ]
}

/// A number with three significant digits, or all digits before the decimal point.
fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

/// As [`significant`], without trailing zeros, for running text.
fn in_text(value: f64) -> String {
    let text = significant(value);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// All rows with full precision below a header line: the fields of the JSON, in the same order.
pub fn csv(rows: &[BenchRow]) -> String {
    let mut text = String::from(
        "scene,nodes,method,size,cpu_ms,wall_ms,steps_per_px,evals_per_px,surface_evals_per_px,wrong_share,grazing_share,\
         depth_p50,depth_p99,depth_max,normal_p50,normal_p99,quality,cpu_ms_spread,steps_p99,steps_max,cells_per_px,\
         entries_per_px\n",
    );
    for row in rows.iter().map(BenchRow::clamped) {
        let numbers = [
            row.cpu_ms,
            row.wall_ms,
            row.steps_per_px,
            row.evals_per_px,
            row.surface_evals_per_px,
            row.wrong_share,
            row.grazing_share,
            row.depth_p50,
            row.depth_p99,
            row.depth_max,
            row.normal_p50,
            row.normal_p99,
        ]
        .map(|number| format!("{number:?}"));
        text += &format!(
            "{},{},{},{},{},{},{:?},{:?},{:?},{:?},{:?}\n",
            quoted(&row.scene),
            row.nodes,
            quoted(&row.method),
            row.size,
            numbers.join(","),
            quoted(&row.quality),
            row.cpu_ms_spread,
            row.steps_p99,
            row.steps_max,
            row.cells_per_px,
            row.entries_per_px,
        );
    }
    text
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

/// A warning for each pair of methods whose times, for the same scene, size and quality, differ by less than the spread
/// of the runs of one of them: neither counts as faster.
pub fn noise(rows: &[BenchRow]) -> Vec<String> {
    let mut groups: BTreeMap<(&str, u32, &str), Vec<&BenchRow>> = BTreeMap::new();
    for row in rows {
        groups.entry((&row.scene, row.size, &row.quality)).or_default().push(row);
    }
    let mut found = Vec::new();
    for ((scene, _, quality), group) in groups {
        for (i, a) in group.iter().enumerate() {
            for b in group[i + 1..].iter().filter(|b| b.method != a.method) {
                let spread = a.cpu_ms_spread.max(b.cpu_ms_spread);
                if (a.cpu_ms - b.cpu_ms).abs() < spread {
                    let of = if quality == super::row::DEFAULT { String::new() } else { format!(" ({quality})") };
                    found.push(format!(
                        "{scene}{of}: {} ({} ms) and {} ({} ms) differ by less than the noise of {} ms",
                        a.method,
                        in_text(a.cpu_ms),
                        b.method,
                        in_text(b.cpu_ms),
                        in_text(spread),
                    ));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::samples::{row, scene};

    #[test]
    fn a_table_is_aligned_and_compares_with_auto() {
        let mut rows = scene("random-145", 145);
        rows.push(row("pawn", 13, "thesis", "default", 2.0, 0.1));
        let text = markdown(&rows);
        let tables: Vec<&str> = text.split("### ").skip(1).collect();
        assert_eq!(tables.len(), 2);
        assert!(tables[0].starts_with("random-145: 145 nodes, 256 × 256 pixels\n"));
        for table in &tables {
            let widths: Vec<usize> = table.lines().filter(|l| l.starts_with('|')).map(|l| l.chars().count()).collect();
            assert!(widths.windows(2).all(|w| w[0] == w[1]), "{table}");
        }
        let auto = tables[0].lines().find(|l| l.starts_with("| auto") && l.contains("default")).unwrap();
        assert_eq!(auto.split('|').nth(5).unwrap().trim(), "1.00");
        assert!(tables[1].contains(" – |"), "nothing to compare with: {}", tables[1]);
        assert_eq!(markdown(&[]), "");
    }

    #[test]
    fn digits_are_sensible() {
        let cases = [(0.0, "0"), (0.012_345, "0.0123"), (1.234_5, "1.23"), (45.678, "45.7"), (12_345.6, "12346")];
        for (value, text) in cases {
            assert_eq!(significant(value), text);
        }
        assert_eq!(in_text(30.0), "30");
        assert_eq!(in_text(1200.0), "1200");
    }

    #[test]
    fn csv_has_the_names_and_the_order_of_json() {
        let mut sample = row("a, \"b\"", 3, "auto", "fine", 1.5, 0.1);
        sample.depth_max = f64::INFINITY;
        let text = csv(&[sample.clone()]);
        let lines: Vec<&str> = text.lines().collect();
        let json = sample.to_json_line();
        let places: Vec<usize> = lines[0].split(',').map(|n| json.find(&format!("\"{n}\":")).unwrap()).collect();
        assert!(places.is_sorted() && places.len() == 22);
        assert!(lines[1].starts_with("\"a, \"\"b\"\"\",3,auto,256,1.5,"), "{}", lines[1]);
        assert!(!text.contains("inf"));
        assert_eq!(csv(&[]).lines().count(), 1);
    }

    #[test]
    fn differences_within_the_noise_are_told() {
        let measured = |method: &str, cpu_ms: f64, spread: f64| {
            let mut row = row("random-145", 145, method, "default", cpu_ms, 0.1);
            row.cpu_ms_spread = spread;
            row
        };
        let rows = [measured("tape", 30.0, 1.0), measured("straight-line", 32.0, 4.0), measured("thesis", 90.0, 4.0)];
        assert_eq!(
            noise(&rows),
            ["random-145: tape (30 ms) and straight-line (32 ms) differ by less than the noise of 4 ms"]
        );
        assert!(noise(&[measured("tape", 30.0, 0.0), measured("thesis", 30.0, 0.0)]).is_empty());
        assert!(noise(&[]).is_empty());
    }

    #[test]
    fn only_like_is_compared_with_like() {
        let mut rows = [row("a", 1, "tape", "default", 1.0, 0.1), row("a", 1, "thesis", "fine", 1.0, 0.1)];
        rows[0].cpu_ms_spread = 1.0;
        assert!(noise(&rows).is_empty());
        rows[0].quality = "fine".into();
        assert_eq!(noise(&rows).len(), 1);
        assert!(noise(&rows)[0].starts_with("a (fine): tape (1 ms)"));
        rows[1].size = 512;
        assert!(noise(&rows).is_empty());
    }
}

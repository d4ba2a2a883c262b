//! Plausible rows for the tests.

use super::BenchRow;

/// A row whose other numbers are consistent with the time and the error.
pub fn row(scene: &str, nodes: usize, method: &str, quality: &str, cpu_ms: f64, depth_p99: f64) -> BenchRow {
    BenchRow {
        scene: scene.into(),
        nodes,
        method: method.into(),
        quality: quality.into(),
        size: 256,
        cpu_ms,
        wall_ms: cpu_ms / 1.8,
        cpu_ms_spread: cpu_ms * 0.04,
        steps_per_px: 20.0 + cpu_ms.sqrt(),
        evals_per_px: cpu_ms * 40.0,
        surface_evals_per_px: 0.4,
        wrong_share: 0.0,
        grazing_share: 0.000_03,
        depth_p50: depth_p99 / 5.0,
        depth_p99,
        depth_max: depth_p99 * 900.0,
        normal_p50: depth_p99 * 8.0,
        normal_p99: depth_p99 * 600.0,
        steps_p99: 60.0 + cpu_ms.sqrt(),
        steps_max: 400.0,
        cells_per_px: 12.0,
        entries_per_px: 40.0,
    }
}

/// Every method at every quality, for a scene with this many nodes.
pub fn scene(name: &str, nodes: usize) -> Vec<BenchRow> {
    let n = nodes as f64 / 145.0;
    let methods = [
        ("thesis", 2900.0 * n, 40.0, 1.3),
        ("baked", 310.0 * n, 1.0, 1.2),
        ("interpreter", 720.0 * n, 1.0, 1.25),
        ("tape", 30.0 * n.powf(0.47), 1.0, 1.4),
        ("straight-line", 32.5 * n.powf(0.52), 1.02, 1.38),
        ("limit", 11.0 * n.powf(0.3), 1.0, 1.3),
        ("auto", 30.4 * n.powf(0.46), 1.0, 1.4),
    ];
    let qualities = [("draft", 0.6, 0.03), ("default", 1.0, 0.000_16), ("fine", 1.7, 0.000_006)];
    let mut rows = Vec::new();
    for (method, cpu_ms, worse, slope) in methods {
        for (quality, longer, error) in qualities {
            let longer: f64 = longer;
            let mut row = row(name, nodes, method, quality, cpu_ms * longer.powf(slope), error * worse);
            row.wrong_share = if method == "thesis" && quality != "fine" { 0.0011 } else { 0.000_015 };
            rows.push(row);
        }
    }
    rows
}

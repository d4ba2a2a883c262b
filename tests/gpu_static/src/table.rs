//! The tables of `benches/README.md`.

use std::fmt::Write as _;

use crate::gate::Row;
use crate::subjects::Purpose;

/// One line per purpose, with both cards in each column. `rows` contains the rows of one card, then those of the other.
pub fn table(rows: &[Row], cards: usize) -> String {
    let mut out = String::from(
        "| scene | by | pass | kernels | VGPRs | of them spilled | SGPRs | of them spilled | scratch, bytes | waves | inverse throughput | code, KB | \
         compiled in, ms |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    let count = rows.len() / cards.max(1);
    for at in 0..count {
        let same: Vec<&Row> = rows.iter().skip(at).step_by(count.max(1)).collect();
        let of = |figure: &dyn Fn(&Row) -> String| {
            let mut all: Vec<String> = same.iter().map(|row| figure(row)).collect();
            all.dedup();
            all.join(" / ")
        };
        let Purpose { scene, way, pass } = &same[0].purpose;
        writeln!(
            out,
            "| {scene} | {} | {pass} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            way.name(),
            same[0].pipelines,
            of(&|row| row.metrics.vgprs.to_string()),
            of(&|row| row.metrics.spilled_vgprs.to_string()),
            of(&|row| row.metrics.sgprs.to_string()),
            of(&|row| row.metrics.spilled_sgprs.to_string()),
            of(&|row| row.metrics.scratch.to_string()),
            of(&|row| row.metrics.waves.to_string()),
            of(&|row| row.metrics.inverse_throughput.to_string()),
            of(&|row| format!("{:.1}", row.metrics.code_size as f64 / 1024.0)),
            of(&|row| format!("{:.0}", row.metrics.compile_ms)),
        )
        .expect("strings take all");
    }
    out
}

/// Returns `text` with the table between the marks of this name replaced.
pub fn replaced(text: &str, mark: &str, table: &str) -> Option<String> {
    let [begin, end] = ["begin", "end"].map(|side| format!("<!-- {mark}:{side} -->"));
    let start = text.find(&begin)? + begin.len();
    let stop = text.find(&end)?;
    Some(format!("{}\n\n{table}\n{}", text.get(..start)?, text.get(stop..)?))
}

//! The figures as CSV and as Markdown.

use std::fmt::Write;

use shadowfit_report::{markdown_table, readable};
use shadowfit_truth::PictureTally;

use super::contestants::Shown;
use super::measured::{Measured, Row};

/// A column of a Markdown table: its title, and the column of the sums.
type Column = (&'static str, &'static str);
/// Columns of the Markdown tables.
const COLUMNS: [Column; 6] = [
    ("wrong %", "wrong %"),
    ("light error %", "light error %"),
    ("ꟻLIP", "flip"),
    ("hole %", "hole %"),
    ("crawl %", "crawl %"),
    ("pixels per texel", "ppt p95"),
];
/// Columns of the README's table.
const LEADING: [Column; 4] =
    [("wrong %", "wrong %"), ("light error %", "light error %"), ("ꟻLIP", "flip"), ("crawl %", "crawl %")];
/// Columns by which contestants are ranked.
const RANKED: [Column; 3] = [("wrong %", "wrong %"), ("light error", "light error %"), ("ꟻLIP", "flip")];

/// Returns the columns of each row in each group, and over all frames (`all`).
pub(super) fn csv(measured: &Measured) -> String {
    let titles: Vec<&str> = PictureTally::default().columns().iter().map(|(title, _)| *title).collect();
    let mut text = format!("# {}\nframes,fit,{}\n", measured.adapter, titles.join(","));
    let mut line = |group: &str, row: &Row, tally: &PictureTally| {
        let number = |value: f64| if value.is_nan() { String::new() } else { format!("{value:.6}") };
        let values: Vec<String> = tally.columns().iter().map(|(_, value)| number(*value)).collect();
        let _ = writeln!(text, "{group},{},{}", row.name, values.join(","));
    };
    for row in &measured.rows {
        line("all", row, &measured.sum(row, |_| true));
    }
    for group in measured.groups() {
        for row in &measured.rows {
            line(group, row, &measured.sum(row, |frame| frame.group == group));
        }
    }
    text
}

/// Returns the facts, the table of all frames, the ranks, and a table for each scene.
pub(super) fn markdown(measured: &Measured) -> String {
    let mut text = "# Figures\n\nWritten by `cargo xtask figures`.\n\n".to_owned();
    let [width, height] = measured.size;
    let _ = writeln!(text, "- Adapter: {}", measured.adapter);
    let _ = writeln!(text, "- Pictures: {width} × {height} pixels, {} frames", measured.frames.len());
    for note in measured.notes.iter().chain([&measured.frames_note()]) {
        let _ = writeln!(text, "- {note}");
    }
    let _ = write!(text, "\n## All scenes\n\n{}\n{}", overall(measured), ranks(measured));
    for frames in measured.frames.chunk_by(|a, b| a.scene == b.scene) {
        let scene = &frames[0].scene;
        let _ = write!(
            text,
            "\n## {scene}\n\n{}",
            table(measured, &COLUMNS, Shown::InDetail, |row| measured.sum(row, |f| f.scene == *scene))
        );
    }
    text
}

/// Returns the table over all frames, with the adapter.
pub(super) fn overall(measured: &Measured) -> String {
    whole(measured, &COLUMNS, Shown::InDetail)
}

/// Returns the README's table over all frames.
pub(super) fn short(measured: &Measured) -> String {
    whole(measured, &LEADING, Shown::Everywhere)
}

fn whole(measured: &Measured, columns: &[Column], least: Shown) -> String {
    let ([width, height], frames) = (measured.size, measured.frames.len());
    let table = table(measured, columns, least, |row| measured.sum(row, |_| true));
    format!("{table}\n{frames} frames of {width} × {height} pixels, {}.\n", measured.adapter)
}

/// Returns a table of the contestants that are shown in `least` or more places, the worst first.
fn table(measured: &Measured, columns: &[Column], least: Shown, sum: impl Fn(&Row) -> PictureTally) -> String {
    let rows = measured.rows.iter().filter(|row| row.shown >= least);
    let mut rows: Vec<(&Row, PictureTally)> = rows.map(|row| (row, sum(row))).collect();
    rows.sort_by(|(_, a), (_, b)| value(b, "wrong %").total_cmp(&value(a, "wrong %")));
    let titles: Vec<String> =
        ["fit"].into_iter().chain(columns.iter().map(|(title, _)| *title)).map(str::to_owned).collect();
    let cells = rows.iter().map(|(row, tally)| {
        let values = columns.iter().map(|(_, column)| readable(value(tally, column)));
        [row.name.clone()].into_iter().chain(values).collect::<Vec<_>>()
    });
    markdown_table(&titles, cells)
}

/// Returns the order by each measure, best first.
fn ranks(measured: &Measured) -> String {
    let mut text = "Order by each measure, best first:\n\n".to_owned();
    for (title, column) in RANKED {
        let sums = measured.rows.iter().map(|row| (row, value(&measured.sum(row, |_| true), column)));
        let mut ranked: Vec<(&Row, f64)> = sums.collect();
        ranked.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        let names: Vec<&str> = ranked.iter().map(|(row, _)| row.name.as_str()).collect();
        let _ = writeln!(text, "- {title}: {}", names.join(", "));
    }
    text
}

fn value(tally: &PictureTally, column: &str) -> f64 {
    tally.columns().iter().find(|(title, _)| *title == column).map_or(f64::NAN, |(_, value)| *value)
}

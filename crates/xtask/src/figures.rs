//! `cargo xtask figures`: measures the figures of README and BENCHMARKS again, on scenes that code generates.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::process;
use crate::setup::{self, Purpose};

/// Folder of the results, relative to the workspace's folder.
const RESULTS: &str = "out/figures";
/// Folder of the program that runs other engines' fits from their packages, relative to the workspace's folder.
const PEERS: &str = "crates/shadowfit-report/peers";
/// Its files.
const PEER_FILES: [&str; 2] = ["package.json", "fit.mjs"];
/// Folder of the tables in the docs, relative to the workspace's folder.
const DOCS: &str = "docs/figures";
/// Pages with the table of all scenes, between [`MARKS`], and the result with that table.
const PAGES: [(&str, &str); 2] = [("README.md", "short.md"), ("docs/BENCHMARKS.md", "overall.md")];
const MARKS: [&str; 2] = ["<!-- figures: begin -->", "<!-- figures: end -->"];

/// Options of the task.
#[derive(clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "the flags of a command line")]
pub(crate) struct Figures {
    /// A quick look of two minutes: one frame of each path, and the fits of the README.
    #[arg(long)]
    quick: bool,
    /// Also runs the fits of three.js and Babylon.js from their npm packages and compares them with ours.
    #[arg(long)]
    peers: bool,
    /// Also measures times, as `cargo xtask bench` does with and without `--gpu` and `--growth`.
    #[arg(long)]
    times: bool,
    /// Writes the tables into README.md and docs.
    #[arg(long, conflicts_with = "quick")]
    write: bool,
    /// Further options of `shadowfit-report figures`, for example `--adapter any`.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    args: Vec<String>,
}

/// Measures, and writes the results into `out/figures`.
///
/// # Errors
/// If a program is missing or fails, or a file cannot be written.
pub(crate) fn figures(options: &Figures) -> Result<()> {
    setup::prepare(if options.peers { Purpose::Peers } else { Purpose::Run })?;
    let results = process::root().join(RESULTS);
    fs::create_dir_all(&results).with_context(|| format!("{}: cannot be made", results.display()))?;
    let mut measure = report();
    measure.arg("-o").arg(&results).args(&options.args);
    if options.quick {
        measure.arg("--quick");
    }
    if options.peers {
        measure.arg("--peers").arg(run_peers(&results, &options.args)?);
    }
    process::run(&mut measure)?;
    println!("{}: index.html, figures.md and figures.csv", results.display());
    if options.times {
        times(&results)?;
    }
    if options.write { write(&results) } else { Ok(()) }
}

/// Returns the command of the program, without its options.
fn report() -> Command {
    let mut command = process::cargo("run");
    command.args(["--release", "--package", "shadowfit-report", "--", "figures"]);
    process::with_runtime_folder(&mut command);
    command
}

/// Runs the fits of the packages on the frames of the figures. Returns the folder of the fit files.
fn run_peers(results: &Path, args: &[String]) -> Result<std::path::PathBuf> {
    let folder = results.join("peers");
    fs::create_dir_all(&folder).with_context(|| format!("{}: cannot be made", folder.display()))?;
    for file in PEER_FILES {
        let source = process::root().join(PEERS).join(file);
        fs::copy(&source, folder.join(file)).with_context(|| format!("{}: cannot be copied", source.display()))?;
    }
    let scenarios = folder.join("scenarios.json");
    process::run(report().args(args).arg("--write-scenarios").arg(&scenarios))?;
    process::run(Command::new("npm").args(["install", "--no-audit", "--no-fund"]).current_dir(&folder))?;
    let fits = folder.join("fits");
    process::run(Command::new("node").arg("fit.mjs").arg(&scenarios).arg(&fits).current_dir(&folder))?;
    Ok(fits)
}

/// Measures times with `shadowfit-bench`.
fn times(results: &Path) -> Result<()> {
    let bench = |command: &str| {
        let mut bench = process::cargo("run");
        bench.args(["--release", "--package", "shadowfit-bench", "--", command]);
        process::with_runtime_folder(&mut bench);
        bench
    };
    process::run(&mut bench("core"))?;
    process::run(bench("gpu").arg("--out").arg(results.join("gpu.md")))?;
    process::run(bench("growth").arg("--out").arg(results.join("growth.md")).arg("--pictures").arg(results))
}

/// Copies the tables into the docs.
fn write(results: &Path) -> Result<()> {
    let docs = process::root().join(DOCS);
    for file in ["figures.md", "figures.csv"] {
        fs::copy(results.join(file), docs.join(file)).with_context(|| format!("{file}: cannot be copied"))?;
    }
    for (page, table) in PAGES {
        let table = fs::read_to_string(results.join(table)).with_context(|| table)?;
        let file = process::root().join(page);
        let text = fs::read_to_string(&file).with_context(|| format!("{page}: cannot be read"))?;
        fs::write(&file, replaced(&text, &table).with_context(|| page)?)
            .with_context(|| format!("{page}: cannot be written"))?;
    }
    Ok(())
}

/// Replaces the text between the marks.
fn replaced(page: &str, table: &str) -> Result<String> {
    let [begin, end] = MARKS;
    ensure!(page.matches(begin).count() == 1, "it has not one {begin}");
    let (before, rest) = page.split_once(begin).context("no mark")?;
    let (_, after) = rest.split_once(end).with_context(|| format!("it has no {end}"))?;
    Ok(format!("{before}{begin}\n\n{}\n\n{end}{after}", table.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_replaced_between_their_marks_alone() {
        let page = "a\n<!-- figures: begin -->\nold\n<!-- figures: end -->\nb\n";
        let wanted = "a\n<!-- figures: begin -->\n\n| new |\n\n<!-- figures: end -->\nb\n";
        assert_eq!(replaced(page, "| new |\n").expect("a page with marks"), wanted);
        assert!(replaced("no marks", "").is_err());
        assert!(replaced(&page.repeat(2), "").is_err());
    }

    #[test]
    fn the_pages_have_marks_and_the_figures_of_the_docs() {
        let read = |file: &str| fs::read_to_string(process::root().join(file)).expect("a file of the docs");
        let cells = |row: &str| row.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let known: Vec<Vec<String>> = read("docs/figures/figures.md").lines().map(cells).collect();
        for (page, _) in PAGES {
            let text = read(page);
            let shown = text.split(MARKS[0]).nth(1).and_then(|rest| rest.split(MARKS[1]).next()).expect("marks");
            let rows: Vec<&str> = shown.lines().filter(|line| line.starts_with('|')).collect();
            assert!(rows.len() > 8, "{page}");
            for row in rows {
                let row = cells(row);
                let is_part = |known: &Vec<String>| row.iter().all(|cell| known.contains(cell));
                assert!(known.iter().any(is_part), "{page}: {row:?}");
            }
        }
    }
}

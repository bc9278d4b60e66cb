//! `shadowfit-bench core`: runs the benches of the core crate, and prints their times as a table.
//!
//! Times from different machines are not comparable. Ratios of one run are, so every group with a
//! hand-written counterpart shows them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use shadowfit_study::print;

use crate::page::{self, Section};

/// Prefix of a counterpart's name in its group.
const COUNTERPART: &str = "by hand";

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write the table to docs/figures/core.md
    #[arg(long)]
    page: bool,
    /// Arguments of the benches, for example part of a name or `--quick`
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "ARGUMENT")]
    benches: Vec<String>,
}

/// Criterion's description of a benchmark.
#[derive(Deserialize)]
struct Benchmark {
    group_id: String,
    function_id: Option<String>,
    value_str: Option<String>,
}

#[derive(Deserialize)]
struct Estimates {
    median: Estimate,
}

#[derive(Deserialize)]
struct Estimate {
    point_estimate: f64,
}

/// A measured benchmark.
struct Measured {
    name: String,
    value: Option<String>,
    nanoseconds: f64,
}

/// Runs the benches and prints the table.
pub(crate) fn run(args: &Args) -> Result<()> {
    let folder = page::root().join("target/criterion");
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("{}: cannot be emptied", folder.display()))?;
    }
    let mut benches = Command::new(env!("CARGO"));
    benches.args(["bench", "-p", "shadowfit", "--benches", "--"]).args(&args.benches).current_dir(page::root());
    ensure!(benches.status().context("cargo does not start")?.success(), "the benches fail");
    let mut groups = BTreeMap::new();
    collect(&folder, &mut groups)?;
    ensure!(!groups.is_empty(), "{}: no measurement was found", folder.display());
    let table = table(&groups);
    print(&table)?;
    if args.page { Section::Core.publish(&table) } else { Ok(()) }
}

/// Reads all measurements under a folder, by group.
fn collect(folder: &Path, groups: &mut BTreeMap<String, Vec<Measured>>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("{}: cannot be read", folder.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, groups)?;
        } else if path.ends_with("new/benchmark.json") {
            let Benchmark { group_id, function_id, value_str } = read(&path)?;
            let estimates: Estimates = read(&path.with_file_name("estimates.json"))?;
            let name = function_id.unwrap_or_default();
            let measured = Measured { name, value: value_str, nanoseconds: estimates.median.point_estimate };
            groups.entry(group_id).or_default().push(measured);
        }
    }
    Ok(())
}

fn read<T: for<'a> Deserialize<'a>>(path: &Path) -> Result<T> {
    let text = fs::read_to_string(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{}: is not a file of criterion", path.display()))
}

/// Returns all groups as a table, each case with its ratio to the counterpart's time.
fn table(groups: &BTreeMap<String, Vec<Measured>>) -> String {
    let mut out = String::from("| what | how | time | of the counterpart's |\n|---|---|---:|---:|\n");
    for (group, cases) in groups {
        let mut cases: Vec<&Measured> = cases.iter().collect();
        let size = |case: &Measured| case.value.as_ref().and_then(|value| value.parse::<u64>().ok());
        cases.sort_by(|a, b| size(a).cmp(&size(b)).then_with(|| a.name.cmp(&b.name)));
        for case in &cases {
            let counterpart =
                cases.iter().find(|other| other.value == case.value && other.name.starts_with(COUNTERPART));
            let ratio =
                counterpart.map_or(String::new(), |other| format!("{:.2}", case.nanoseconds / other.nanoseconds));
            let what = case.value.as_ref().map_or(group.clone(), |value| format!("{group}, {value}"));
            let _ = writeln!(out, "| {what} | {} | {} | {ratio} |", case.name, readable(case.nanoseconds));
        }
    }
    out
}

/// Returns a time with three digits.
fn readable(nanoseconds: f64) -> String {
    let (value, unit) = match nanoseconds {
        t if t < 1e3 => (t, "ns"),
        t if t < 1e6 => (t / 1e3, "µs"),
        t => (t / 1e6, "ms"),
    };
    let decimals = if value < 10.0 { 2 } else { usize::from(value < 100.0) };
    format!("{value:.decimals$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_those_of_the_same_size() {
        let case = |name: &str, value: &str, nanoseconds| Measured {
            name: name.to_owned(),
            value: Some(value.to_owned()),
            nanoseconds,
        };
        let cases = vec![case("ours", "10", 50.0), case("by hand", "10", 200.0), case("ours", "9", 1234.0)];
        let table = table(&BTreeMap::from([("group".to_owned(), cases)]));
        assert!(table.contains("| group, 10 | ours | 50.0 ns | 0.25 |"), "{table}");
        assert!(table.contains("| group, 9 | ours | 1.23 µs |  |"), "{table}");
    }
}

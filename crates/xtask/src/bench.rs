//! `cargo xtask bench`: measures the core crate, with `--gpu` what shadows cost on a GPU, and with `--growth` how costs
//! grow with the world, and publishes times and ratios in docs/BENCHMARKS.md.
//!
//! Times mean little on another machine; ratios of one run do, so every group that has a hand-written counterpart
//! shows them.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::Deserialize;

use crate::process;

/// Where the tables of the core, of the GPU and of growth stand in the page; what lies between is replaced.
const CORE: [&str; 2] = ["<!-- measured: begin -->", "<!-- measured: end -->"];
const GPU: [&str; 2] = ["<!-- measured on a GPU: begin -->", "<!-- measured on a GPU: end -->"];
const GROWTH: [&str; 2] = ["<!-- measured growth: begin -->", "<!-- measured growth: end -->"];
/// Chooses the GPU's tables, and takes them from a file that the example `gpu_cost` wrote on another machine.
const ON_GPU: &str = "--gpu";
const FROM: &str = "--from";
/// Chooses the tables of growth, whose curves go into this folder.
const ON_GROWTH: &str = "--growth";
const CURVES: &str = "docs/images/benchmarks";
/// How the counterpart of a group is called, at the beginning of its name.
const COUNTERPART: &str = "by hand";

/// What criterion writes of a benchmark.
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

/// Measures and writes the page.
pub(crate) fn bench(args: &[String]) -> Result<()> {
    match args.split_first() {
        Some((first, args)) if first == ON_GPU => bench_gpu(args),
        Some((first, args)) if first == ON_GROWTH => bench_growth(args),
        _ => bench_core(args),
    }
}

/// Runs the example `gpu_cost` with the arguments, or takes what it wrote elsewhere.
fn bench_gpu(args: &[String]) -> Result<()> {
    match args {
        [from, file] if from == FROM => publish_file(GPU, Path::new(file)),
        _ => bench_example("gpu_cost", GPU, args),
    }
}

/// Runs the example `growth` with the arguments.
fn bench_growth(args: &[String]) -> Result<()> {
    let curves = process::root().join(CURVES).to_string_lossy().into_owned();
    bench_example("growth", GROWTH, &[&["--pictures".to_owned(), curves][..], args].concat())
}

/// Runs an example with the arguments, and publishes the tables that it writes.
fn bench_example(name: &str, marks: [&str; 2], args: &[String]) -> Result<()> {
    let written = process::root().join("target").join(name).with_extension("md");
    let example = ["--release", "--example", name, "--", "--out"];
    process::run(process::cargo("run").args(example).arg(&written).args(args))?;
    publish_file(marks, &written)
}

/// Replaces what stands between two marks of the page by what a file has.
fn publish_file(marks: [&str; 2], file: &Path) -> Result<()> {
    let tables = fs::read_to_string(file).with_context(|| format!("{}: cannot be read", file.display()))?;
    publish(marks, &format!("{}\n", tables.trim_end()))
}

fn bench_core(args: &[String]) -> Result<()> {
    let folder = process::root().join("target/criterion");
    if folder.exists() {
        fs::remove_dir_all(&folder).with_context(|| format!("{}: cannot be emptied", folder.display()))?;
    }
    process::run(process::cargo("bench").args(["-p", "shadowfit", "--benches", "--"]).args(args))?;
    let mut groups = BTreeMap::new();
    collect(&folder, &mut groups)?;
    ensure!(!groups.is_empty(), "{}: no measurement was found", folder.display());
    let table = table(&groups);
    print!("{table}");
    publish(CORE, &table)
}

/// Replaces what stands between two marks of the page.
fn publish([begin, end]: [&str; 2], table: &str) -> Result<()> {
    let page = process::root().join("docs/BENCHMARKS.md");
    let text = fs::read_to_string(&page).with_context(|| format!("{}: cannot be read", page.display()))?;
    let (before, rest) = text.split_once(begin).with_context(|| format!("{}: has no {begin}", page.display()))?;
    let (_, after) = rest.split_once(end).with_context(|| format!("{}: has no {end}", page.display()))?;
    fs::write(&page, format!("{before}{begin}\n{table}{end}{after}"))
        .with_context(|| format!("{}: cannot be written", page.display()))
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
    serde_json::from_str(&text).with_context(|| format!("{}: is not what criterion writes", path.display()))
}

/// All groups as a table, each case with its share of the counterpart's time.
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

/// A time with three digits.
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

//! `report SCENE`: compares techniques over a camera path through a scene, as tables, plots, pictures and a
//! page.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use image::RgbaImage;
use indicatif::{ProgressBar, ProgressStyle};
use shadowfit::FittedMap;
use shadowfit::Preset;
use shadowfit::settings::FilterKind;
use shadowfit_report::page::{FileWriter, Output, PATH, PictureName, heat, overlay};
use shadowfit_report::run::{Columns, FrameInfo, FramePictures, Run, TechniqueRun, telling};
use shadowfit_report::tables::to_markdown;
use shadowfit_study::{NamedTechnique, SharedTruth, ensure_judged, make_folder, print, write_whole};
use shadowfit_truth::PictureTally;

use crate::drawing::{Drawing, named_filter};
use crate::interrupt::Interrupt;
use crate::job::{Job, JobFrame, Prepared};

/// Techniques that are compared by default: the XNA sample's, this project's stable and sharp cascades, and
/// the recommended one.
const DEFAULT_TECHNIQUES: [&str; 4] = ["xna-1", "stable-4", "histogram-4", Preset::RECOMMENDED];

#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    job: Job,
    /// Technique, by name or as a TOML file; repeatable [default: xna-1, stable-4, histogram-4, windows-4]
    #[arg(long = "technique", alias = "config", value_name = "NAME|FILE.toml")]
    techniques: Vec<String>,
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = named_filter,
        conflicts_with = "filter",
        help = "Compare filters: every technique once with each of them, and with the bias that it needs"
    )]
    filters: Vec<(String, FilterKind)>,
    /// Measure every Nth frame of the path: faster, but underestimates the benefit of maps held from frame to
    /// frame
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    every: u32,
    /// Width and height of all maps, in texels [default: the techniques' own]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(256..=8192))]
    resolution: Option<u32>,
    /// Frame that is drawn with every technique, such as `path/3`; repeatable [default: the worst, a middling
    /// and the best one]
    #[arg(long = "picture", value_name = "FRAME")]
    pictures: Vec<String>,
    /// Folder for the report
    #[arg(short, value_name = "DIR")]
    out: PathBuf,
}

/// The measurements of one technique so far.
#[derive(Default)]
struct Measured {
    tallies: Vec<PictureTally>,
    maps: Vec<Vec<FittedMap>>,
}

/// Measures and writes the report, and prints its folder. Returns whether all frames were measured.
pub(crate) fn run(args: &Args, interrupt: &Interrupt) -> Result<bool> {
    let techniques = techniques(args)?;
    let mut job = args.job.prepare()?;
    job.frames = every(&job.frames, args.every);
    for technique in &techniques {
        job.comparison.add(technique.clone())?;
    }
    let asked = frames_named(&args.pictures, &job.frames)?;
    // Fail before measuring if the path cannot be written: otherwise hours of measurements would be lost.
    let path = job.path.to_text(Path::new(PATH))?;
    // Write nothing before all input has been read.
    let output = Output::create(&args.out, FileWriter { make_folder, write: write_whole })?;
    let mut measured: Vec<Measured> = techniques.iter().map(|_| Measured::default()).collect();
    let progress = ProgressBar::new(job.frames.len() as u64);
    progress.set_style(ProgressStyle::with_template("{msg:16} {wide_bar} {pos}/{len} frames, {eta} left")?);
    for index in 0..job.frames.len() {
        if interrupt.is_requested() {
            break;
        }
        progress.set_message(job.frames[index].name.clone());
        measure(&mut job, index, &mut measured)?;
        progress.inc(1);
    }
    progress.finish_and_clear();
    check(&techniques, &measured, interrupt)?;
    let mut run = report(args, &job, &techniques, &measured);
    // Write the tables first: pictures take a while, and the disk may be full.
    output.write_report(&run, Some(&path))?;
    let drawn = if asked.is_empty() {
        telling(&run, 0..run.frames.len()).into_iter().map(|(frame, _)| frame).collect()
    } else {
        asked
    };
    draw_pictures(&mut job, &measured, &output, &mut run, &drawn)?;
    output.write_report(&run, Some(&path))?;
    let folder = args.out.display();
    let tables = to_markdown(&run);
    print(format_args!("{tables}\n{folder}: index.html, report.md, report.json, pictures and plots\n"))?;
    Ok(run.finished)
}

fn techniques(args: &Args) -> Result<Vec<NamedTechnique>> {
    let names: Vec<&str> = if args.techniques.is_empty() {
        DEFAULT_TECHNIQUES.to_vec()
    } else {
        args.techniques.iter().map(String::as_str).collect()
    };
    let drawing = &args.job.drawing;
    let mut techniques = Vec::new();
    for name in names {
        let found = NamedTechnique::find(name)?;
        for named in with_filters(&found, &args.filters, drawing)? {
            let technique = drawing.changed(named)?;
            techniques.push(match args.resolution {
                Some(texels) => technique.with_resolution(texels),
                None => technique,
            });
        }
    }
    Ok(techniques)
}

/// Returns every `step`-th frame of each group, from its first frame.
fn every(frames: &[JobFrame], step: u32) -> Vec<JobFrame> {
    let mut place = 0_u32;
    let is_taken = |frame: &&JobFrame| {
        place = if frame.view.is_first { 0 } else { place + 1 };
        place.is_multiple_of(step)
    };
    frames.iter().filter(is_taken).cloned().collect()
}

/// Returns the technique with each of the filters, whose names are appended to its name, or unchanged if
/// there are none.
fn with_filters(
    named: &NamedTechnique,
    filters: &[(String, FilterKind)],
    drawing: &Drawing,
) -> Result<Vec<NamedTechnique>> {
    if filters.is_empty() {
        return Ok(vec![named.clone()]);
    }
    let with_filter = |(filter_name, filter): &(String, FilterKind)| {
        let technique = named.technique.with_look_up(*filter, drawing.bias(*filter)?);
        let name = format!("{} {filter_name}", named.name);
        Ok(NamedTechnique { name, technique, ..named.clone() })
    };
    filters.iter().map(with_filter).collect()
}

/// Returns an error if no pixel was judged. An interrupted run may have no pictures.
fn check(techniques: &[NamedTechnique], measured: &[Measured], interrupt: &Interrupt) -> Result<()> {
    for (technique, measured) in techniques.iter().zip(measured) {
        if !(interrupt.is_requested() && measured.tallies.is_empty()) {
            ensure_judged(&pool(&measured.tallies)).with_context(|| format!("technique {}", technique.name))?;
        }
    }
    Ok(())
}

fn pose(job: &mut Prepared, index: usize) {
    if let Some(seconds) = job.frames[index].seconds {
        job.comparison.set_time(0, seconds);
    }
}

fn measure(job: &mut Prepared, index: usize, measured: &mut [Measured]) -> Result<()> {
    pose(job, index);
    let JobFrame { name, view, .. } = &job.frames[index];
    let outcomes = job.comparison.frame(view, &mut SharedTruth::default()).with_context(|| format!("frame {name}"))?;
    for (measured, outcome) in measured.iter_mut().zip(outcomes) {
        measured.tallies.push(outcome.judged.tally);
        measured.maps.push(outcome.maps);
    }
    Ok(())
}

/// Returns the run without its pictures.
fn report(args: &Args, job: &Prepared, techniques: &[NamedTechnique], measured: &[Measured]) -> Run {
    let done = measured.first().map_or(0, |measured| measured.tallies.len());
    let frames = &job.frames[..done];
    let of_technique = |(technique, measured): (&NamedTechnique, &Measured)| TechniqueRun {
        name: technique.name.clone(),
        what: technique.description(),
        settings: technique.to_toml().unwrap_or_else(|error| format!("# cannot be written: {error}")),
        overall: columns(&measured.tallies),
        groups: groups(frames)
            .into_iter()
            .map(|group| {
                let own = frames.iter().zip(&measured.tallies).filter(|(frame, _)| frame.group == group);
                let columns = columns(own.map(|(_, tally)| tally));
                (group, columns)
            })
            .collect(),
        frames: measured.tallies.iter().map(|tally| columns([tally])).collect(),
        pictures: Vec::new(),
    };
    Run {
        title: format!("Shadows of {}", args.job.title()),
        scene: args.job.title(),
        triangles: job.comparison.scene().casting_triangles(),
        size: job.judging.size,
        adapter: job.comparison.gpu().name(),
        light: Some(job.light),
        notes: job.notes.clone(),
        scene_notes: job.scene_notes.clone(),
        frames: frames.iter().map(|frame| FrameInfo { name: frame.name.clone(), group: frame.group.clone() }).collect(),
        techniques: techniques.iter().zip(measured).map(of_technique).collect(),
        finished: done == job.frames.len(),
    }
}

/// Returns the names of the groups, in order.
fn groups(frames: &[JobFrame]) -> Vec<String> {
    let mut groups: Vec<String> = Vec::new();
    for frame in frames {
        if !groups.contains(&frame.group) {
            groups.push(frame.group.clone());
        }
    }
    groups
}

pub(crate) fn pool<'a>(tallies: impl IntoIterator<Item = &'a PictureTally>) -> PictureTally {
    let mut pool = PictureTally::default();
    for tally in tallies {
        pool.merge(tally);
    }
    pool
}

pub(crate) fn columns<'a>(tallies: impl IntoIterator<Item = &'a PictureTally>) -> Columns {
    pool(tallies).columns().into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Draws some frames with every technique, from the maps of the measurement.
fn draw_pictures(
    job: &mut Prepared,
    measured: &[Measured],
    output: &Output,
    run: &mut Run,
    frames: &[usize],
) -> Result<()> {
    // An interrupted run may have fewer frames.
    for &index in frames.iter().filter(|index| **index < run.frames.len()) {
        pose(job, index);
        let frame = job.frames[index].clone();
        let mut truth = SharedTruth::default();
        for (number, technique) in run.techniques.iter_mut().enumerate() {
            let maps = &measured[number].maps[index];
            let (pixels, judged) = job.comparison.picture(number, &frame.view, maps, &mut truth)?;
            let [width, height] = job.judging.size;
            let picture = RgbaImage::from_raw(width, height, pixels).context("a picture of another size")?;
            let name = PictureName { place: number, technique: &technique.name, frame: &frame.name, kind: "picture" };
            let write = |kind, picture: &RgbaImage| output.write_picture(&PictureName { kind, ..name }, picture);
            let pictures = FramePictures {
                frame: index,
                overlay: write("overlay", &overlay(&picture, &judged.classes)?)?,
                heat: write("heat", &heat(job.judging.size, &judged.pixels_per_texel)?)?,
                picture: write("picture", &picture)?,
            };
            technique.pictures.push(pictures);
        }
    }
    Ok(())
}

/// Returns the indices of frames in the path, by their names.
fn frames_named(names: &[String], frames: &[JobFrame]) -> Result<Vec<usize>> {
    let place = |name: &String| {
        let place = frames.iter().position(|frame| frame.name == *name);
        place.with_context(|| match (frames.first(), frames.last()) {
            (Some(first), Some(last)) => {
                format!("--picture {name}: the path has no such frame, only {} to {}", first.name, last.name)
            }
            _ => format!("--picture {name}: the path has no frames"),
        })
    };
    names.iter().map(place).collect()
}

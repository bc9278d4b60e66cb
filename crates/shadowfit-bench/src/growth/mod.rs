//! `shadowfit-bench growth`: growth of costs with the world: fits, culling and frames of `SunShadows` in a
//! town with a growing number of boxes.
//!
//! Times are of one CPU core. Some parts need a graphics device, but draw nothing, so a software adapter
//! suffices. A time is the shortest of several rounds, which reduces the influence of other work on the
//! machine.

mod culling;
mod fits;
mod frames;
mod picture;
mod town;

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use shadowfit_adapter::AdapterOptions;
use shadowfit_study::{check_place, make_folder, print, write_whole};

use self::picture::Picture;
use crate::open;
use crate::page::{self, Section};
use crate::table::Table;

/// Folder of the pictures, relative to the page that shows them.
const PICTURES: &str = "../images/benchmarks";

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write the tables to docs/figures/growth.md, and the curves beside it
    #[arg(long)]
    page: bool,
    /// Markdown file for the tables
    #[arg(long)]
    out: Option<PathBuf>,
    /// Folder for the curves, as SVG
    #[arg(long)]
    pictures: Option<PathBuf>,
    /// Run a few frames of small worlds, to check that everything works
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    adapter: AdapterOptions,
    /// Only these parts
    #[arg(long, value_enum, num_args = 1..)]
    only: Vec<Part>,
}

/// Part of the benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Fits of four techniques
    Fits,
    /// Culling against four maps
    Culling,
    /// Frames of `SunShadows`, by the number of casters and by the share that moves
    Frames,
    /// Frames of `SunShadows`, by the number of maps and by their sides
    Maps,
}

impl Part {
    /// Returns whether the part needs a graphics device, which owns the maps.
    fn takes_device(self) -> bool {
        matches!(self, Self::Frames | Self::Maps)
    }

    fn measure(self, extent: &Extent) -> Result<Found> {
        match self {
            Self::Fits => fits::measure(extent),
            Self::Culling => culling::measure(extent),
            Self::Frames => frames::measure(extent),
            Self::Maps => frames::measure_maps(extent),
        }
    }
}

/// Extent of the measurements.
struct Extent {
    /// Frames of a walk that count.
    frames: usize,
    /// Repetitions of each walk.
    rounds: usize,
    /// Largest world, in boxes.
    largest: usize,
    /// Adapter of the device that owns the maps. The device draws nothing.
    adapter: AdapterOptions,
}

impl Extent {
    fn new(is_quick: bool, adapter: AdapterOptions) -> Self {
        if is_quick {
            return Self { frames: 3, rounds: 1, largest: 1_000, adapter };
        }
        Self { frames: 40, rounds: 3, largest: 1_000_000, adapter }
    }

    /// Returns the numbers of boxes, each ten times the previous one.
    fn sizes(&self) -> impl Iterator<Item = usize> {
        let largest = self.largest;
        (2..).map(|power| 10_usize.pow(power)).take_while(move |size| *size <= largest)
    }
}

/// Result of a part.
struct Found {
    table: Table,
    pictures: Vec<Picture>,
}

/// Measures, then prints and writes the tables and curves.
pub(crate) fn run(args: &Args) -> Result<()> {
    let extent = Extent::new(args.quick, args.adapter.clone());
    let usual = args.page.then(page::curves);
    let folder = args.pictures.as_ref().or(usual.as_ref());
    args.out.iter().try_for_each(|out| check_place(out))?;
    folder.iter().try_for_each(|folder| make_folder(folder))?;
    let wants = |part: &Part| args.only.is_empty() || args.only.contains(part);
    let parts = || Part::value_variants().iter().copied().filter(wants);
    if parts().any(Part::takes_device) {
        // Fails before any measurement if the machine does not have the adapter.
        open(&extent.adapter)?;
    }
    let mut text = String::new();
    for part in parts() {
        let Found { table, pictures } = part.measure(&extent)?;
        print(format!("{table}\n"))?;
        let _ = writeln!(text, "{table}");
        for picture in &pictures {
            let _ = writeln!(text, "![{}]({PICTURES}/{}.svg)\n", picture.title, picture.file);
            folder.iter().try_for_each(|folder| picture.write(folder))?;
        }
    }
    args.out.iter().try_for_each(|out| write_whole(out, text.as_bytes()))?;
    if args.page { Section::Growth.publish(&text) } else { Ok(()) }
}

//! `shadowfit-bench growth`: how costs grow with the world: fits, culling and frames of `SunShadows` in a town of more and
//! more boxes.
//!
//! Times are of one core and of the CPU alone. Where a graphics device is needed nothing is drawn with it, and a software
//! adapter will do. A time is the shortest of some rounds, so that other work on the machine counts little.

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

/// Where pictures lie, seen from the page that shows them.
const PICTURES: &str = "images/benchmarks";

#[derive(clap::Args)]
pub(crate) struct Args {
    /// Replace the tables in docs/BENCHMARKS.md, and write the curves beside it
    #[arg(long)]
    page: bool,
    /// Where the tables are written, as Markdown
    #[arg(long)]
    out: Option<PathBuf>,
    /// Folder that the curves are written into, as SVG
    #[arg(long)]
    pictures: Option<PathBuf>,
    /// A few frames of small worlds, to see that all of it works
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    adapter: AdapterOptions,
    /// Only these parts
    #[arg(long, value_enum, num_args = 1..)]
    only: Vec<Part>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Fits of four techniques
    Fits,
    /// Culling against four maps
    Culling,
    /// Frames of `SunShadows`, by the number of casters and by what moves
    Frames,
    /// The same by the number of maps and by their sides
    Maps,
}

impl Part {
    /// Whether the part takes a graphics device, which owns the maps.
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

/// How much is measured.
struct Extent {
    /// Frames of a walk that count.
    frames: usize,
    /// Times that each walk is repeated.
    rounds: usize,
    /// Largest world, in boxes.
    largest: usize,
    /// The device that owns the maps. Nothing is drawn with it.
    adapter: AdapterOptions,
}

impl Extent {
    fn new(is_quick: bool, adapter: AdapterOptions) -> Self {
        if is_quick {
            return Self { frames: 3, rounds: 1, largest: 1_000, adapter };
        }
        Self { frames: 40, rounds: 3, largest: 1_000_000, adapter }
    }

    /// Numbers of boxes, a tenth of each other.
    fn sizes(&self) -> impl Iterator<Item = usize> {
        let largest = self.largest;
        (2..).map(|power| 10_usize.pow(power)).take_while(move |size| *size <= largest)
    }
}

/// What a part found.
struct Found {
    table: Table,
    pictures: Vec<Picture>,
}

/// Measures, and prints and writes the tables and curves.
pub(crate) fn run(args: &Args) -> Result<()> {
    let extent = Extent::new(args.quick, args.adapter.clone());
    let usual = args.page.then(page::curves);
    let folder = args.pictures.as_ref().or(usual.as_ref());
    args.out.iter().try_for_each(|out| check_place(out))?;
    folder.iter().try_for_each(|folder| make_folder(folder))?;
    let wants = |part: &Part| args.only.is_empty() || args.only.contains(part);
    let parts = || Part::value_variants().iter().copied().filter(wants);
    if parts().any(Part::takes_device) {
        // A machine without the adapter is refused before anything is measured.
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

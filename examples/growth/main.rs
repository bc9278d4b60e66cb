//! How costs grow with the world: fits, culling and frames of `SunShadows`, from a hundred boxes to a million.
//!
//! ```sh
//! cargo run --release --example growth                                   # tables
//! cargo run --release --example growth -- --only fits --pictures out     # a part, with its curves
//! cargo xtask bench --growth                                             # all of it, into docs/BENCHMARKS.md
//! ```
//!
//! Times are of one core and of the CPU alone: where a graphics device is needed nothing is drawn with it, and a
//! software adapter will do. A time is the shortest of some rounds, so that other work on the machine counts little.

#[path = "../shared/adapter.rs"]
mod adapter;
#[path = "../shared/cuboid.rs"]
mod cuboid;
mod culling;
mod fits;
mod frames;
mod picture;
#[path = "../shared/table.rs"]
mod table;
mod times;
mod town;

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::Result;
use clap::{Parser, ValueEnum};
use shadowfit_adapter::AdapterOptions;
use shadowfit_study::{check_place, make_folder, write_whole};

use picture::Picture;
use table::Table;

/// Where pictures lie, seen from the page that shows them.
const PICTURES: &str = "images/benchmarks";

#[derive(Parser)]
#[command(about = "Times how costs grow with the world")]
struct Args {
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

fn main() -> Result<()> {
    let args = Args::parse();
    let extent = Extent::new(args.quick, args.adapter);
    args.out.iter().try_for_each(|out| check_place(out))?;
    args.pictures.iter().try_for_each(|folder| make_folder(folder))?;
    let wants = |part: &Part| args.only.is_empty() || args.only.contains(part);
    let parts = || Part::value_variants().iter().copied().filter(wants);
    if parts().any(Part::takes_device) {
        // A machine without the adapter is refused before anything is measured.
        adapter::open(&extent.adapter);
    }
    let mut text = String::new();
    for part in parts() {
        let Found { table, pictures } = part.measure(&extent)?;
        println!("{table}");
        let _ = writeln!(text, "{table}");
        for picture in &pictures {
            let _ = writeln!(text, "![{}]({PICTURES}/{}.svg)\n", picture.title, picture.file);
            if let Some(folder) = &args.pictures {
                picture.write(folder)?;
            }
        }
    }
    if let Some(out) = &args.out {
        write_whole(out, text.as_bytes())?;
    }
    Ok(())
}

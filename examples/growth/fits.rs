//! Fits of a town of more and more boxes.

use anyhow::{Context, Result};
use shadowfit::{Boxes, FitInput, Seen, ShadowFitter, Technique};

use crate::picture::{Curve, Picture};
use crate::table::{Table, ms};
use crate::times::{LEAD, Times, timed};
use crate::town::Town;
use crate::{Extent, Found};

/// A technique, and whether it is told what the frame before showed.
struct Way {
    name: &'static str,
    preset: &'static str,
    is_told: bool,
}

const WAYS: [Way; 4] = [
    Way { name: "windows-4, told what was seen", preset: "windows-4", is_told: true },
    Way { name: "windows-4, from the boxes", preset: "windows-4", is_told: false },
    Way { name: "calm-4, told what was seen", preset: "calm-4", is_told: true },
    Way { name: "stable-4", preset: "stable-4", is_told: false },
];

/// Times of fits along the walk.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let mut rows = Vec::new();
    let mut curves: Vec<Curve> = WAYS.iter().map(|way| Curve::new(way.name)).collect();
    for count in extent.sizes() {
        let town = Town::new(count);
        let seen = town.seen(extent.frames, &Technique::default())?;
        for (way, curve) in WAYS.iter().zip(&mut curves) {
            let times = walk(&town, way, &seen, extent)?;
            eprintln!("fits, {count} boxes, {}: {}", way.name, ms(times.median()));
            curve.add(count, times.median());
            rows.push(row(&format!("{count}, {}", way.name), &times));
        }
    }
    let columns = ["boxes, fit", "first frame", "median", "worst", "worst of median"];
    Ok(Found {
        table: Table { title: "Fits", note: "".to_owned(), columns: columns.map(str::to_owned).to_vec(), rows },
        pictures: vec![Picture {
            file: "fits",
            title: "A fit of four maps to a town",
            axes: ["boxes", "ms, median"],
            curves,
        }],
    })
}

fn row(name: &str, times: &Times) -> Vec<String> {
    let worst = format!("{:.1}", times.worst() / times.median());
    vec![name.to_owned(), ms(times.first()), ms(times.median()), ms(times.worst()), worst]
}

/// Times of the fits along the walk.
fn walk(town: &Town, way: &Way, seen: &[Seen], extent: &Extent) -> Result<Times> {
    let technique = Technique::preset(way.preset).context("no such preset")?;
    let boxes = Boxes::world(&town.boxes);
    let mut times = Times::default();
    for _ in 0..extent.rounds {
        let mut fitter = ShadowFitter::new(&technique);
        let mut round = Vec::new();
        for frame in 0..LEAD + extent.frames {
            if let Some(seen) = frame.checked_sub(1).and_then(|before| seen.get(before)).filter(|_| way.is_told) {
                fitter.see(seen.clone());
            }
            let views = [Town::camera(frame).frustum()?];
            let input =
                FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, Town::direction()) };
            let (fitted, time) = timed(|| fitter.fit(&input).map(|_| ()));
            fitted?;
            round.push(time);
        }
        times.add(&round);
    }
    Ok(times)
}

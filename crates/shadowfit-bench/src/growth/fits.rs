//! Fits of a town with a growing number of boxes.

use anyhow::{Context, Result};
use shadowfit::{Boxes, ShadowFitter, StaticBoxes, Technique, VisibleDemand};
use shadowfit_study::tell;

use super::picture::{Curve, Picture, grouped};
use super::town::{Town, World};
use super::{Extent, Found};
use crate::table::{Table, ms, share};
use crate::times::{LEAD, Times, timed};

/// A technique, and whether it receives the visible demand of the previous frame.
struct Way {
    name: &'static str,
    preset: &'static str,
    is_told: bool,
}

const WAYS: [Way; 4] = [
    Way { name: "windows-4, seen", preset: "windows-4", is_told: true },
    Way { name: "windows-4, from boxes", preset: "windows-4", is_told: false },
    Way { name: "calm-4, seen", preset: "calm-4", is_told: true },
    Way { name: "stable-4", preset: "stable-4", is_told: false },
];

const NOTE: &str = "From a list of boxes (`FitInput::receivers` and `casters`) and from a hierarchy \
    (`FitInput::static_boxes`). *VisibleDemand* fits receive the visible demand of the previous frame, the others \
    estimate it from the boxes. Worst frames are medians, too.";

const COLUMNS: [&str; 8] =
    ["boxes, fit", "list: first", "median", "worst", "hierarchy: first", "median", "worst", "median, of the list's"];

/// Measures fits along the walk, from a list of boxes and from a hierarchy.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let mut rows = Vec::new();
    let of_list = |(place, way): (usize, &Way)| Curve::thin(format!("{}, list", way.name), place);
    let of_tree = |(place, way): (usize, &Way)| Curve::new(format!("{}, hierarchy", way.name), place);
    let mut list_curves: Vec<Curve> = WAYS.iter().enumerate().map(of_list).collect();
    let mut tree_curves: Vec<Curve> = WAYS.iter().enumerate().map(of_tree).collect();
    for count in extent.sizes() {
        let town = Town::new(count);
        let boxes = Boxes::world(&town.boxes);
        let tree = StaticBoxes::from_boxes(boxes)?;
        let seen = town.seen(extent.frames, &Technique::default())?;
        for (way, curves) in WAYS.iter().zip(list_curves.iter_mut().zip(&mut tree_curves)) {
            let list = walk(World::List(boxes), way, &seen, extent)?;
            let tree = walk(World::Tree(&tree), way, &seen, extent)?;
            tell(format_args!("fits, {count} boxes, {}: {}, {}", way.name, ms(list.median()), ms(tree.median())));
            curves.0.add(count, list.median());
            curves.1.add(count, tree.median());
            let name = vec![format!("{}, {}", grouped(count), way.name)];
            rows.push([name, cells(&list), cells(&tree), vec![share(tree.median(), list.median())]].concat());
        }
    }
    Ok(Found {
        table: Table { title: "Fits", note: NOTE.to_owned(), columns: COLUMNS.map(str::to_owned).to_vec(), rows },
        pictures: vec![Picture {
            file: "fits",
            title: "A fit of four maps",
            axes: ["boxes", "milliseconds, median"],
            curves: [list_curves, tree_curves].concat(),
        }],
    })
}

fn cells(times: &Times) -> Vec<String> {
    let worst = format!("{} ({:.1} ×)", ms(times.worst()), times.worst() / times.median());
    vec![ms(times.first()), ms(times.median()), worst]
}

/// Returns the times of the fits along the walk.
fn walk(world: World<'_>, way: &Way, seen: &[VisibleDemand], extent: &Extent) -> Result<Times> {
    let technique = Technique::preset(way.preset).context("no such preset")?;
    let mut times = Times::default();
    for _ in 0..extent.rounds {
        let mut fitter = ShadowFitter::new(&technique);
        let mut round = Vec::new();
        for frame in 0..LEAD + extent.frames {
            if let Some(seen) = frame.checked_sub(1).and_then(|before| seen.get(before)).filter(|_| way.is_told) {
                fitter.set_visible_demand(seen.clone());
            }
            let views = [Town::camera(frame).frustum()?];
            let input = world.input(&views);
            let (fitted, time) = timed(|| fitter.fit(&input).map(|_| ()));
            fitted?;
            round.push(time);
        }
        times.add(&round);
    }
    Ok(times)
}

//! Culling of growing numbers of boxes against the volumes of four maps.

use std::hint::black_box;

use anyhow::Result;
use glam::DVec3;
use shadowfit::culling::cull;
use shadowfit::{Aabb, Boxes, CasterVolume, ShadowFitter, StaticBoxes, Technique};
use shadowfit_study::tell;

use super::picture::{Curve, Picture, grouped};
use super::town::{Town, World};
use super::{Extent, Found};
use crate::table::{Table, ms, share};
use crate::times::{shortest, timed};

/// Greatest number of boxes that are moved.
const MOVED: usize = 1_000;

/// Repetitions of a call. The shortest time counts.
const CALLS: usize = 20;

const NOTE: &str = "Against the caster volumes of `windows-4`, all four at once: `culling::cull` over a list, \
    `StaticBoxes::cull` in a hierarchy.";

const COLUMNS: [&str; 7] = ["boxes", "in a map", "list", "hierarchy", "of the list", "hierarchy made", "a box moved"];

/// Measures a list and a hierarchy.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let mut rows = Vec::new();
    let mut curves = [Curve::thin("list", 0), Curve::new("hierarchy", 1)];
    for count in extent.sizes() {
        let town = Town::new(count);
        let boxes = Boxes::world(&town.boxes);
        let volumes = volumes(&town)?;
        let mut masks = vec![0; count];
        let list = shortest(CALLS, || {
            cull(black_box(&volumes), DVec3::ZERO, black_box(&town.boxes), black_box(&mut masks));
            Ok(())
        })?;
        let (tree, made) = timed(|| StaticBoxes::from_boxes(boxes));
        let mut tree = tree?;
        let mut drawn = Vec::new();
        let in_tree = shortest(CALLS, || {
            drawn.clear();
            black_box(&tree).cull(black_box(&volumes), |number, mask| drawn.push((number, mask)));
            Ok(())
        })?;
        let moved = move_each(&mut tree, &town)?;
        tell(format_args!("culling, {count} boxes: {}, {}", ms(list), ms(in_tree)));
        curves[0].add(count, list);
        curves[1].add(count, in_tree);
        let cells = [ms(list), ms(in_tree), share(in_tree, list), ms(made), format!("{:.2} µs", moved * 1e3)];
        rows.push([vec![grouped(count), grouped(drawn.len())], cells.to_vec()].concat());
    }
    Ok(Found {
        table: Table { title: "Culling", note: NOTE.to_owned(), columns: COLUMNS.map(str::to_owned).to_vec(), rows },
        pictures: vec![Picture {
            file: "culling",
            title: "Culling against four maps",
            axes: ["boxes", "milliseconds"],
            curves: curves.to_vec(),
        }],
    })
}

/// Moves boxes from all over the tree by a metre. Returns the time per box, in milliseconds.
fn move_each(tree: &mut StaticBoxes, town: &Town) -> Result<f64> {
    let step = town.boxes.len().div_ceil(MOVED);
    let moved: Vec<(u32, Aabb)> = (0..).zip(&town.boxes).step_by(step).map(|(i, b)| (i, *b)).collect();
    let (result, time) =
        timed(|| moved.iter().try_for_each(|(i, b)| tree.set(*i, Aabb::new(b.min + 1.0, b.max + 1.0))));
    result?;
    Ok(time / moved.len() as f64)
}

/// Returns the caster volume of each map in the walk's first frame.
fn volumes(town: &Town) -> Result<Vec<CasterVolume>> {
    let technique = Technique::default();
    let mut fitter = ShadowFitter::new(&technique);
    fitter.set_visible_demand(town.seen(1, &technique)?.remove(0));
    let views = [Town::camera(0).frustum()?];
    let maps = fitter.fit(&World::List(Boxes::world(&town.boxes)).input(&views))?;
    Ok(maps.caster_volumes(&views, &technique)?[..maps.len()].to_vec())
}

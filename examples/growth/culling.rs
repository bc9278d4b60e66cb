//! Culling of more and more boxes against the volumes of four maps.

use std::hint::black_box;

use anyhow::Result;
use glam::DVec3;
use shadowfit::culling::cull;
use shadowfit::{Boxes, CasterVolume, FitInput, ShadowFitter, Technique};

use crate::picture::{Curve, Picture};
use crate::table::{Table, ms};
use crate::times::shortest;
use crate::town::Town;
use crate::{Extent, Found};

/// Times that a call is repeated to find its shortest time.
const CALLS: usize = 20;

/// Times of a list.
pub(crate) fn measure(extent: &Extent) -> Result<Found> {
    let mut rows = Vec::new();
    let mut list_curve = Curve::new("list");
    for count in extent.sizes() {
        let town = Town::new(count);
        let volumes = volumes(&town)?;
        let mut masks = vec![0; count];
        let list = shortest(CALLS, || {
            cull(black_box(&volumes), DVec3::ZERO, black_box(&town.boxes), black_box(&mut masks));
            Ok(())
        })?;
        let held = masks.iter().filter(|mask| **mask != 0).count();
        eprintln!("culling, {count} boxes: {}", ms(list));
        list_curve.add(count, list);
        rows.push(vec![count.to_string(), held.to_string(), ms(list)]);
    }
    Ok(Found {
        table: Table {
            title: "Culling against four maps",
            note: "The volumes that hold the casters of `windows-4`, all four in one call, over a list and \
                   in a hierarchy."
                .to_owned(),
            columns: ["boxes", "in a map", "list"].map(str::to_owned).to_vec(),
            rows,
        },
        pictures: vec![Picture {
            file: "culling",
            title: "Culling a town against four maps",
            axes: ["boxes", "milliseconds"],
            curves: vec![list_curve],
        }],
    })
}

/// What holds the casters of each map in the walk's first frame.
fn volumes(town: &Town) -> Result<Vec<CasterVolume>> {
    let technique = Technique::default();
    let mut fitter = ShadowFitter::new(&technique);
    fitter.see(town.seen(1, &technique)?.remove(0));
    let (views, boxes) = ([Town::camera(0).frustum()?], Boxes::world(&town.boxes));
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, Town::direction()) };
    let maps = fitter.fit(&input)?;
    Ok(maps.caster_volumes(&views, &technique)?[..maps.len()].to_vec())
}

//! The numbers of maps with selection by coverage: windows, with and without a demand grid, cascades, and
//! single maps.

use shadowfit::demand::{CELLS, DemandGrid, DemandSpace};
use shadowfit::glam::DVec2;
use shadowfit::{FitError, FitState, Scratch, Technique};

use crate::inputs::{Scene, by_coverage, technique};
use crate::numbers::{ByKind, Numbers};
use crate::random::Random;

/// Number of frames of a camera's flight.
const FRAMES: u32 = 6;

/// Adds the numbers of this many fits. `are_windows` returns for each flight whether its maps are windows.
pub(crate) fn add(mut random: Random, fits: u32, are_windows: fn(&mut Random) -> bool, numbers: &mut ByKind) {
    let mut storage = vec![DVec2::ZERO; Scratch::required(64, 8)];
    let mut done = 0;
    while done < fits {
        // Refused input gives no number.
        done += flight(&mut random, are_windows, numbers, &mut storage).unwrap_or(0);
    }
}

/// Fits the frames of one flight through a random scene. Returns the number of fits.
fn flight(
    random: &mut Random,
    are_windows: fn(&mut Random) -> bool,
    numbers: &mut ByKind,
    storage: &mut [DVec2],
) -> Result<u32, FitError> {
    let mut scene = Scene::new(random)?;
    scene.views = vec![scene.camera.frustum()?];
    let mut settings = by_coverage(technique(random, &scene.camera));
    let mut knows_grid = true;
    let numbers = if are_windows(random) {
        settings = settings.with_maps(settings.maps.as_windows());
        knows_grid = random.pick(&[true, true, false]);
        settings = settings.with_count(1 + random.below(8));
        &mut numbers.windows
    } else if settings.maps.count() > 1 {
        &mut numbers.cascades
    } else {
        &mut numbers.single_map
    };
    let (mut fitter, mut demand) = (FitState::new(), None);
    for _ in 0..FRAMES {
        let grids: Vec<DemandGrid> = demand
            .iter()
            .filter(|_| knows_grid)
            .map(|(space, counts): &(DemandSpace, Vec<u32>)| DemandGrid { space: *space, counts })
            .collect();
        let input = shadowfit::FitInput { demand: &grids, ..scene.input() };
        let maps = fitter.fit(&input, &settings, &mut Scratch::new(storage))?;
        for map in maps.iter() {
            numbers.map(map);
        }
        if random.once_in(2) {
            demand = Some(points(random, &scene, &settings, numbers)?);
        }
        scene.advance(random)?;
    }
    Ok(FRAMES)
}

/// Returns a grid of points in view.
fn points(
    random: &mut Random,
    scene: &Scene,
    settings: &Technique,
    numbers: &mut Numbers,
) -> Result<(DemandSpace, Vec<u32>), FitError> {
    let (view, fit) = (&scene.views[0], &settings.fit);
    let space = DemandSpace::new(view, scene.direction, fit.up, fit.max_distance)?;
    numbers.f32s(&[space.texel, space.cell, space.x.x, space.y.x]);
    let mut counts = vec![0; CELLS];
    for _ in 0..200 {
        let share = random.between(0.0, 1.0);
        let [a, b, c] = [4, 5, 7].map(|i: usize| view.corners[i]);
        let far = a + (b - a) * random.between(0.0, 1.0) + (c - a) * random.between(0.0, 1.0);
        let pixel = (c - a).length() * (share / 1080.0);
        let cell = space.index(far * share, random.vector(), random.vector() * pixel, random.vector() * pixel);
        if let Some(cell) = cell {
            counts[cell] += 1 + random.below(9);
            numbers.bits(cell as u64);
        }
    }
    Ok((space, counts))
}

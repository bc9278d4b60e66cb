//! A third hash, over the numbers of several maps of a frame that are read by coverage: windows, with a grid of need
//! and without, and slices of the view.

use shadowfit::glam::DVec2;
use shadowfit::need::{CELLS, NeedGrid, NeedSpace};
use shadowfit::settings::{FitKind, MapChoice, NeedSource};
use shadowfit::{FitError, MapFitter, Technique, Workspace};

use crate::inputs::{Scene, technique};
use crate::numbers::Numbers;
use crate::random::Random;

/// Frames of a camera's flight.
const FRAMES: u32 = 6;

/// The hash over the numbers of so many fits.
pub(crate) fn hash(fits: u32) -> u64 {
    let mut random = Random::new(3);
    let (mut numbers, mut storage) = (Numbers::new(), vec![DVec2::ZERO; Workspace::required(64, 8)]);
    let mut done = 0;
    while done < fits {
        // What is refused gives no number.
        done += flight(&mut random, &mut numbers, &mut storage).unwrap_or(0);
    }
    numbers.value()
}

/// Fits the frames of one flight through a random scene; gives how many that were.
fn flight(random: &mut Random, numbers: &mut Numbers, storage: &mut [DVec2]) -> Result<u32, FitError> {
    let mut scene = Scene::new(random)?;
    scene.views = vec![scene.camera.frustum()?];
    let mut settings = Technique { choice: MapChoice::Coverage, ..technique(random, &scene.camera) };
    if !random.once_in(3) {
        settings.fit.kind = FitKind::Windows;
        settings.need = random.pick(&[NeedSource::LastFrame, NeedSource::LastFrame, NeedSource::Boxes]);
        settings.count = 1 + random.below(8);
    }
    let (mut fitter, mut need) = (MapFitter::new(), None);
    for _ in 0..FRAMES {
        let grids: Vec<NeedGrid> =
            need.iter().map(|(space, counts): &(NeedSpace, Vec<u32>)| NeedGrid { space: *space, counts }).collect();
        let input = shadowfit::FitInput { need: &grids, ..scene.input() };
        let maps = fitter.fit(&input, &settings, &mut Workspace::new(storage))?;
        for map in maps.iter() {
            numbers.map(map);
        }
        if random.once_in(2) {
            need = Some(points(random, &scene, &settings, numbers)?);
        }
        scene.advance(random)?;
    }
    Ok(FRAMES)
}

/// A grid of points in view.
fn points(
    random: &mut Random,
    scene: &Scene,
    settings: &Technique,
    numbers: &mut Numbers,
) -> Result<(NeedSpace, Vec<u32>), FitError> {
    let (view, fit) = (&scene.views[0], &settings.fit);
    let space = NeedSpace::new(view, scene.direction, fit.up, fit.max_distance)?;
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

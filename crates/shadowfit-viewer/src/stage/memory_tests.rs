//! Memory that frames take.

use shadowfit_params::tool::{ErrorMarks, ViewMode};
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_scene::builtin::default_scene;

use super::*;
use crate::monkey::memory;

/// Frames until all is there that a view is drawn with, and frames after them.
const FRAMES: [u32; 2] = [6, 20];
/// Bytes that the latter may take for all views together: what drivers and allocators keep.
const MOST: u64 = 100_000_000;

#[test]
fn a_view_that_stays_takes_no_more_memory_with_each_frame() {
    let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
    let mut stage = Stage::new(gpu, default_scene(), 1).expect("the default scene");
    stage.wait_for_rays();
    stage.settings.technique.fit.resolution = glam::UVec2::splat(256);
    let target = stage.target([96, 54]);
    let mut draw = |mode, marks, frames| {
        (stage.settings.view.mode, stage.settings.view.marks) = (mode, marks);
        for _ in 0..frames {
            stage.draw(&target);
            assert_eq!(stage.problem(), None);
            stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        }
    };
    let views = ViewMode::ALL.map(|mode| (mode, ErrorMarks::Off));
    let mut growth = 0;
    for (mode, marks) in views.into_iter().chain([(ViewMode::Final, ErrorMarks::Outline)]) {
        draw(mode, marks, FRAMES[0]);
        // A system that does not tell has nothing to be tested.
        let Some(before) = memory() else { return };
        draw(mode, marks, FRAMES[1]);
        let grown = memory().expect("memory as before").saturating_sub(before);
        println!("{mode:?} {marks:?}: {:.1} MB", grown as f64 / 1e6);
        growth += grown;
    }
    assert!(growth < MOST, "{FRAMES:?} frames of each view took {:.1} MB more", growth as f64 / 1e6);
}

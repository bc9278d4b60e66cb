//! Compares the fits that engines' own code made for the frames with our versions of them.

use std::path::Path;

use anyhow::Result;
use shadowfit_report::engines::{ENGINES, Engine};
use shadowfit_report::peers::{FitMap, Scenarios};

use super::fit_file;

/// Resolution of the fits, in texels a side.
const RESOLUTION: u32 = 2048;
/// Difference of a matrix element, relative where it exceeds 1, from which on a map counts as different: one and a half
/// texels. Engines compute in f32 and round to whole texels.
const TOLERANCE: f64 = 1.5 / 1024.0;
/// Engines that `fit.mjs` runs.
const RUN_BY_NODE: [&str; 4] = ["babylon-stable", "babylon-tight", "three-csm", "three-sunlight"];

/// Returns a sentence for each engine: how many of its maps are the same.
pub(super) fn compare(scenarios: &Scenarios, folder: &Path) -> Result<Vec<String>> {
    ENGINES.iter().filter(|engine| RUN_BY_NODE.contains(&engine.name)).map(|e| sentence(e, scenarios, folder)).collect()
}

fn sentence(engine: &Engine, scenarios: &Scenarios, folder: &Path) -> Result<String> {
    let file = fit_file(folder, engine.name)?;
    let real = file.maps_in_order(scenarios, &folder.join(engine.name))?;
    let (mut same, mut all) = (0, 0);
    for (frame, real) in scenarios.frames.iter().zip(real) {
        let ours = engine.fit(frame, &scenarios.scenes[frame.scene], RESOLUTION);
        all += real.len();
        same +=
            if real.len() == ours.len() { real.iter().zip(&ours).filter(|(a, b)| is_same(a, b)).count() } else { 0 };
    }
    Ok(format!("{}: {same} of {all} maps are those of the package itself ({}).", engine.name, file.version))
}

fn is_same(real: &FitMap, ours: &FitMap) -> bool {
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= TOLERANCE * a.abs().max(1.0);
    real.resolution == ours.resolution && real.view_proj.iter().zip(&ours.view_proj).all(is_near)
}

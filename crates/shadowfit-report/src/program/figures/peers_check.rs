//! Compares the fits that engines' own code made for the frames with our versions of them.

use std::path::Path;

use anyhow::Result;
use shadowfit_report::engines::{ENGINES, Engine, is_same_map};
use shadowfit_report::peers::Scenarios;

use super::contestants::RESOLUTION;
use super::fit_file;

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
        same += if real.len() == ours.len() {
            real.iter().zip(&ours).filter(|(a, b)| is_same_map(a, b)).count()
        } else {
            0
        };
    }
    Ok(format!("{}: {same} of {all} maps are those of the package itself ({}).", engine.name, file.version))
}

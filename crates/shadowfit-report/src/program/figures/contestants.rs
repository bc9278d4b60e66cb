//! The contestants: our presets, and the fits of other engines drawn by the same renderer.

use anyhow::{Context, Result};
use shadowfit::FittedMap;
use shadowfit::settings::{BiasSettings, Edges, FilterKind, MapFormat, MapSelection};
use shadowfit::{DepthConvention, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::{Gpu, Renderer};
use shadowfit_report::engines::{ENGINES, Engine};
use shadowfit_report::peers::{Frame, Scene};
use shadowfit_study::{Evaluator, Judging, NamedTechnique, PreparedScene, View};
use shadowfit_wgpu::ShadowMapDescriptor;

/// Side of all maps, in texels.
pub(super) const RESOLUTION: u32 = 2048;
/// Filter of all contestants.
const FILTER: FilterKind = FilterKind::Pcf5x5;
/// Our presets for a whole view, and where they are shown.
const PRESETS: [(&str, Shown); 6] = [
    ("xna-1", Shown::WithPictures),
    ("stable-4", Shown::WithPictures),
    ("calm-4", Shown::InDetail),
    ("focused-4", Shown::InDetail),
    ("windows-4", Shown::WithPictures),
    ("windows-8", Shown::Everywhere),
];
/// Name of the recommended preset with traced edges.
const TRACED: &str = "windows-4-traced";
/// Engine whose pictures the page shows.
const PICTURED_ENGINE: &str = "bevy";

/// Where a contestant is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Shown {
    /// In the tables, but neither in the README nor by a quick look.
    InDetail,
    /// In all tables.
    Everywhere,
    /// In all tables, and with pictures on the page.
    WithPictures,
}

/// A contestant.
pub(super) struct Contestant {
    pub(super) name: String,
    /// Its maps, in a sentence.
    pub(super) what: String,
    /// Its settings as TOML; empty for an engine.
    pub(super) settings: String,
    pub(super) shown: Shown,
    pub(super) evaluator: Evaluator,
    kind: Kind,
}

enum Kind {
    Technique(Inputs),
    Engine(Engine, BiasSettings),
}

/// Returns all contestants, engines first.
pub(super) fn all(gpu: &Gpu, judging: Judging) -> Result<Vec<Contestant>> {
    let mut all = Vec::new();
    for engine in ENGINES {
        all.push(of_engine(gpu, judging, engine).with_context(|| engine.name)?);
    }
    for (name, shown) in PRESETS {
        let named = NamedTechnique::find(name)?.with_resolution(RESOLUTION);
        all.push(of_technique(gpu, judging, named, shown).with_context(|| name)?);
    }
    let recommended = NamedTechnique::from(Technique { edges: Edges::Traced { samples: 1 }, ..Technique::default() });
    let traced = NamedTechnique { name: TRACED.to_owned(), ..recommended };
    all.push(of_technique(gpu, judging, traced, Shown::Everywhere).context(TRACED)?);
    Ok(all)
}

fn of_technique(gpu: &Gpu, judging: Judging, named: NamedTechnique, shown: Shown) -> Result<Contestant> {
    let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&named.technique), 1)?;
    let mut evaluator = Evaluator::new(renderer, judging);
    evaluator.renderer.sun_mut().fitter_mut().set_technique(&named.technique);
    let (what, settings) = (named.description(), named.to_toml()?);
    Ok(Contestant { name: named.name, what, settings, shown, evaluator, kind: Kind::Technique(named.inputs) })
}

fn of_engine(gpu: &Gpu, judging: Judging, engine: Engine) -> Result<Contestant> {
    let descriptor = ShadowMapDescriptor {
        resolution: [RESOLUTION; 2],
        maps: engine.maps,
        filter: FILTER,
        selection: MapSelection::ViewDepth { overlap: 0.0 },
        depth: if engine.is_reversed { DepthConvention::Reversed } else { DepthConvention::ZeroToOne },
        depth_clamp: engine.depth_clamp,
        ..ShadowMapDescriptor::default()
    };
    let evaluator = Evaluator::new(Renderer::new(gpu, &descriptor, 1)?, judging);
    let kind = Kind::Engine(engine, BiasSettings::automatic(FILTER));
    let (name, what) = (engine.name.to_owned(), engine.what.to_owned());
    let shown = if engine.name == PICTURED_ENGINE { Shown::WithPictures } else { Shown::Everywhere };
    Ok(Contestant { name, what, settings: String::new(), shown, evaluator, kind })
}

impl Contestant {
    /// Fits the maps of a frame. Frames of a path come in order.
    pub(super) fn fit(
        &mut self,
        prepared: &PreparedScene,
        scene: &Scene,
        frame: &Frame,
        view: &View,
    ) -> Result<Vec<FittedMap>> {
        match &self.kind {
            Kind::Technique(inputs) => {
                let fitter = self.evaluator.renderer.sun_mut().fitter_mut();
                Ok(prepared.fit_next(fitter, *inputs, view).with_context(|| self.name.clone())?.to_vec())
            }
            Kind::Engine(engine, bias) => {
                let maps = engine.fit(frame, scene, RESOLUTION);
                crate::peers::map_fits(&maps, view, bias, MapFormat::default()).with_context(|| self.name.clone())
            }
        }
    }
}

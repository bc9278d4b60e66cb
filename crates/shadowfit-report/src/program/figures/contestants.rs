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
/// Our presets, and whether the page shows their pictures.
const PRESETS: [(&str, bool); 5] =
    [("xna-1", true), ("stable-4", true), ("histogram-4", false), ("windows-4", true), ("windows-8", false)];
/// Name of the recommended preset with traced edges.
const TRACED: &str = "windows-4-traced";
/// Engine whose pictures the page shows.
const PICTURED_ENGINE: &str = "bevy";

/// A contestant.
pub(super) struct Contestant {
    pub(super) name: String,
    /// Its maps, in a sentence.
    pub(super) what: String,
    /// Its settings as TOML; empty for an engine.
    pub(super) settings: String,
    /// Whether the page shows its pictures.
    pub(super) is_pictured: bool,
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
    for (name, is_pictured) in PRESETS {
        let named = NamedTechnique::find(name)?.with_resolution(RESOLUTION);
        all.push(of_technique(gpu, judging, named, is_pictured).with_context(|| name)?);
    }
    let recommended = NamedTechnique::from(Technique { edges: Edges::Traced { samples: 1 }, ..Technique::default() });
    let traced = NamedTechnique { name: TRACED.to_owned(), ..recommended };
    all.push(of_technique(gpu, judging, traced, false).context(TRACED)?);
    Ok(all)
}

fn of_technique(gpu: &Gpu, judging: Judging, named: NamedTechnique, is_pictured: bool) -> Result<Contestant> {
    let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&named.technique), 1)?;
    let mut evaluator = Evaluator::new(renderer, judging);
    evaluator.renderer.sun_mut().fitter_mut().set_technique(&named.technique);
    let (what, settings) = (named.description(), named.to_toml()?);
    Ok(Contestant { name: named.name, what, settings, is_pictured, evaluator, kind: Kind::Technique(named.inputs) })
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
    let is_pictured = engine.name == PICTURED_ENGINE;
    Ok(Contestant { name, what, settings: String::new(), is_pictured, evaluator, kind })
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

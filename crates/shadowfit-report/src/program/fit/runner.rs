//! Fits all frames, several times to measure the time.

use std::time::Instant;

use anyhow::{Context, Result};
use glam::{DMat4, DVec3, Vec3};
use shadowfit::selection::MapOrder;
use shadowfit::settings::MapSelection;
use shadowfit::{
    Aabb, Boxes, Clusters, FitInput, FittedMap, FittedMaps, NormalCone, ShadowFitter, Technique, ViewFrustum,
    VisibleDemand,
};
use shadowfit_params::BoxSource;
use shadowfit_report::geometry::Source;
use shadowfit_report::peers::{FitFile, FitFrame, FitMap, Frame, Scenarios, Scene};
use shadowfit_study::{NamedTechnique, see_by_rays};
use shadowfit_truth::Tracer;

/// Number of timed passes over all frames, after one pass for warm-up.
const BATCHES: usize = 7;

/// Data of a scene for its fits.
struct Known {
    boxes: Vec<Aabb>,
    /// Cones around the normals in the boxes, if known.
    cones: Vec<NormalCone>,
    tracer: Option<Tracer>,
}

/// A frame, ready to be fitted.
struct Prepared {
    view: ViewFrustum,
    direction: Vec3,
    scene: usize,
    /// Whether the fitter must forget the previous frames.
    is_first: bool,
    /// Visible demand of the previous frame, as input of the fit.
    seen: Option<VisibleDemand>,
}

/// Times of fits, in nanoseconds. Each frame counts with its fastest batch.
pub(crate) struct Times {
    /// Median over frames that do not begin a path.
    pub(crate) median: f64,
    /// Slowest frame that does not begin a path.
    pub(crate) slowest: f64,
    /// Slowest frame that begins a path.
    pub(crate) first: f64,
}

/// Fits every frame of the scenarios.
pub(crate) fn run(scenarios: &Scenarios, named: &NamedTechnique, source: Option<&Source>) -> Result<(FitFile, Times)> {
    let technique = &named.technique;
    let known: Vec<Known> = scenarios.scenes.iter().map(|scene| know(scene, named, source)).collect::<Result<_>>()?;
    let frames: Vec<Prepared> =
        (0..scenarios.frames.len()).map(|index| prepare(scenarios, index, &known, technique)).collect::<Result<_>>()?;
    let mut times = vec![Vec::with_capacity(BATCHES); frames.len()];
    let mut maps = Vec::new();
    for batch in 0..=BATCHES {
        let fitted = fit_all(&frames, &known, technique)?;
        if batch > 0 {
            for (times, (_, time)) in times.iter_mut().zip(&fitted) {
                times.push(*time);
            }
        }
        maps = fitted;
    }
    let fit_frame = |(frame, (maps, _)): (&Frame, &(FittedMaps, f64))| FitFrame {
        id: frame.id.clone(),
        maps: fit_maps(maps, technique),
    };
    let fitted = scenarios.frames.iter().zip(&maps).map(fit_frame);
    let all: Vec<f64> = times.iter().flatten().copied().collect();
    let fastest: Vec<f64> = times.iter().map(|times| times.iter().copied().fold(f64::MAX, f64::min)).collect();
    let slowest = |is_first: bool| {
        let times = fastest.iter().zip(&frames).filter(|(_, frame)| frame.is_first == is_first);
        times.map(|(time, _)| *time).fold(0.0, f64::max)
    };
    let later = fastest.iter().zip(&frames).filter(|(_, frame)| !frame.is_first).map(|(time, _)| *time);
    let times = Times { median: median(later.collect()), slowest: slowest(false), first: slowest(true) };
    let file = FitFile {
        peer: format!("shadowfit {}", named.name),
        language: "Rust".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        note: named.description(),
        depth_clamp: false,
        ns_per_fit: Some(median(all)),
        ns_quiet: Some(median(fastest)),
        frames: fitted.collect(),
    };
    Ok((file, times))
}

fn know(scene: &Scene, named: &NamedTechnique, source: Option<&Source>) -> Result<Known> {
    let triangles = source.map(|source| source.read(scene)).transpose()?;
    let (boxes, cones) = match (named.inputs.boxes, &triangles) {
        (BoxSource::Clusters, Some(objects)) => {
            let objects: Vec<&[[Vec3; 3]]> = objects.iter().map(Vec::as_slice).collect();
            let clusters = Clusters::build(&objects, Clusters::DEFAULT_LIMIT).context(scene.name.clone())?;
            (clusters.boxes().to_vec(), clusters.cones().to_vec())
        }
        _ => (scene.objects.iter().map(outward).collect(), Vec::new()),
    };
    let tracer = triangles.filter(|_| named.inputs.tell(&named.technique));
    Ok(Known { boxes, cones, tracer: tracer.map(|objects| Tracer::new(objects.into_iter().flatten())) })
}

/// Returns a box rounded outward to f32.
fn outward(bounds: &[f64; 6]) -> Aabb {
    let [a, b, c, d, e, f] = *bounds;
    let down = |v: f64| if f64::from(v as f32) > v { (v as f32).next_down() } else { v as f32 };
    let up = |v: f64| if f64::from(v as f32) < v { (v as f32).next_up() } else { v as f32 };
    Aabb::new(Vec3::new(down(a), down(b), down(c)), Vec3::new(up(d), up(e), up(f)))
}

fn prepare(scenarios: &Scenarios, index: usize, known: &[Known], technique: &Technique) -> Result<Prepared> {
    let frame = &scenarios.frames[index];
    let before = scenarios.previous(index).map(|before| &scenarios.frames[before]);
    let tracer = known[frame.scene].tracer.as_ref();
    let direction = DVec3::from_array(frame.light_dir).as_vec3();
    let view = frame.camera().frustum().with_context(|| frame.id.clone())?;
    Ok(Prepared {
        view,
        direction,
        scene: frame.scene,
        is_first: before.is_none(),
        seen: match before.zip(tracer) {
            Some((before, tracer)) => Some(see_by_rays(tracer, before.camera(), direction, technique)?),
            None => None,
        },
    })
}

/// Fits all frames. Returns the maps and the nanoseconds of each frame.
fn fit_all(frames: &[Prepared], known: &[Known], technique: &Technique) -> Result<Vec<(FittedMaps, f64)>> {
    let mut fitter = ShadowFitter::new(technique);
    frames
        .iter()
        .map(|frame| {
            if frame.is_first {
                fitter.reset();
            }
            if let Some(seen) = &frame.seen {
                fitter.set_visible_demand(seen.clone());
            }
            let views = [frame.view];
            let boxes = Boxes { origin: DVec3::ZERO, boxes: &known[frame.scene].boxes };
            let input = FitInput {
                receivers: Some(boxes),
                receiver_cones: &known[frame.scene].cones,
                casters: Some(boxes),
                ..FitInput::new(&views, frame.direction)
            };
            let start = Instant::now();
            fitter.fit(&input)?;
            let time = start.elapsed().as_nanos() as f64;
            Ok((*fitter.fitted(), time))
        })
        .collect()
}

/// Returns the maps of a frame in the form of fit files, in the order in which points try them. If maps are
/// selected by view depth, this is the order of their ends. If they are selected by coverage, the finest map
/// comes first, maps have no end, and empty maps are left out.
fn fit_maps(maps: &FittedMaps, technique: &Technique) -> Vec<FitMap> {
    let choice = technique.maps.selection();
    let fits = maps.iter().map(|map| &map.projection);
    let in_order = MapOrder::new(choice, fits);
    let fitted = in_order.iter().map(|index| fit_map(&maps[index]));
    match choice {
        MapSelection::ViewDepth { .. } => fitted.collect(),
        MapSelection::Coverage { .. } => fitted.map(|map| FitMap { split_far: FitMap::NO_END, ..map }).collect(),
    }
}

/// Returns a map in the form of fit files: the f32 matrix of the renderer, made absolute in f64.
fn fit_map(map: &FittedMap) -> FitMap {
    let projection = &map.projection;
    let clip_from_world = projection.clip_from_world.as_dmat4() * DMat4::from_translation(-projection.origin);
    let [width, height] = projection.resolution.to_array();
    FitMap {
        view_proj: clip_from_world.to_cols_array(),
        resolution: width,
        resolution_xy: (width != height).then_some([width, height]),
        split_near: map.depths.map_or(0.0, |range| range.near),
        split_far: map.depths.map_or(-FitMap::NO_END, |range| range.far.unwrap_or(FitMap::NO_END)),
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

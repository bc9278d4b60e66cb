//! Windows: their guarantees for any camera, light and demand grid, tested on the output of a [`FitState`].

mod content;
mod coverage;
mod light;
mod presets;
mod room;
mod scaled;
mod scrolled;
mod settled;
mod state;
mod still;

use proptest::prelude::*;
use shadowfit::demand::{CELLS, DemandGrid, DemandSpace, PIXELS};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::{CasterPolicy, FilterKind, MapSettings, SoftRadius, Softness};
use shadowfit::{
    Aabb, Boxes, FitInput, FitState, FittedMaps, PerspectiveCamera, Scratch, Technique, ViewFrustum, Windows,
};

use crate::scenes::{SceneView, any_depth, of_camera};
use crate::support::{any_direction, float};

/// Number of rays across and down the picture.
const COLUMNS: u16 = 64;
const ROWS: u16 = 36;

/// A visible point, and its movement on its surface per pixel of a picture that is [`PIXELS`] high.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// Position relative to the eye. All vectors are in world axes.
    point: DVec3,
    normal: DVec3,
    right: DVec3,
    down: DVec3,
}

/// A ray for tests against boxes.
#[derive(Clone, Copy)]
struct Ray {
    start: DVec3,
    /// One over its direction.
    inverse: DVec3,
}

impl Ray {
    fn new(start: DVec3, along: DVec3) -> Self {
        Self { start, inverse: along.recip() }
    }

    /// Returns where the ray enters a box, as a multiple of its direction, and the normal there; `None` from
    /// inside.
    fn entry(self, (min, max): (DVec3, DVec3)) -> Option<(f64, DVec3)> {
        // Along an axis that the ray does not follow, these are infinite: both have the same sign if it
        // starts beside the box.
        let (a, b) = ((min - self.start) * self.inverse, (max - self.start) * self.inverse);
        let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
        (enter <= leave && enter > 0.0).then(|| {
            let mut normal = DVec3::ZERO;
            let axis = a.min(b).max_position();
            normal[axis] = -self.inverse[axis].signum();
            (enter, normal)
        })
    }
}

/// Returns the visible points of boxes in a view by 64 × 36 rays, up to a view depth in metres.
fn hits(view: &SceneView, origin: DVec3, boxes: &[Aabb], distance: f64) -> Vec<Hit> {
    let lens = &view.lens;
    let boxes: Vec<(DVec3, DVec3)> =
        boxes.iter().map(|b| [b.min, b.max].map(|v| v.as_dvec3() + origin - view.eye).into()).collect();
    let ray = |x: f64, y: f64| {
        let start = view.point(x, y, 0.0);
        (start, view.point(x, y, 1.0) - start)
    };
    let pixel = 1.0 / f64::from(PIXELS);
    let across = pixel * (lens.top - lens.bottom) / (lens.right - lens.left);
    let all = (0..COLUMNS).flat_map(|x| (0..ROWS).map(move |y| (x, y)));
    let hit = |(x, y): (u16, u16)| {
        let (x, y) = ((f64::from(x) + 0.5) / f64::from(COLUMNS), (f64::from(y) + 0.5) / f64::from(ROWS));
        let (start, along) = ray(x, y);
        let inverted = Ray::new(start, along);
        let met = boxes.iter().filter_map(|b| inverted.entry(*b)).filter(|(depth, _)| *depth >= lens.near);
        let (depth, normal) = met.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let point = start + along * depth;
        let beside = |x: f64, y: f64| {
            let (start, along) = ray(x, y);
            start + along * (normal.dot(point - start) / normal.dot(along)) - point
        };
        (depth <= distance.min(lens.far)).then(|| Hit {
            point,
            normal,
            right: beside(x + across, y),
            down: beside(x, y - pixel),
        })
    };
    all.filter_map(hit).collect()
}

/// Returns the pixels per texel along the worse axis, for a picture 1080 pixels high: one over the least
/// singular value of the point's movement in the map per pixel.
fn pixels_per_texel(maps: &FittedMaps, technique: &Technique, view: &SceneView, hit: &Hit) -> Option<f64> {
    let read = maps.read(technique, view.eye + hit.point, hit.point.dot(view.axes()[2]))?;
    let fit = &maps[read.main()].projection;
    let rows = fit.light_from_world.transpose();
    let texels = |v: DVec3| {
        let [x, y] = [rows.x_axis, rows.y_axis].map(|row| row.truncate().as_dvec3().dot(v));
        DVec2::new(x, y) / fit.texel_size.as_dvec2()
    };
    let (a, b) = (texels(hit.right), texels(hit.down));
    let (half, diff) =
        ((a.length_squared() + b.length_squared()) * 0.5, (a.length_squared() - b.length_squared()) * 0.5);
    let greatest = (half + (diff * diff + a.dot(b) * a.dot(b)).sqrt()).sqrt();
    Some(greatest / a.perp_dot(b).abs())
}

/// Returns the 95% quantile over all visible points that face the light, or `None` without such points.
fn quantile(maps: &FittedMaps, technique: &Technique, world: &World, view: &SceneView, light: Vec3) -> Option<f64> {
    let is_lit = |hit: &Hit| -hit.normal.dot(light.as_dvec3().normalize()) >= f64::from(shadowfit::demand::MIN_FACING);
    let seen = hits(view, world.origin, &world.boxes, f64::from(technique.fit.max_distance));
    let mut all: Vec<f64> = seen
        .iter()
        .filter(|hit| is_lit(hit))
        .map(|hit| pixels_per_texel(maps, technique, view, hit).expect("covered"))
        .collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() * 19 / 20).copied()
}

/// A demand grid and its counts.
#[derive(Clone, Debug)]
struct Demand {
    space: DemandSpace,
    counts: Vec<u32>,
}

impl Demand {
    /// Counts the visible demand of a frame, from [`hits`].
    fn of(view: &SceneView, hits: &[Hit], direction: Vec3, technique: &Technique) -> Self {
        let fit = &technique.fit;
        let space = DemandSpace::new(&view.frustum(), direction, fit.up, fit.max_distance).unwrap();
        let mut counts = vec![0; CELLS];
        for hit in hits {
            let [point, normal, right, down] = [hit.point, hit.normal, hit.right, hit.down].map(DVec3::as_vec3);
            if let Some(cell) = space.index(point, normal, right, down) {
                counts[cell] += 1;
            }
        }
        Self { space, counts }
    }

    fn grid(&self) -> DemandGrid<'_> {
        DemandGrid { space: self.space, counts: &self.counts }
    }
}

/// Boxes around the world's origin or another one.
#[derive(Clone, Debug)]
struct World {
    origin: DVec3,
    boxes: Vec<Aabb>,
}

impl World {
    fn input<'a>(&'a self, views: &'a [ViewFrustum], direction: Vec3, demand: &'a [DemandGrid<'a>]) -> FitInput<'a> {
        let boxes = Some(Boxes { origin: self.origin, boxes: &self.boxes });
        FitInput { receivers: boxes, casters: boxes, demand, ..FitInput::new(views, direction) }
    }
}

/// One camera in a world, fitted frame by frame with the visible demand of the previous frame.
struct Run {
    world: World,
    technique: Technique,
    fitter: FitState,
    /// Whether there is a depth buffer to read.
    is_seen: bool,
    demand: Option<Demand>,
    /// The view and the light of the demand grid.
    seen: Option<(ViewFrustum, Vec3)>,
    storage: Vec<DVec2>,
}

impl Run {
    fn new(world: World, technique: &Technique) -> Self {
        let storage = vec![DVec2::ZERO; Scratch::required(world.boxes.len(), 1)];
        Self { world, technique: *technique, fitter: FitState::new(), is_seen: true, demand: None, seen: None, storage }
    }

    /// Sets whether there is a depth buffer to read.
    fn seen_if(self, is_seen: bool) -> Self {
        Self { is_seen, ..self }
    }

    fn frame(&mut self, view: &SceneView, direction: Vec3) -> FittedMaps {
        let views = [view.frustum()];
        let demand: Vec<DemandGrid> = self.demand.iter().filter(|_| self.is_seen).map(Demand::grid).collect();
        let input = self.world.input(&views, direction, &demand);
        let maps = self.fitter.fit(&input, &self.technique, &mut Scratch::new(&mut self.storage)).unwrap();
        if self.seen.replace((views[0], direction)) != Some((views[0], direction)) {
            let distance = f64::from(self.technique.fit.max_distance);
            let hits = hits(view, self.world.origin, &self.world.boxes, distance);
            self.demand = Some(Demand::of(view, &hits, direction, &self.technique));
        }
        maps
    }
}

/// Returns houses on a square of ground around the world's origin.
fn town() -> World {
    let ground = Aabb::new(Vec3::new(-150.0, -1.0, -150.0), Vec3::new(150.0, 0.0, 150.0));
    let house = |i: u16| {
        let (x, z) = (f32::from(i % 10) * 28.0 - 140.0, f32::from(i / 10) * 28.0 - 140.0);
        Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + 8.0, 4.0 + f32::from(i * 37 % 11), z + 11.0))
    };
    World { origin: DVec3::ZERO, boxes: std::iter::once(ground).chain((0..100).map(house)).collect() }
}

/// Returns a camera at eye height that looks along a direction.
fn street_view(eye: DVec3, forward: Vec3) -> SceneView {
    let (fov_y, aspect) = (0.9, 16.0 / 9.0);
    of_camera(&PerspectiveCamera { eye, forward, up: Vec3::Y, fov_y, aspect, near: 0.1, far: 300.0 })
}

/// Returns the preset's technique with this number of maps, of this side in texels.
fn windows(count: u32, side: u32) -> Technique {
    Technique::preset("windows-4").unwrap().with_count(count).with_max_distance(f32::MAX).with_resolution(side, side)
}

/// Settings of windows of every kind.
fn any_windows() -> impl Strategy<Value = Technique> {
    let size = || prop::sample::select(vec![64_u32, 300, 1024, 2048]);
    let up = prop_oneof![2 => Just(Vec3::Y), 1 => Just(Vec3::Z), 1 => any_direction()];
    let border = prop_oneof![2 => Just(None), 1 => float(0.0, 8.0).prop_map(Some)];
    let casters = prop::sample::select(vec![CasterPolicy::PerObject, CasterPolicy::SceneBounds]);
    let fit = (up, border, casters, prop_oneof![2 => Just(f32::MAX), 1 => float(3.0, 500.0)], any_depth());
    // The widest disc and its look-ups leave half of the smallest map.
    let radius =
        prop_oneof![float(0.0, 0.5).prop_map(SoftRadius::Metres), float(0.0, 0.1).prop_map(SoftRadius::SunAngle)];
    let softness = (radius, float(1.0, 14.0)).prop_map(|(radius, ceiling)| Softness { radius, floor: 1.0, ceiling });
    let look_up = (prop::sample::select(FilterKind::ALL.to_vec()), softness);
    (1..=8_u32, (size(), size()), fit, look_up).prop_map(
        |(count, (width, height), (up, border, casters, max_distance, depth), (filter, softness))| {
            let maps = Windows::default().with_count(count).into();
            let fit = MapSettings { up, border, casters, max_distance, depth, ..MapSettings::default() };
            Technique { maps, fit, softness, ..Technique::default() }.with_filter(filter).with_resolution(width, height)
        },
    )
}

/// Whether there is a depth buffer to read: in two of three cases.
fn any_seen() -> impl Strategy<Value = bool> {
    prop::sample::select(vec![true, true, false])
}

//! The three demonstrations: the camera and the settings that make an artefact clearly visible in the current
//! scene, and the setting that cures it.
//!
//! Several maps keep their fit, their splits and their stabilisation. Only the settings that prevent the
//! artefact are changed. A single map gets the fit that shows the artefact best. Windows cannot be made
//! coarse and hold every caster over them, so focused maps replace them until the cure of aliasing or of a
//! hole restores them. Acne is cured at the texel size that shows it.

mod narration;
mod view_search;

use core::f32::consts::{PI, TAU};

use glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, CasterPolicy, FilterKind, FitKind};
use shadowfit::{Aabb, Maps, PerspectiveCamera, Technique};
use shadowfit_egui::Artefact;
use shadowfit_params::Inputs;
use shadowfit_params::tool::{Settings, ViewMode};
use shadowfit_render::FlyCamera;
use shadowfit_study::{PosedScene, near_of};

use view_search::{GRID, Seen, Shadow, ViewSearch, aimed};

/// Height of a shadow texel on screen when acne is shown, as a share of the picture's height: a few pixels,
/// so that its stripes are distinguishable.
const ACNE_TEXEL: f32 = 1.0 / 210.0;
/// Height of a shadow texel on screen when aliasing is shown: dozens of pixels.
const ALIASING_TEXEL: f32 = 1.0 / 22.0;
/// Constant bias of acne's cure, in texels. The automatic bias clears every plane. Where surfaces meet in a
/// crease, a texel stores the neighbouring surface, which is a fraction of a texel higher, and a single
/// comparison is not averaged with others.
const CREASE_BIAS: f32 = 1.0;
/// Shadow distance when the hole is shown with a single map, in radii of the subject.
const HOLE_DISTANCE: f32 = 4.0;
/// Least shadow length, in radii of the scene, for showing the scene as a whole.
const LARGE_REACH: f32 = 0.3;
/// Share of the picture above which a larger hole does not increase the score.
const LARGE_HOLE: f32 = 0.15;
/// Share of the picture that should still show a shadow when the hole is shown.
const KEPT_SHADOW: f32 = 0.1;
/// Factor by which a hole scores higher where the visible shadow breaks off at it, and the length of that
/// break, in coarse pixels, from which the factor applies in full.
const BREAK: f32 = 1.5;
const BREAKS: f32 = 5.0;
/// Resolution of a single map, in texels, when aliasing is shown.
const SHOWN_RESOLUTION: u32 = 2048;
/// Resolution of a single map after aliasing is fixed, in texels.
const FIXED_RESOLUTION: u32 = 4096;
/// Least resolution of each of several maps after aliasing is fixed, in texels.
const FIXED_RESOLUTION_EACH: u32 = 2048;
/// Bisection steps in the search for the coarseness, on a logarithmic scale: to a millionth of the range.
const STEPS: u32 = 24;
/// Aspect ratio of the candidates' pictures.
const ASPECT: f32 = 16.0 / 9.0;

/// Input of the search for the view of an artefact. It can be sent to a thread.
#[derive(Debug)]
pub(crate) struct Search {
    pub(crate) artefact: Artefact,
    pub(crate) scene: PosedScene,
    pub(crate) settings: Settings,
    /// The current camera with its lens.
    pub(crate) lens: PerspectiveCamera,
}

/// A view of an artefact.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) artefact: Artefact,
    pub(crate) settings: Settings,
    pub(crate) camera: FlyCamera,
    /// Whether it shows the artefact. If no view does, this one comes closest.
    pub(crate) shows: bool,
    /// A hint where to look, in a sentence about this scene.
    pub(crate) narration: String,
}

impl Search {
    /// Searches for the view and the settings that show the artefact best.
    pub(crate) fn run(mut self) -> Found {
        let view = &mut self.settings.view;
        (view.mode, view.play, view.freeze_fit, view.shadows) = (ViewMode::Final, false, false, true);
        self.settings.light.animate = false;
        if self.settings.camera.height.take().is_some() {
            // The near plane of an orthographic lens may lie far from its eye.
            self.lens.near = near_of(&self.scene.bounds());
            self.settings.camera.near = self.lens.near;
        }
        let light = self.settings.light.direction();
        let scene = &self.scene;
        let origin = scene.origin();
        let subject = relative_to(origin, &scene.subject_bounds());
        let has_subject = scene.scene().subject.is_some();
        let lens = self.lens_for_rays();
        let mut settings = self.settings;
        let search = ViewSearch::new(scene, settings.inputs, light);
        let place = Place::new(&search, light, subject, has_subject, lens);
        let (camera, shows) = match self.artefact {
            Artefact::Acne => show_acne(&search, &place, &mut settings),
            Artefact::Aliasing => show_aliasing(&search, &place, &mut settings),
            Artefact::ClippingHole => show_hole(&search, &place, &mut settings),
        };
        let eye = origin + camera.eye;
        Found {
            artefact: self.artefact,
            narration: narration::tell(self.artefact, &search, &camera, &settings),
            settings,
            camera: FlyCamera::look_at(eye, eye + camera.forward.as_dvec3()),
            shows,
        }
    }
}

impl Search {
    /// Returns the level camera relative to the origin of the rays.
    fn lens_for_rays(&self) -> PerspectiveCamera {
        PerspectiveCamera { aspect: ASPECT, up: Vec3::Y, eye: self.lens.eye - self.scene.origin(), ..self.lens }
    }

    /// Returns a hint where to look in the current view with the current settings.
    pub(crate) fn narrate(&self) -> String {
        let search = ViewSearch::new(&self.scene, self.settings.inputs, self.settings.light.direction());
        let camera = self.lens_for_rays();
        narration::tell(self.artefact, &search, &camera, &self.settings)
    }
}

/// Applies the cure of a shown artefact. `before` is the technique before it was shown. `seen` is the
/// distance beyond which hardly anything is visible, in metres, from [`farthest_seen`].
pub(crate) fn fix(technique: &mut Technique, artefact: Artefact, before: &Technique, seen: Option<f32>) {
    let is_single = technique.maps.count() == 1;
    let gave_way = !is_single && is_of(technique, FitKind::Focused) && matches!(before.maps, Maps::Windows(_));
    if gave_way && artefact != Artefact::Acne {
        *technique = technique.with_maps(technique.maps.as_windows());
    }
    match artefact {
        // Enough for planes and creases, with no other change.
        Artefact::Acne => {
            technique.bias = BiasSettings { constant: CREASE_BIAS, ..BiasSettings::automatic(technique.filter) };
        }
        // Maps that cover only the visible part, with more texels, and a filter that smooths the remaining steps.
        Artefact::Aliasing => {
            let fit = &mut technique.fit;
            fit.margin = 0.0;
            if is_single {
                fit.max_distance = seen.unwrap_or(fit.max_distance);
                fit.resolution = UVec2::splat(FIXED_RESOLUTION);
            } else {
                fit.resolution = fit.resolution.max(UVec2::splat(FIXED_RESOLUTION_EACH));
            }
            *technique = technique.with_filter(FilterKind::Pcf5x5);
        }
        // Cover every caster between the light and the view.
        Artefact::ClippingHole => {
            technique.fit.casters = CasterPolicy::PerObject;
            if is_single {
                *technique = technique.with_maps(technique.maps.with_kind(FitKind::Focused));
            }
        }
    }
}

/// The subject of the demonstrations: the scene's subject, or a part of the scene.
struct Place {
    bounds: Aabb,
    center: Vec3,
    radius: f32,
    lens: PerspectiveCamera,
    /// Shadows that it casts, sorted by length.
    shadows: Vec<Shadow>,
}

impl Place {
    fn new(search: &ViewSearch<'_>, light: Vec3, bounds: Aabb, has_subject: bool, lens: PerspectiveCamera) -> Self {
        let mut shadows = search.shadows(&bounds);
        shadows.sort_by(|a, b| a.reach.total_cmp(&b.reach));
        let radius = ((bounds.max - bounds.min).length() * 0.5).max(f32::MIN_POSITIVE);
        let whole = Self { bounds, center: (bounds.min + bounds.max) * 0.5, radius, lens, shadows };
        let Some(long) = whole.shadows.get(whole.shadows.len() * 3 / 4).copied() else { return whole };
        if has_subject || long.reach > radius * LARGE_REACH {
            return whole;
        }
        // A scene far larger than its shadows, such as a town: choose one of its casters.
        let center = long.receiver - light * (long.reach * 0.5);
        let radius = long.reach;
        let bounds = Aabb { min: center - radius, max: center + radius };
        let mut shadows = search.shadows(&bounds);
        shadows.sort_by(|a, b| a.reach.total_cmp(&b.reach));
        Self { bounds, center, radius, lens, shadows }
    }

    fn contains(&self, point: Vec3) -> bool {
        let slack = Vec3::splat(self.radius * 0.01);
        point.cmpge(self.bounds.min - slack).all() && point.cmple(self.bounds.max + slack).all()
    }

    /// Returns the height of the picture, in metres, at a distance from the eye.
    fn picture_height(&self, distance: f32) -> f32 {
        2.0 * (self.lens.fov_y * 0.5).tan() * distance
    }
}

/// Shows acne: the subject's upper part close up from the lit side, without any bias, so that every slope
/// shadows itself.
fn show_acne(search: &ViewSearch<'_>, place: &Place, settings: &mut Settings) -> (PerspectiveCamera, bool) {
    let target = place.center + Vec3::Y * (place.bounds.max.y - place.bounds.min.y) * 0.25;
    let distances = [1.5, 1.8].map(|radii| radii * place.radius);
    let candidates = around(target, -search.direction, &[0.3, 0.6, 0.9, -0.3, -0.6, -0.9], &[0.0, 0.15], &distances);
    let score = |camera: &PerspectiveCamera| {
        let shows = |seen: &Seen| {
            let slope = search.facing(seen);
            place.contains(seen.position) && (0.1..0.9).contains(&slope) && !search.is_shadowed(seen)
        };
        let pixels = search.look(camera);
        if is_blocked(&pixels, place.radius * 0.3) {
            0
        } else {
            pixels.iter().flatten().filter(|seen| shows(seen)).count()
        }
    };
    let (camera, found) = best(&place.lens, candidates, |camera| score(camera) as f32);
    let distance = camera.eye.as_vec3().distance(place.center);
    let none = BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
    settings.technique =
        alone_or_as_cascades(settings.technique, FitKind::XnaSample).with_look_up(FilterKind::Point, none);
    let texel = place.picture_height(distance) * ACNE_TEXEL;
    let middle = camera.eye.as_vec3() + camera.forward * distance;
    coarsen(search, &camera, settings, &Coarse { point: middle, texel, least: distance + place.radius });
    (camera, found)
}

/// Shows aliasing: the edge of the subject's shadow close up, in a map that covers far too much.
fn show_aliasing(search: &ViewSearch<'_>, place: &Place, settings: &mut Settings) -> (PerspectiveCamera, bool) {
    let targets = spread(&place.shadows, 5);
    let height = place.radius;
    let candidates = targets.iter().flat_map(|shadow| {
        around(
            shadow.receiver,
            -search.direction,
            &[-2.2, -1.4, -0.7, 0.7, 1.4, 2.2],
            &[0.5, 0.8],
            &[height * 1.5, height * 2.2],
        )
    });
    let score = |camera: &PerspectiveCamera| {
        let pixels = search.look(camera);
        if is_blocked(&pixels, place.radius * 0.3) {
            return 0.0;
        }
        let shadowed: Vec<Option<bool>> = pixels
            .iter()
            .map(|seen| seen.filter(|seen| search.facing(seen) > 0.2).map(|seen| search.is_shadowed(&seen)))
            .collect();
        let share = shadowed.iter().filter(|pixel| **pixel == Some(true)).count() as f32 / shadowed.len() as f32;
        // The most edge, with about equal areas of shadow and light.
        edges(&shadowed) as f32 * (1.0 - (share - 0.4).abs())
    };
    let (camera, found) = best(&place.lens, candidates, score);
    let middle = search.look(&camera)[(GRID[0] * GRID[1] / 2 + GRID[0] / 2) as usize];
    let distance = middle.map_or(height * 2.0, |seen| seen.distance);
    let point = middle.map_or(camera.eye.as_vec3() + camera.forward * distance, |seen| seen.position);
    settings.technique = alone_or_as_cascades(settings.technique, FitKind::FrustumAabb).with_filter(FilterKind::Point);
    if settings.technique.maps.count() == 1 {
        settings.technique.fit.resolution = UVec2::splat(SHOWN_RESOLUTION);
    }
    let texel = place.picture_height(distance) * ALIASING_TEXEL;
    coarsen(search, &camera, settings, &Coarse { point, texel, least: distance * 2.0 });
    (camera, found)
}

/// Shows a hole: the camera is between the subject and its shadow, so that the shadow is in view and its
/// caster is not in the map.
fn show_hole(search: &ViewSearch<'_>, place: &Place, settings: &mut Settings) -> (PerspectiveCamera, bool) {
    let technique = &mut settings.technique;
    *technique = alone_or_as_cascades(*technique, FitKind::XnaSample).with_filter(technique.filter);
    technique.fit.margin = 0.0;
    technique.fit.casters = CasterPolicy::None;
    if technique.maps.count() == 1 {
        technique.fit.max_distance = place.radius * HOLE_DISTANCE;
    }
    let targets = spread(&place.shadows, 4);
    // The start of the shadow as well: if only the foot of a caster is in view, its shadow breaks off.
    let base = Vec3::new(place.center.x, place.bounds.min.y, place.center.z);
    let candidates = targets.iter().flat_map(|shadow| {
        [shadow.receiver, (shadow.receiver + base) * 0.5].into_iter().flat_map(move |target| {
            let distances = [0.7, 1.0, 1.3, 1.8, 2.6].map(|reaches| shadow.reach * reaches);
            around(target, -search.direction, &around_the_clock(), &[0.4, 0.7], &distances)
        })
    });
    let mut most = 0.0_f32;
    let score = |camera: &PerspectiveCamera| {
        let pixels = search.look(camera);
        if is_blocked(&pixels, place.radius * 0.6) {
            return 0.0;
        }
        let shadowed = search.shadowed(&pixels);
        let count = shadowed.iter().flatten().count() as f32;
        let large = pixels.len() as f32 * LARGE_HOLE;
        // Skip the fit if even a hole in all of the shadow would score lower than one that was found.
        if count.min(large) * (1.0 + BREAK) <= most {
            return 0.0;
        }
        let Some(fitted) = search.fit(technique, camera) else { return 0.0 };
        let holes = search.holes(&shadowed, &fitted);
        let hole = holes.iter().filter(|hole| **hole == Some(true)).count() as f32;
        // A large hole is good, but a shadow that breaks off shows more than one that is missing completely.
        let kept = (count - hole) / (pixels.len() as f32 * KEPT_SHADOW);
        let breaks = edges(&holes) as f32 / BREAKS;
        let score = hole.min(large) * (0.1 + 0.9 * kept.min(1.0) + BREAK * breaks.min(1.0));
        most = most.max(score);
        score
    };
    best(&place.lens, candidates, score)
}

/// Returns a single map with another fit and no margin; several windows as focused maps; other maps
/// unchanged.
fn alone_or_as_cascades(mut technique: Technique, kind: FitKind) -> Technique {
    if technique.maps.count() == 1 {
        technique.fit.margin = 0.0;
        return technique.with_maps(technique.maps.with_kind(kind));
    }
    if matches!(technique.maps, Maps::Windows(_)) {
        technique.with_maps(technique.maps.as_cascades())
    } else {
        technique
    }
}

/// Returns whether the maps have a fit.
fn is_of(technique: &Technique, kind: FitKind) -> bool {
    technique.maps.shape().is_some_and(|shape| shape.kind == kind)
}

/// Returns candidate eyes around a target, each with the target: turned from the light's side by `azimuths`,
/// raised by `elevations` (radians), at `distances` (metres).
fn around(target: Vec3, to_light: Vec3, azimuths: &[f32], elevations: &[f32], distances: &[f32]) -> Vec<[Vec3; 2]> {
    let toward = to_light.x.atan2(to_light.z);
    let mut eyes = Vec::new();
    for azimuth in azimuths {
        for elevation in elevations {
            for distance in distances {
                let (sin, cos) = (toward + azimuth).sin_cos();
                let away = Vec3::new(sin * elevation.cos(), elevation.sin(), cos * elevation.cos());
                eyes.push([target + away * *distance, target]);
            }
        }
    }
    eyes
}

/// Returns twelve directions around the vertical axis, in radians.
fn around_the_clock() -> [f32; 12] {
    core::array::from_fn(|hour| hour as f32 / 12.0 * TAU - PI)
}

/// Returns the candidate with the greatest score, and whether any score exceeds 0. If none does, returns the
/// current camera.
fn best(
    lens: &PerspectiveCamera,
    candidates: impl IntoIterator<Item = [Vec3; 2]>,
    mut score: impl FnMut(&PerspectiveCamera) -> f32,
) -> (PerspectiveCamera, bool) {
    let mut best = (0.0, *lens);
    for [eye, target] in candidates {
        let camera = aimed(lens, eye, target);
        let score = score(&camera);
        if score > best.0 {
            best = (score, camera);
        }
    }
    (best.1, best.0 > 0.0)
}

/// Returns whether something blocks the view close to the eye.
fn is_blocked(pixels: &[Option<Seen>], nearest: f32) -> bool {
    let close = pixels.iter().flatten().filter(|seen| seen.distance < nearest).count();
    close * 12 > pixels.len()
}

/// Counts the pairs of neighbouring pixels with one in shadow and the other lit.
fn edges(shadowed: &[Option<bool>]) -> usize {
    let width = GRID[0] as usize;
    let differ = |a: usize, b: usize| matches!((shadowed[a], shadowed[b]), (Some(a), Some(b)) if a != b);
    (0..shadowed.len())
        .map(|index| {
            let right = (index + 1) % width != 0 && differ(index, index + 1);
            let below = index + width < shadowed.len() && differ(index, index + width);
            usize::from(right) + usize::from(below)
        })
        .sum()
}

/// Returns a few of the shadows, at even intervals of their order.
fn spread(sorted: &[Shadow], count: usize) -> Vec<Shadow> {
    let count = count.min(sorted.len());
    (0..count).map(|index| sorted[(2 * index + 1) * sorted.len() / (2 * count)]).collect()
}

/// Wanted coarseness of a map.
struct Coarse {
    /// A point that reads the map.
    point: Vec3,
    /// Wanted size of a texel, in metres.
    texel: f32,
    /// Shortest shadow distance of a single map, in metres.
    least: f32,
}

/// Makes texels as large as wanted, by the frustum that a single map has to cover, or by the margin around
/// each of several maps.
fn coarsen(search: &ViewSearch<'_>, camera: &PerspectiveCamera, settings: &mut Settings, wanted: &Coarse) {
    let is_single = settings.technique.maps.count() == 1;
    let with = |amount: f32| {
        let mut settings = *settings;
        if is_single {
            settings.technique.fit.max_distance = amount;
            settings.camera.far = settings.camera.far.max(amount);
        } else {
            settings.technique.fit.margin = amount;
        }
        settings
    };
    let point = search.world(wanted.point.as_dvec3());
    let texel_with = |settings: &Settings| {
        let camera = PerspectiveCamera { far: settings.camera.far, ..*camera };
        let fitted = search.fit(&settings.technique, &camera)?;
        Some(fitted.maps[fitted.read_at(point)?].projection.texel_size.max_element())
    };
    let resolution = settings.technique.fit.resolution.max_element() as f32;
    // A margin of half a map's texels already makes them as large as wanted.
    let (mut low, mut high) = if is_single {
        (wanted.least, wanted.least * 1e4)
    } else {
        (wanted.texel * 1e-3, wanted.texel * resolution * 0.5)
    };
    for _ in 0..STEPS {
        let middle = (low * high).sqrt();
        if texel_with(&with(middle)).is_some_and(|texel| texel < wanted.texel) { low = middle } else { high = middle }
    }
    *settings = with(low);
}

/// Returns the distance beyond which hardly anything is visible, in metres.
pub(crate) fn farthest_seen(scene: &PosedScene, light: Vec3, camera: &PerspectiveCamera) -> Option<f32> {
    let camera = PerspectiveCamera { aspect: ASPECT, eye: camera.eye - scene.origin(), ..*camera };
    let pixels = ViewSearch::new(scene, Inputs::default(), light).look(&camera);
    let mut distances: Vec<f32> = pixels.iter().flatten().map(|seen| seen.distance).collect();
    distances.sort_by(f32::total_cmp);
    let index = (distances.len() as f32 * 0.98) as usize;
    Some(distances.get(index)? * 1.1)
}

/// Returns a world-space box relative to a world position, in metres.
fn relative_to(origin: DVec3, bounds: &Aabb) -> Aabb {
    let relative = |corner: Vec3| (corner.as_dvec3() - origin).as_vec3();
    Aabb { min: relative(bounds.min), max: relative(bounds.max) }
}

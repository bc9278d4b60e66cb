//! Caching: the parts of the maps that can be kept from frame to frame, and the passes that draw the rest.
//!
//! A map on the world's grid moves by whole texels, so its static casters are drawn once. [`MapCache`]
//! compares a frame's maps and casters with the layers' content and returns a list of passes, each with
//! rectangles and casters. It uses no graphics API: the engine executes the passes, as `shadowfit-wgpu` does
//! with wgpu.
//!
//! ```text
//!   a frame's casters ──▶ 1. take: which of them changed, and where in each map?
//!   and its maps      ──▶ 2. choose: kept, moved, or new? Which of them now?
//!                     ──▶ 3. find the casters of each map that can shadow something in view
//!                     ──▶ 4. plan: passes, regions, casters
//! ```
//!
//! Static casters are redrawn only in rectangles that entered the map and where a static caster changed. If
//! casters move, the static casters also have a separate layer. The shown layer is restored from it where
//! moving casters were drawn before, and the moving casters of this frame are drawn over it. A map that is
//! redrawn completely is drawn in one pass, with static and moving casters, into the shown layer. Its static
//! layer is drawn in the next frame that keeps the map.
//!
//! ```
//! use shadowfit::cache::{CacheFrame, CacheSettings, Casters, MapCache};
//! use shadowfit::glam::{DVec3, Vec3};
//! use shadowfit::{Aabb, Boxes, FitError, FitInput, PerspectiveCamera, ShadowFitter, Technique};
//!
//! fn main() -> Result<(), FitError> {
//!     let ground = Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0));
//!     let house = Aabb::new(Vec3::new(-4.0, 0.0, -12.0), Vec3::new(4.0, 6.0, -6.0));
//!     let objects = [ground, house];
//!     let boxes = Boxes::world(&objects);
//!     let sun = Vec3::new(0.3, -0.8, 0.2);
//!     let technique = Technique::default();
//!     let mut fitter = ShadowFitter::new(&technique);
//!     let mut cache = MapCache::new(CacheSettings::of(&technique));
//!
//!     for frame in 0..3 {
//!         let eye = DVec3::new(0.0, 1.7, 20.0 - 0.1 * f64::from(frame));
//!         let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
//!         let camera = PerspectiveCamera { eye, forward, up, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 };
//!         let views = [camera.frustum()?];
//!         let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
//!         let maps = fitter.fit(&input)?;
//!         let plan = cache.update(&CacheFrame::new(maps, Casters::fixed(boxes), &views, sun))?;
//!         for pass in &plan.passes {
//!             println!("map {}: {:?} into {:?}, cleared: {}", pass.map, pass.content, pass.layer, pass.clears);
//!             for region in plan.regions_of(pass) {
//!                 let (viewport, scissor) = (region.part.viewport(), region.part.stored);
//!                 println!("  draw {:?} at {viewport} within {scissor:?}", plan.casters_of(region));
//!             }
//!         }
//!         // Shaders read `plan.maps`: matrices, biases and `texel_offset`.
//!         # assert!(frame == 0 || plan.passes.iter().all(|pass| !pass.clears));
//!     }
//!     Ok(())
//! }
//! ```
//!
//! # Carrying out a pass
//!
//! 1. Bind the pass's [layer](PassPlan::layer) of its map as depth attachment. Clear it if
//!    [`PassPlan::clears`] is set.
//! 2. Write the far depth into the [cleared](PassPlan::cleared) rectangles.
//! 3. Copy the [mended](PassPlan::mended) rectangles from the static casters' layer. Copy the texels that the
//!    [mended boxes](PassPlan::mended_boxes) cover too, once for each of the
//!    [viewports](PassPlan::viewports).
//! 4. For each [region](FramePlan::regions_of) set viewport and scissor rectangle, and draw its casters with
//!    the map's [`clip_from_world`](crate::LightProjection::clip_from_world).
//!
//! # Memory
//!
//! Steady frames do not allocate, even while the camera and casters move. Buffers grow with the number of
//! casters. Changes of static casters allocate.

mod casters;
mod drawing;
mod frame;
mod identity;
mod order;
mod plan;
mod price;
mod schedule;
mod settings;
mod stale;
mod state;
mod tiles;
mod updates;
mod volumes;
mod world_box;

use alloc::vec;
use alloc::vec::Vec;

use glam::DVec3;

use crate::scroll::TexelRect;
use crate::selection::MapOrder;
use crate::settings::MAX_MAPS;
use crate::{Aabb, CasterVolume, FitError, FittedMap};

use casters::{Changes, KnownCasters};
use drawing::{Buffers, Drawing};
use schedule::Candidate;
use state::{MapState, Transition};

pub use casters::Casters;
pub use frame::{CacheFrame, InView};
pub use plan::{FramePlan, Layer, MapReuse, PassKind, PassPlan, RegionPlan};
pub use schedule::UpdateSchedule;
pub use settings::{CacheSettings, Culling};
pub use stale::StaleMap;
pub use updates::{UpdateKind, UpdatedRect};
pub use volumes::RegionVolumes;
pub use world_box::WorldBox;

/// The content of the layers of one light's maps. Plans the passes of each frame.
#[derive(Debug, Default)]
pub struct MapCache {
    /// Settings. They may change between any two frames.
    pub settings: CacheSettings,
    maps: [MapState; MAX_MAPS],
    known: KnownCasters,
    /// Number of the frame.
    frame: u64,
    /// Whether static casters have separate layers. True from the first moving caster on.
    has_static_layers: bool,
    plan: FramePlan,
    choice: Choice,
    buffers: Buffers,
}

/// The maps that shaders read in a frame. Some of them were drawn in an earlier frame.
#[derive(Debug, Default)]
struct Choice {
    transitions: Vec<Transition>,
    maps: Vec<FittedMap>,
    /// Redrawn rectangles of all maps.
    rects: Vec<TexelRect>,
    /// The casters of each map that can shadow something in view.
    in_view: Vec<CasterVolume>,
    candidates: Vec<Candidate>,
}

impl MapCache {
    /// Returns a cache for empty layers.
    pub fn new(settings: CacheSettings) -> Self {
        Self { settings, ..Self::default() }
    }

    /// Plans the passes of a frame. The next call assumes that they were executed.
    ///
    /// The first moving caster makes [separate layers](Self::has_static_layers) for the static casters
    /// necessary.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`caster_volumes`](crate::culling::caster_volumes) for invalid views, and
    /// [`FitError::NoView`] if passes depend on the views and there are none. The frame then has no passes,
    /// and shaders keep reading the maps of the previous frame.
    pub fn update(&mut self, frame: &CacheFrame<'_>) -> Result<&FramePlan, FitError> {
        self.skip();
        // 1. Find the places where static casters changed.
        self.take(frame);
        // 2. Choose the maps to draw. The others are read unchanged.
        let is_due = self.due(frame)?;
        self.choose(frame, is_due);
        // 3. Find the casters of each map.
        let depends_on_view = self.depends_on_view();
        let Choice { maps, in_view, .. } = &mut self.choice;
        volumes::find(&self.settings, frame, maps, depends_on_view, in_view)?;
        // 4. Write the passes.
        self.write_plan(frame, depends_on_view);
        Ok(&self.plan)
    }

    /// Returns the plan of the last [update](Self::update).
    pub fn plan(&self) -> &FramePlan {
        &self.plan
    }

    /// Removes all passes of the frame. The maps to read stay.
    pub fn skip(&mut self) {
        self.plan.clear_passes();
    }

    /// Removes all passes and all maps to read, such as for a light that is switched off. The layers keep
    /// their content.
    pub fn turn_off(&mut self) {
        self.skip();
        self.plan.maps.clear();
        self.plan.reuse.clear();
        self.plan.in_view.clear();
    }

    /// Makes the next update redraw all maps, such as after a frame whose passes were not submitted.
    pub fn invalidate_all(&mut self) {
        self.maps.fill_with(MapState::default);
    }

    /// Makes the next update redraw the static casters in a box. Call it for a caster that changes its shape
    /// within the same box. The box is in metres, relative to an origin in world space. An empty box has no
    /// effect.
    pub fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        let changed = WorldBox::new(aabb, origin);
        if !changed.is_empty() {
            self.change(&Changes { gone: vec![changed], ..Changes::default() });
        }
    }

    /// Returns whether static casters have separate layers, one per map, of the same size as the shown layer.
    /// While caching is on, this becomes true with the first moving caster.
    ///
    /// Create the layers after the first [`Self::update`] that makes it true. If memory is short, turn
    /// [caching](CacheSettings::caching) off and update a new cache with the same frame.
    pub fn has_static_layers(&self) -> bool {
        self.has_static_layers
    }

    /// Returns whether a map's layer holds all static casters over the map, so that later frames can keep it.
    pub fn is_kept(&self, map: usize) -> bool {
        self.maps.get(map).is_some_and(|map| map.layers.is_kept())
    }

    /// Finds the places where static casters changed.
    fn take(&mut self, frame: &CacheFrame<'_>) {
        let changes = self.known.update(&frame.casters, frame.static_boxes);
        self.change(&changes);
        self.has_static_layers |= self.settings.caching && !self.known.moving.is_empty();
        self.frame += 1;
    }

    fn change(&mut self, changes: &Changes) {
        for map in &mut self.maps {
            map.layers.change(changes);
        }
    }

    /// Chooses the maps to draw. The others are read unchanged. `is_due` marks the maps that must not wait.
    fn choose(&mut self, frame: &CacheFrame<'_>, is_due: [bool; MAX_MAPS]) {
        let Choice { transitions, maps, rects, candidates, .. } = &mut self.choice;
        transitions.clear();
        maps.clear();
        rects.clear();
        candidates.clear();
        let (selection, has_moving) = (self.settings.reading.selection, !self.known.moving.is_empty());
        // With selection by coverage, the coarsest map also serves the points outside all other maps.
        let coarsest = MapOrder::new(selection, frame.maps.iter().map(|map| &map.projection)).iter().last();
        for (index, (map, fitted)) in self.maps.iter_mut().zip(frame.maps).enumerate() {
            let transition = map.decide(fitted, &self.settings, frame.casters.boxes.boxes.len(), rects);
            let texels = map.texels(&transition, transition.rects(rects), fitted) + u64::from(has_moving);
            if texels > 0 {
                let serves_others = selection.is_by_coverage() && coarsest != Some(index);
                let is_due = is_due[index] || !map.may_wait(fitted, serves_others);
                candidates.push(Candidate { map: index, age: self.frame - map.frame, texels, is_due });
            }
            map.fitted = Some(*fitted);
            transitions.push(transition);
        }
        let is_drawn = self.settings.schedule.choose(self.frame, candidates);
        for waiting in candidates.iter().filter(|candidate| !is_drawn[candidate.map]) {
            transitions[waiting.map] = Transition::Wait;
        }
        let read = self.maps.iter().zip(frame.maps).zip(transitions);
        maps.extend(read.map(|((map, fitted), transition)| map.shown(fitted, transition)));
    }

    /// Returns whether the passes depend on the views. Passes of static casters alone do not.
    fn depends_on_view(&self) -> bool {
        let has_moving = !self.known.moving.is_empty();
        self.choice.transitions.iter().any(|transition| match transition {
            Transition::Wait => false,
            Transition::DrawOnce => true,
            Transition::Update { .. } | Transition::Renew => has_moving,
        })
    }

    /// Writes the passes of the chosen maps.
    fn write_plan(&mut self, frame: &CacheFrame<'_>, depends_on_view: bool) {
        let Self { choice, plan, .. } = self;
        core::mem::swap(&mut plan.maps, &mut choice.maps);
        core::mem::swap(&mut plan.in_view, &mut choice.in_view);
        plan.origin = frame.reader.origin;
        plan.reuse.clear();
        plan.reuse.extend(choice.transitions.iter().map(Transition::reuse));
        for (index, transition) in choice.transitions.iter().enumerate() {
            let map = &mut self.maps[index];
            let fitted = plan.maps[index];
            let in_view = plan.in_view[index];
            let mut drawing = Drawing {
                index,
                fitted: &fitted,
                known: &self.known,
                casters: &frame.casters,
                static_boxes: frame.static_boxes,
                to_light: -frame.direction.normalize_or_zero(),
                origin: frame.reader.origin,
                in_view: if depends_on_view { in_view } else { CasterVolume::everywhere(fitted.projection.origin) },
                settings: &self.settings,
                plan: &mut *plan,
                buffers: &mut self.buffers,
            };
            drawing.plan(map, transition, transition.rects(&choice.rects));
            if *transition != Transition::Wait {
                map.frame = self.frame;
            }
        }
    }
}

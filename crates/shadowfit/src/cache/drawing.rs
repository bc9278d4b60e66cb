//! The passes of one map.

use alloc::vec::Vec;
use core::mem::take;
use core::ops::Range;

use glam::{DVec3, Vec3};

use super::casters::{Casters, KnownCasters};
use super::order::sort;
use super::plan::{FramePlan, Layer, PassKind, PassPlan, RegionPlan};
use super::settings::{CacheSettings, Culling};
use super::state::{Layers, MapState, Transition};
use super::world_box::WorldBox;
use crate::culling::cull;
use crate::scroll::{StoredRect, TexelRect};
use crate::{Aabb, Boxes, CasterVolume, FittedMap, StaticBoxes};

/// Number of volumes that casters are tested against at once: one bit of a mask each.
const VOLUMES: usize = 8;

/// Texels that widen the box of a moved caster before the layer is restored there. Rasterisers round
/// by less.
const MENDED_AROUND: f32 = 2.0;

/// Rounding that lets a shader keep a caster whose box the CPU culls, as a share of the coordinates. CPU and
/// shader each allow for 16 · 2⁻²⁴ of the coordinates. The summed coordinates of a box are at least half of
/// those of a caster in it.
const SHADER_ROUNDING: f32 = 64.0 / 16_777_216.0;

/// Buffers that are kept between frames.
#[derive(Debug, Default)]
pub(super) struct Buffers {
    /// The stored pieces of a whole map, and its redrawn pieces.
    whole: Vec<StoredRect>,
    redrawn: Vec<StoredRect>,
    /// A mask for each listed caster: one bit per volume that it touches.
    masks: Vec<u8>,
    /// Static casters that touch some volumes, with the same masks.
    static_masks: Vec<(u32, u8)>,
    /// Sort keys of casters.
    order: Vec<u64>,
    /// The boxes of moving casters and their masks. The first bit is the view, each further bit a part of the
    /// map.
    moving_boxes: Vec<Aabb>,
    moving_masks: Vec<u8>,
    /// Static casters near the redrawn parts.
    near: Vec<u32>,
    near_boxes: Vec<Aabb>,
}

/// The passes of one map of a frame.
pub(super) struct Drawing<'a> {
    pub(super) index: usize,
    /// The map that shaders read.
    pub(super) fitted: &'a FittedMap,
    pub(super) known: &'a KnownCasters,
    pub(super) casters: &'a Casters<'a>,
    pub(super) static_boxes: Option<&'a StaticBoxes>,
    /// Unit direction toward the light.
    pub(super) to_light: Vec3,
    /// Origin of positions in the shaders, in world space, in metres.
    pub(super) origin: DVec3,
    /// Casters that can shadow something in view. All casters if no pass needs this volume.
    pub(super) in_view: CasterVolume,
    pub(super) settings: &'a CacheSettings,
    pub(super) plan: &'a mut FramePlan,
    pub(super) buffers: &'a mut Buffers,
}

impl Drawing<'_> {
    /// Adds the passes of a transition, which redraws `rects`, and updates the state of the map's layers.
    pub(super) fn plan(&mut self, state: &mut MapState, transition: &Transition, rects: &[TexelRect]) {
        let was_split = state.layers.is_split();
        match transition {
            Transition::Wait => {}
            Transition::DrawOnce => {
                let mut drawn = state.layers.redraw(self.fitted);
                drawn.moving.clear();
                self.casters_in_view();
                state.layers = Layers::OneFrame(drawn);
            }
            Transition::Renew => {
                let mut drawn = state.layers.redraw(self.fitted);
                state.over = self.all_casters(&mut drawn.moving);
                state.layers = Layers::Kept(drawn);
            }
            Transition::Update { .. } => {
                let mut drawn = state.layers.redraw(self.fitted);
                let is_split = self.update(&mut drawn.moving, was_split, rects);
                state.layers = if is_split { Layers::Split(drawn) } else { Layers::Kept(drawn) };
            }
        }
    }

    /// Adds one pass with all casters that can shadow something in view.
    fn casters_in_view(&mut self) {
        let volume = self.in_view;
        self.cull(&[volume]);
        let (known, casters) = (self.known, self.casters);
        let casts = |number: u32| known.is_fixed(number) || casters.moves(number as usize);
        self.whole_map(PassKind::All, &volume, |number, mask| mask != 0 && casts(number));
    }

    /// Adds one pass with all static casters over the map and the moving casters in view. Returns the number
    /// of static casters.
    fn all_casters(&mut self, moving: &mut Vec<WorldBox>) -> usize {
        let whole = StoredRect { window: self.whole(), stored: self.whole() };
        let over = self.volume(whole.window);
        self.cull(&[over, self.in_view]);
        self.find_moving(&[whole], moving);
        for (number, mask) in self.known.moving.iter().zip(&self.buffers.moving_masks) {
            self.buffers.masks[*number as usize] = *mask;
        }
        let (known, casters) = (self.known, self.casters);
        let moves = |number: u32| casters.moves(number as usize);
        let is_over =
            |number: u32, mask: u8| (mask & 1 == 1 && known.is_fixed(number)) || (mask == 0b11 && moves(number));
        let content = if moving.is_empty() { PassKind::Static } else { PassKind::All };
        self.whole_map(content, &over, is_over) - moving.len()
    }

    /// Adds a pass that clears the shown layer, then draws the static boxes in a volume and the listed
    /// casters that `is_over` accepts by number and mask. Returns the number of casters.
    fn whole_map(
        &mut self,
        content: PassKind,
        static_boxes: &CasterVolume,
        is_over: impl Fn(u32, u8) -> bool,
    ) -> usize {
        let (region, first) = (self.plan.regions.len(), self.plan.casters.len());
        let over = (0..).zip(&self.buffers.masks).filter(|(number, mask)| is_over(*number, **mask));
        self.plan.casters.extend(over.map(|(number, _)| number));
        self.find_static_boxes(core::slice::from_ref(static_boxes));
        self.region(StoredRect { window: self.whole(), stored: self.whole() }, first, 0);
        self.pass(content, Layer::Shown, true, region);
        let region = &self.plan.regions[region];
        region.casters.len() + region.static_boxes.len()
    }

    /// Adds a region with the planned casters from index `first` on, and the static boxes whose mask has this
    /// bit.
    fn region(&mut self, part: StoredRect, first: usize, bit: usize) {
        let (plan, order) = (&mut *self.plan, &mut self.buffers.order);
        let static_boxes = plan.static_boxes.len();
        let is_over = |(_, mask): &&(u32, u8)| mask >> bit & 1 == 1;
        plan.static_boxes.extend(self.buffers.static_masks.iter().filter(is_over).map(|(number, _)| *number));
        let boxes = self.casters.boxes.boxes;
        sort(&mut plan.casters[first..], self.to_light, order, |number| boxes[number as usize]);
        if let Some(tree) = self.static_boxes {
            let aabb = |number| tree.get(number).unwrap_or(Aabb::EMPTY);
            sort(&mut plan.static_boxes[static_boxes..], self.to_light, order, aabb);
        }
        let (casters, static_boxes) = (first..plan.casters.len(), static_boxes..plan.static_boxes.len());
        plan.regions.push(RegionPlan { part, casters, static_boxes });
    }

    /// Finds the static casters that touch some volumes.
    fn find_static_boxes(&mut self, volumes: &[CasterVolume]) {
        let masks = &mut self.buffers.static_masks;
        masks.clear();
        if let Some(tree) = self.static_boxes {
            tree.cull(volumes, |number, mask| masks.push((number, mask)));
        }
    }

    /// Adds the passes that redraw rectangles of a kept map: static casters, then moving ones. `moving` are
    /// the moving casters in the shown layer. Returns whether static casters have a separate layer from now
    /// on. The first moving caster over the map makes it necessary.
    fn update(&mut self, moving: &mut Vec<WorldBox>, was_split: bool, rects: &[TexelRect]) -> bool {
        let FittedMap { projection, texel_offset, .. } = self.fitted;
        let (mut whole, mut redrawn) = (take(&mut self.buffers.whole), take(&mut self.buffers.redrawn));
        whole.clear();
        whole.extend(self.whole().stored(*texel_offset, projection.resolution));
        redrawn.clear();
        redrawn.extend(rects.iter().flat_map(|rect| rect.stored(*texel_offset, projection.resolution)));
        let first_box = self.plan.boxes.len();
        let (origin, texel) = (self.origin, projection.texel_size.max_element());
        let moved = moving.iter().filter(|moved| !moved.is_empty());
        self.plan.boxes.extend(moved.map(|moved| mended(moved, origin, texel)));
        let mended_boxes = first_box..self.plan.boxes.len();
        self.find_moving(&whole, moving);
        let is_split = was_split || !mended_boxes.is_empty() || !moving.is_empty();
        match (was_split, is_split) {
            (_, false) => self.static_casters(&redrawn, Layer::Shown, false),
            (true, _) => self.static_casters(&redrawn, Layer::Static, false),
            (false, true) => self.static_casters(&whole, Layer::Static, true),
        }
        if is_split {
            self.moving_casters(&whole, &redrawn, mended_boxes);
        }
        (self.buffers.whole, self.buffers.redrawn) = (whole, redrawn);
        is_split
    }

    /// Adds a pass with the static casters of some parts, unless the list is empty. It clears the whole layer
    /// if `clears` is set, otherwise only the parts.
    fn static_casters(&mut self, parts: &[StoredRect], layer: Layer, clears: bool) {
        if parts.is_empty() {
            return;
        }
        let (region, first_rect) = (self.plan.regions.len(), self.plan.rects.len());
        self.cull_static(parts);
        if !clears {
            self.plan.rects.extend(parts.iter().map(|part| part.stored));
        }
        let last_rect = self.plan.rects.len();
        self.pass(PassKind::Static, layer, clears, region).cleared = first_rect..last_rect;
    }

    /// Adds a region for each part, with the static casters over it.
    fn cull_static(&mut self, parts: &[StoredRect]) {
        // Cull against the rectangle around all parts first.
        let around = parts.iter().map(|part| part.window).reduce(TexelRect::union).unwrap_or_default();
        let Boxes { origin, boxes } = self.casters.boxes;
        self.cull(&[self.volume(around)]);
        let known = self.known;
        let Buffers { masks, near, near_boxes, .. } = &mut *self.buffers;
        let is_over = |(number, mask): &(u32, &u8)| **mask != 0 && known.is_fixed(*number);
        near.clear();
        near.extend((0..).zip(&*masks).filter(is_over).map(|(number, _)| number));
        near_boxes.clear();
        near_boxes.extend(near.iter().map(|number| boxes[*number as usize]));
        for parts in parts.chunks(VOLUMES) {
            let (volumes, count) = self.volumes(parts.iter().map(|part| self.volume(part.window)));
            let Buffers { masks, near_boxes, .. } = &mut *self.buffers;
            cull(&volumes[..count], origin, near_boxes, masks);
            self.find_static_boxes(&volumes[..count]);
            for (bit, part) in parts.iter().enumerate() {
                let first = self.plan.casters.len();
                let Buffers { masks, near, .. } = &*self.buffers;
                let is_over = |(_, mask): &(&u32, &u8)| **mask >> bit & 1 == 1;
                self.plan.casters.extend(near.iter().zip(masks).filter(is_over).map(|(number, _)| *number));
                self.region(*part, first, bit);
            }
        }
    }

    /// Finds the moving casters in view over the map, and the parts of the map that each of them touches.
    fn find_moving(&mut self, parts: &[StoredRect], moving: &mut Vec<WorldBox>) {
        let Boxes { origin, boxes } = self.casters.boxes;
        let (volumes, count) =
            self.volumes([self.in_view].into_iter().chain(parts.iter().map(|part| self.volume(part.window))));
        let Buffers { moving_boxes, moving_masks, .. } = &mut *self.buffers;
        moving.clear();
        moving_boxes.clear();
        let offset = (origin - self.origin).abs().element_sum() as f32;
        let widened = |number: &u32| widened(&boxes[*number as usize], offset);
        moving_boxes.extend(self.known.moving.iter().map(widened));
        moving_masks.clear();
        moving_masks.resize(moving_boxes.len(), 0);
        cull(&volumes[..count], origin, moving_boxes, moving_masks);
        for (aabb, mask) in moving_boxes.iter().zip(moving_masks) {
            if *mask & 1 == 1 && *mask >> 1 != 0 {
                moving.push(WorldBox::new(aabb, origin));
            }
        }
    }

    /// Adds a pass that restores the shown layer and draws the moving casters that were found. Adds none if
    /// both are unnecessary. `redrawn` are the parts in which this frame draws static casters. `boxes` are
    /// the places where an earlier frame drew moving casters.
    fn moving_casters(&mut self, parts: &[StoredRect], redrawn: &[StoredRect], boxes: Range<usize>) {
        let (region, first_rect, first_viewport) =
            (self.plan.regions.len(), self.plan.rects.len(), self.plan.viewports.len());
        self.plan.rects.extend(redrawn.iter().map(|part| part.stored));
        if !boxes.is_empty() {
            self.plan.viewports.extend(parts.iter().map(StoredRect::viewport));
        }
        self.buffers.static_masks.clear();
        for (index, part) in parts.iter().enumerate() {
            let first = self.plan.casters.len();
            let bits = 1 | 2 << index;
            let masked = self.known.moving.iter().zip(&self.buffers.moving_masks);
            let numbers = masked.filter(|(_, mask)| **mask & bits == bits);
            self.plan.casters.extend(numbers.map(|(number, _)| *number));
            if self.plan.casters.len() > first {
                self.region(*part, first, 0);
            }
        }
        if redrawn.is_empty() && boxes.is_empty() && self.plan.regions.len() == region {
            return;
        }
        let (last_rect, last_viewport) = (self.plan.rects.len(), self.plan.viewports.len());
        let pass = self.pass(PassKind::Moving, Layer::Shown, false, region);
        pass.mended = first_rect..last_rect;
        pass.mended_boxes = boxes;
        pass.viewports = first_viewport..last_viewport;
    }

    /// Tests all listed casters against some volumes.
    fn cull(&mut self, volumes: &[CasterVolume]) {
        let Boxes { origin, boxes } = self.casters.boxes;
        self.buffers.masks.clear();
        self.buffers.masks.resize(boxes.len(), 0);
        cull(volumes, origin, boxes, &mut self.buffers.masks);
    }

    /// Returns up to [`VOLUMES`] volumes as an array, and their number.
    fn volumes(&self, volumes: impl Iterator<Item = CasterVolume>) -> ([CasterVolume; VOLUMES], usize) {
        let (mut array, mut count) = ([CasterVolume::everywhere(self.origin); VOLUMES], 0);
        for (slot, volume) in array.iter_mut().zip(volumes) {
            *slot = volume;
            count += 1;
        }
        (array, count)
    }

    /// Returns the rectangle of all texels.
    fn whole(&self) -> TexelRect {
        TexelRect::all(self.fitted.projection.resolution)
    }

    /// Returns the volume of all casters over a part of the map.
    fn volume(&self, part: TexelRect) -> CasterVolume {
        if self.settings.culling == Culling::Off {
            return CasterVolume::everywhere(self.fitted.projection.origin);
        }
        CasterVolume::of_part(&self.fitted.projection, self.settings.caster_policy(), part)
    }

    /// Adds a pass with the regions from `first_region` on.
    fn pass(&mut self, content: PassKind, layer: Layer, clears: bool, first_region: usize) -> &mut PassPlan {
        let pass = PassPlan {
            map: self.index,
            content,
            layer,
            clears,
            cleared: 0..0,
            mended: 0..0,
            mended_boxes: 0..0,
            viewports: 0..0,
            regions: first_region..self.plan.regions.len(),
            size: self.fitted.projection.resolution,
        };
        self.plan.passes.push(pass);
        let last = self.plan.passes.len() - 1;
        &mut self.plan.passes[last]
    }
}

/// Returns the box of moving casters, widened by rounding errors. If a shader draws any caster in it, the box
/// passes the CPU's test too, so that the next frame restores it. `offset` is the distance between the box's
/// origin and the shader's origin, in metres, summed over the axes.
fn widened(aabb: &Aabb, offset: f32) -> Aabb {
    if aabb.is_empty() {
        return Aabb::EMPTY;
    }
    let by = ((aabb.min.abs() + aabb.max.abs()).element_sum() + offset) * SHADER_ROUNDING;
    Aabb::new(aabb.min - by, aabb.max + by)
}

/// Returns a box around all places where a moved caster may have been drawn, relative to the shaders' origin.
/// `texel` is the width of a texel, in metres.
fn mended(moved: &WorldBox, origin: DVec3, texel: f32) -> Aabb {
    let aabb = moved.relative_to(origin);
    let around = MENDED_AROUND * texel;
    Aabb::new(aabb.min - around, aabb.max + around)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3, Vec4};

    use super::*;

    /// Returns numbers in 0..1 that fill the cube evenly.
    fn evenly(index: u32, axis: i32) -> f32 {
        (f64::from(index) * 1.220_744_084_605_759_5_f64.powi(-axis)).fract() as f32
    }

    #[test]
    fn whatever_a_shader_keeps_of_a_box_of_casters_the_widened_box_keeps() {
        let mut lost_without = 0;
        for i in 1..20_000 {
            let [x, y, z, a] = [1, 2, 3, 4].map(|axis| evenly(i, axis));
            let normal = (Vec3::new(x, y, z) - 0.5).normalize_or(Vec3::Y);
            // A caster in the farthest corner of a box along the normal. The box's opposite corner is the
            // origin.
            let corner = Vec3::new(a, x, y) * 300.0 * normal.signum();
            let group = Aabb::new(corner.min(Vec3::ZERO), corner.max(Vec3::ZERO));
            let caster = Aabb::new(corner.min(corner * 0.99), corner.max(corner * 0.99));
            // The plane lies beyond the corner, by at most the rounding of both tests.
            let reach = normal.as_dvec3().dot(corner.as_dvec3()) as f32;
            let beyond = corner.abs().element_sum() * 2.0 * evenly(i, 5) * 16.0 / 16_777_216.0;
            let mut volume = CasterVolume::everywhere(DVec3::ZERO);
            (volume.planes[0], volume.count) = (Vec4::from((normal, -reach - beyond)), 1);
            let touches = |aabb: &Aabb| volume.intersects_aabb(aabb.min, aabb.max);
            if touches(&caster) {
                assert!(touches(&widened(&group, 0.0)), "{i}");
                lost_without += u32::from(!touches(&group));
            }
        }
        assert!(lost_without > 100, "{lost_without} are lost without widening");
        assert!(widened(&Aabb::EMPTY, 1.0).is_empty());
    }
}

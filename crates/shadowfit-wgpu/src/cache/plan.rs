//! The passes of a frame, as data: which rectangles are drawn, with which casters.

use core::ops::Range;

use shadowfit::culling::cull;
use shadowfit::glam::{DVec3, IVec2, UVec2, Vec3};
use shadowfit::scroll::{StoredRect, TexelRect};
use shadowfit::settings::CasterPolicy;
use shadowfit::{Aabb, BoxTree, Boxes, CasterVolume, FittedMap};

use super::casters::{KnownCasters, WorldBox, sort};
use super::{CacheSettings, Casters, Culling, Decision, KeptMap};

/// Volumes that casters are tested against at once: the bits of a mask.
const VOLUMES: usize = 8;

/// Texels by which the box of a caster that moved is widened before the layer is restored there: the rasteriser rounds
/// by less.
const MENDED_AROUND: f32 = 2.0;

/// Which of a map's layers a pass draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Layer {
    /// The layer that points read.
    Shown,
    /// The layer of the static casters.
    Static,
}

/// What a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PassContent {
    /// All casters, static and moving: no part of the map is kept.
    All,
    /// All static casters, where the map is new or one of them changed.
    Static,
    /// Moving casters, over the static ones.
    Moving,
}

/// A pass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PassPlan {
    pub(crate) map: usize,
    pub(crate) content: PassContent,
    pub(crate) layer: Layer,
    /// Whether the layer is cleared; otherwise it is loaded.
    pub(crate) clears: bool,
    /// Rectangles of the layer that are cleared first, as they are stored: a range of [`FramePlan::rects`].
    pub(crate) cleared: Range<usize>,
    /// Rectangles of the layer that are first taken from the static casters' layer, likewise.
    pub(crate) mended: Range<usize>,
    /// Boxes within which the layer is first taken from there: a range of [`FramePlan::boxes`].
    pub(crate) mended_boxes: Range<usize>,
    /// A range of [`FramePlan::pieces`].
    pub(crate) pieces: Range<usize>,
    /// The viewports in which the boxes are restored: a range of [`FramePlan::views`].
    pub(crate) views: Range<usize>,
    /// Width and height of the map, in texels.
    pub(crate) size: UVec2,
}

/// A part of a pass that is drawn with one viewport.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PiecePlan {
    pub(crate) part: StoredRect,
    /// A range of [`FramePlan::casters`].
    pub(crate) casters: Range<usize>,
    /// A range of [`FramePlan::standing`].
    pub(crate) standing: Range<usize>,
}

/// The passes of a frame.
#[derive(Debug, Default)]
pub(crate) struct FramePlan {
    pub(crate) passes: Vec<PassPlan>,
    pub(crate) pieces: Vec<PiecePlan>,
    pub(crate) casters: Vec<u32>,
    pub(crate) standing: Vec<u32>,
    pub(crate) rects: Vec<TexelRect>,
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) views: Vec<IVec2>,
    masks: Vec<u8>,
    /// Standing casters in some volumes, with a bit for each.
    standing_masks: Vec<(u32, u8)>,
    /// What casters are sorted by.
    order: Vec<u64>,
    moving_boxes: Vec<Aabb>,
    moving_masks: Vec<u8>,
}

impl FramePlan {
    pub(crate) fn clear(&mut self) {
        self.passes.clear();
        self.pieces.clear();
        self.casters.clear();
        self.standing.clear();
        self.rects.clear();
        self.boxes.clear();
        self.views.clear();
    }
}

/// Rounding by which a shader may keep a caster in a box that the CPU culls, as a share of their coordinates: each
/// allows for 16 · 2⁻²⁴ of them, and the coordinates of a box sum to half of those of a caster in it at least.
const SHADER_ROUNDING: f32 = 64.0 / 16_777_216.0;

/// A box of moving casters that holds whatever a shader may draw of them, so that it is mended in the next frame.
/// `offset` lies between its origin and that of the shader's boxes, in metres along all axes together.
fn widened(aabb: &Aabb, offset: f32) -> Aabb {
    if aabb.is_empty() {
        return Aabb::EMPTY;
    }
    let by = ((aabb.min.abs() + aabb.max.abs()).element_sum() + offset) * SHADER_ROUNDING;
    Aabb::new(aabb.min - by, aabb.max + by)
}

/// One map of a frame.
pub(super) struct Drawing<'a> {
    pub(super) index: usize,
    /// The map that is read.
    pub(super) fitted: &'a FittedMap,
    pub(super) known: &'a KnownCasters,
    pub(super) casters: &'a Casters<'a>,
    pub(super) standing: Option<&'a BoxTree>,
    /// Unit direction toward the light.
    pub(super) to_light: Vec3,
    /// Origin of positions in the shaders, in world space, in metres.
    pub(super) origin: DVec3,
    /// Casters that can shadow something in view; `None` where no pass needs them.
    pub(super) in_view: Option<&'a CasterVolume>,
    pub(super) settings: &'a CacheSettings,
}

impl Drawing<'_> {
    /// Adds the map's passes, and updates the content of its layers.
    pub(super) fn plan(&self, map: &mut KeptMap, decision: &Decision, plan: &mut FramePlan) {
        let size = self.fitted.projection.resolution;
        match decision {
            Decision::Wait => return,
            Decision::DrawAnew => {
                (map.wrap, map.is_kept, map.is_split) = (UVec2::ZERO, false, false);
                map.moving.clear();
                self.casters_in_view(plan);
            }
            Decision::Renew => {
                (map.wrap, map.is_kept, map.is_split) = (UVec2::ZERO, true, false);
                self.all_casters(map, plan);
            }
            Decision::Keep { wrap, rects } => {
                map.wrap = *wrap;
                self.kept(map, rects, plan);
            }
        }
        map.drawn = Some(*self.fitted);
        map.changed.clear();
        map.gone.clear();
        debug_assert!(map.wrap.cmplt(size).all());
    }

    /// One pass with all casters that can shadow something in view.
    fn casters_in_view(&self, plan: &mut FramePlan) {
        let volumes = [self.in_view()];
        self.cull(&volumes, plan);
        let casts = |number: u32| self.known.is_fixed(number) || self.casters.moves(number as usize);
        self.whole_map(PassContent::All, &volumes, |number, mask| mask != 0 && casts(number), plan);
    }

    /// One pass with all static casters over the map, and what moves in view.
    fn all_casters(&self, map: &mut KeptMap, plan: &mut FramePlan) {
        let volumes = [self.volume(self.whole()), self.in_view()];
        self.cull(&volumes, plan);
        let whole = StoredRect { window: self.whole(), stored: self.whole() };
        self.find_moving(&[whole], &mut map.moving, plan);
        for (number, mask) in self.known.moving.iter().zip(&plan.moving_masks) {
            plan.masks[*number as usize] = *mask;
        }
        let moves = |number: u32| self.casters.moves(number as usize);
        let is_over =
            |number: u32, mask: u8| (mask & 1 == 1 && self.known.is_fixed(number)) || (mask == 0b11 && moves(number));
        let content = if map.moving.is_empty() { PassContent::Static } else { PassContent::All };
        let drawn = self.whole_map(content, &volumes[..1], is_over, plan);
        map.over = drawn - map.moving.len();
    }

    /// A pass that clears the shown layer and draws the casters of the list that are chosen by their numbers and masks,
    /// and the standing ones in a volume. Returns their number.
    fn whole_map(
        &self,
        content: PassContent,
        standing: &[CasterVolume],
        is_over: impl Fn(u32, u8) -> bool,
        plan: &mut FramePlan,
    ) -> usize {
        let piece = plan.pieces.len();
        let over = (0..).zip(&plan.masks).filter(|(number, mask)| is_over(*number, **mask));
        let casters = plan.casters.len();
        plan.casters.extend(over.map(|(number, _)| number));
        self.find_standing(standing, &mut plan.standing_masks);
        self.piece(StoredRect { window: self.whole(), stored: self.whole() }, casters, 0, plan);
        self.pass(plan, (content, Layer::Shown, true), piece);
        plan.pieces[piece].casters.len() + plan.pieces[piece].standing.len()
    }

    /// Adds a piece with the casters from this one on, and those standing ones that have a bit in their masks.
    fn piece(&self, part: StoredRect, casters: usize, bit: usize, plan: &mut FramePlan) {
        let standing = plan.standing.len();
        let is_over = |(_, mask): &&(u32, u8)| mask >> bit & 1 == 1;
        plan.standing.extend(plan.standing_masks.iter().filter(is_over).map(|(number, _)| *number));
        let boxes = self.casters.boxes.boxes;
        sort(&mut plan.casters[casters..], self.to_light, &mut plan.order, |number| boxes[number as usize]);
        if let Some(tree) = self.standing {
            let aabb = |number| tree.get(number).unwrap_or(Aabb::EMPTY);
            sort(&mut plan.standing[standing..], self.to_light, &mut plan.order, aabb);
        }
        let (casters, standing) = (casters..plan.casters.len(), standing..plan.standing.len());
        plan.pieces.push(PiecePlan { part, casters, standing });
    }

    /// Finds the standing casters in some volumes.
    fn find_standing(&self, volumes: &[CasterVolume], masks: &mut Vec<(u32, u8)>) {
        masks.clear();
        if let Some(tree) = self.standing {
            tree.cull(volumes, |number, mask| masks.push((number, mask)));
        }
    }

    /// The passes of a map that is kept but for some rectangles: static casters, then what moves. The static ones have
    /// a layer of their own from the first frame in which something moves over the map.
    fn kept(&self, map: &mut KeptMap, rects: &[TexelRect], plan: &mut FramePlan) {
        let whole: Vec<StoredRect> = self.stored(&[self.whole()], map.wrap);
        let drawn = self.stored(rects, map.wrap);
        let first_box = plan.boxes.len();
        plan.boxes.extend(map.moving.iter().filter(|moved| !moved.is_empty()).map(|moved| self.mended(moved)));
        let mended_boxes = first_box..plan.boxes.len();
        self.find_moving(&whole, &mut map.moving, plan);
        if !map.is_split && mended_boxes.is_empty() && map.moving.is_empty() {
            self.static_casters(&drawn, (Layer::Shown, false), plan);
            return;
        }
        if map.is_split {
            self.static_casters(&drawn, (Layer::Static, false), plan);
        } else {
            self.static_casters(&whole, (Layer::Static, true), plan);
            map.is_split = true;
        }
        self.moving_casters(&whole, &drawn, mended_boxes, plan);
    }

    /// A pass with the static casters of some parts, if there are any. It `clears` all of the layer, or the parts.
    fn static_casters(&self, parts: &[StoredRect], (layer, clears): (Layer, bool), plan: &mut FramePlan) {
        if parts.is_empty() {
            return;
        }
        let (piece, first_rect) = (plan.pieces.len(), plan.rects.len());
        self.cull_static(parts, plan);
        if !clears {
            plan.rects.extend(parts.iter().map(|part| part.stored));
        }
        self.pass(plan, (PassContent::Static, layer, clears), piece);
        if let Some(pass) = plan.passes.last_mut() {
            pass.cleared = first_rect..plan.rects.len();
        }
    }

    /// Adds pieces with the static casters over them.
    fn cull_static(&self, parts: &[StoredRect], plan: &mut FramePlan) {
        // First those over any of the parts.
        let around = parts.iter().map(|part| part.window).reduce(TexelRect::union).unwrap_or_default();
        let Boxes { origin, boxes } = self.casters.boxes;
        self.cull(&[self.volume(around)], plan);
        let is_over = |(number, mask): &(u32, &u8)| **mask != 0 && self.known.is_fixed(*number);
        let near: Vec<u32> = (0..).zip(&plan.masks).filter(is_over).map(|(number, _)| number).collect();
        let near_boxes: Vec<Aabb> = near.iter().map(|number| boxes[*number as usize]).collect();
        for parts in parts.chunks(VOLUMES) {
            let volumes: Vec<CasterVolume> = parts.iter().map(|part| self.volume(part.window)).collect();
            cull(&volumes, origin, &near_boxes, &mut plan.masks);
            self.find_standing(&volumes, &mut plan.standing_masks);
            for (bit, part) in parts.iter().enumerate() {
                let first = plan.casters.len();
                let is_over = |(_, mask): &(&u32, &u8)| **mask >> bit & 1 == 1;
                plan.casters.extend(near.iter().zip(&plan.masks).filter(is_over).map(|(number, _)| *number));
                self.piece(*part, first, bit, plan);
            }
        }
    }

    /// Finds the moving casters in view over the map, and which of its parts each lies over.
    fn find_moving(&self, parts: &[StoredRect], moving: &mut Vec<WorldBox>, plan: &mut FramePlan) {
        let Boxes { origin, boxes } = self.casters.boxes;
        moving.clear();
        plan.moving_boxes.clear();
        let offset = (origin - self.origin).abs().element_sum() as f32;
        let widened = |number: &u32| widened(&boxes[*number as usize], offset);
        plan.moving_boxes.extend(self.known.moving.iter().map(widened));
        let mut volumes = vec![self.in_view()];
        volumes.extend(parts.iter().map(|part| self.volume(part.window)));
        plan.moving_masks.clear();
        plan.moving_masks.resize(plan.moving_boxes.len(), 0);
        cull(&volumes, origin, &plan.moving_boxes, &mut plan.moving_masks);
        for (aabb, mask) in plan.moving_boxes.iter().zip(&plan.moving_masks) {
            if mask & 1 == 1 && mask >> 1 != 0 {
                moving.push(WorldBox::new(aabb, origin));
            }
        }
    }

    /// A pass that restores the shown layer and draws over it the moving casters that were found, if there is anything
    /// to do. `drawn`: where static casters were drawn in this frame; `boxes`: where others moved in an earlier one.
    fn moving_casters(&self, parts: &[StoredRect], drawn: &[StoredRect], boxes: Range<usize>, plan: &mut FramePlan) {
        let (piece, first_rect, first_view) = (plan.pieces.len(), plan.rects.len(), plan.views.len());
        plan.rects.extend(drawn.iter().map(|part| part.stored));
        if !boxes.is_empty() {
            plan.views.extend(parts.iter().map(StoredRect::viewport));
        }
        plan.standing_masks.clear();
        for (index, part) in parts.iter().enumerate() {
            let first = plan.casters.len();
            let bits = 1 | 2 << index;
            let numbers = self.known.moving.iter().zip(&plan.moving_masks).filter(|(_, mask)| **mask & bits == bits);
            plan.casters.extend(numbers.map(|(number, _)| *number));
            if plan.casters.len() > first {
                self.piece(*part, first, 0, plan);
            }
        }
        if drawn.is_empty() && boxes.is_empty() && plan.pieces.len() == piece {
            return;
        }
        let (last_rect, last_view) = (plan.rects.len(), plan.views.len());
        self.pass(plan, (PassContent::Moving, Layer::Shown, false), piece);
        if let Some(pass) = plan.passes.last_mut() {
            pass.mended = first_rect..last_rect;
            pass.mended_boxes = boxes;
            pass.views = first_view..last_view;
        }
    }

    /// Tests all casters against some volumes.
    fn cull(&self, volumes: &[CasterVolume], plan: &mut FramePlan) {
        let Boxes { origin, boxes } = self.casters.boxes;
        plan.masks.clear();
        plan.masks.resize(boxes.len(), 0);
        cull(volumes, origin, boxes, &mut plan.masks);
    }

    /// Where rectangles of the map are stored.
    fn stored(&self, rects: &[TexelRect], wrap: UVec2) -> Vec<StoredRect> {
        rects.iter().flat_map(|rect| rect.stored(wrap, self.fitted.projection.resolution)).collect()
    }

    /// Casters that can shadow something in view; all where these are not known.
    fn in_view(&self) -> CasterVolume {
        self.in_view.copied().unwrap_or(CasterVolume::everywhere(self.fitted.projection.origin))
    }

    /// All texels of the map.
    fn whole(&self) -> TexelRect {
        TexelRect::all(self.fitted.projection.resolution)
    }

    /// All casters over a part of the map.
    fn volume(&self, part: TexelRect) -> CasterVolume {
        if self.settings.culling == Culling::Off {
            return CasterVolume::everywhere(self.fitted.projection.origin);
        }
        let casters = if self.settings.depth_clamp { CasterPolicy::DepthClamp } else { CasterPolicy::None };
        CasterVolume::of_part(&self.fitted.projection, casters, part)
    }

    /// The box within which a caster that moved may have been drawn, relative to the shaders' origin.
    fn mended(&self, moved: &WorldBox) -> Aabb {
        let aabb = moved.relative_to(self.origin);
        let around = MENDED_AROUND * self.fitted.projection.texel_size.max_element();
        Aabb::new(aabb.min - around, aabb.max + around)
    }

    fn pass(&self, plan: &mut FramePlan, (content, layer, clears): (PassContent, Layer, bool), first_piece: usize) {
        plan.passes.push(PassPlan {
            map: self.index,
            content,
            layer,
            clears,
            cleared: 0..0,
            mended: 0..0,
            mended_boxes: 0..0,
            pieces: first_piece..plan.pieces.len(),
            views: 0..0,
            size: self.fitted.projection.resolution,
        });
    }
}

#[cfg(test)]
mod tests {
    use shadowfit::glam::{Vec3, Vec4};

    use super::*;

    /// Numbers in 0..1 that fill the cube evenly.
    fn evenly(index: u32, axis: i32) -> f32 {
        (f64::from(index) * 1.220_744_084_605_759_5_f64.powi(-axis)).fract() as f32
    }

    #[test]
    fn whatever_a_shader_keeps_of_a_box_of_casters_the_widened_box_keeps() {
        let mut lost_without = 0;
        for i in 1..20_000 {
            let [x, y, z, a] = [1, 2, 3, 4].map(|axis| evenly(i, axis));
            let normal = (Vec3::new(x, y, z) - 0.5).normalize_or(Vec3::Y);
            // A caster in the farthest corner along the normal of a box whose other corner is at the origin.
            let corner = Vec3::new(a, x, y) * 300.0 * normal.signum();
            let group = Aabb::new(corner.min(Vec3::ZERO), corner.max(Vec3::ZERO));
            let caster = Aabb::new(corner.min(corner * 0.99), corner.max(corner * 0.99));
            // The plane lies beyond the corner by what both tests may round.
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

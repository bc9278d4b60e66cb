//! The passes of a frame, as data: which rectangles are drawn, with which casters.

use core::ops::Range;

use shadowfit::culling::cull;
use shadowfit::glam::{DVec3, IVec2, UVec2};
use shadowfit::scroll::{StoredRect, TexelRect};
use shadowfit::settings::CasterPolicy;
use shadowfit::{Aabb, CasterVolume, FittedMap};

use super::casters::{KnownCasters, WorldBox};
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
    /// All casters that can shadow something in view, static and moving.
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
}

/// The passes of a frame.
#[derive(Debug, Default)]
pub(crate) struct FramePlan {
    pub(crate) passes: Vec<PassPlan>,
    pub(crate) pieces: Vec<PiecePlan>,
    pub(crate) casters: Vec<u32>,
    pub(crate) rects: Vec<TexelRect>,
    pub(crate) boxes: Vec<Aabb>,
    pub(crate) views: Vec<IVec2>,
    masks: Vec<u8>,
    moving_boxes: Vec<Aabb>,
}

impl FramePlan {
    pub(crate) fn clear(&mut self) {
        self.passes.clear();
        self.pieces.clear();
        self.casters.clear();
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
    /// Origin of positions in the shaders, in world space, in metres.
    pub(super) origin: DVec3,
    /// Casters that can shadow something in view; `None` where no pass needs them.
    pub(super) in_view: Option<&'a CasterVolume>,
    pub(super) settings: &'a CacheSettings,
    pub(super) is_split: bool,
}

impl Drawing<'_> {
    /// Adds the map's passes, and updates the content of its layers.
    pub(super) fn plan(&self, map: &mut KeptMap, decision: &Decision, plan: &mut FramePlan) {
        let size = self.fitted.projection.resolution;
        match decision {
            Decision::Wait => return,
            Decision::DrawAnew => {
                (map.wrap, map.is_kept, map.is_shown) = (UVec2::ZERO, false, false);
                map.moving.clear();
                self.all_casters(plan);
            }
            Decision::Renew => {
                (map.wrap, map.is_kept, map.is_shown) = (UVec2::ZERO, true, false);
                self.static_casters(None, map.wrap, plan);
                self.moving_casters(map, &[], plan);
            }
            Decision::Keep { wrap, rects } => {
                map.wrap = *wrap;
                if !rects.is_empty() {
                    self.static_casters(Some(rects), map.wrap, plan);
                }
                self.moving_casters(map, rects, plan);
            }
        }
        map.drawn = Some(*self.fitted);
        map.changed.clear();
        debug_assert!(map.wrap.cmplt(size).all());
    }

    /// One pass with all casters that can shadow something in view.
    fn all_casters(&self, plan: &mut FramePlan) {
        let first = plan.casters.len();
        let Casters { boxes, .. } = self.casters;
        let masks = &mut plan.masks;
        masks.clear();
        masks.resize(boxes.boxes.len(), 0);
        cull(&[self.in_view()], boxes.origin, boxes.boxes, masks);
        let kept = |number: &u32| masks[*number as usize] != 0;
        let [fixed, moving] = [&self.known.fixed, &self.known.moving].map(|list| list.iter().copied().filter(kept));
        plan.casters.extend(self.known.merged(fixed, moving));
        let part = StoredRect { window: self.whole(), stored: self.whole() };
        let piece = plan.pieces.len();
        plan.pieces.push(PiecePlan { part, casters: first..plan.casters.len() });
        self.pass(plan, (PassContent::All, Layer::Shown, true), piece);
    }

    /// A pass with the static casters: into some rectangles, or into all of the layer.
    fn static_casters(&self, rects: Option<&[TexelRect]>, wrap: UVec2, plan: &mut FramePlan) {
        let layer = if self.is_split { Layer::Static } else { Layer::Shown };
        let piece = plan.pieces.len();
        let first_rect = plan.rects.len();
        let size = self.fitted.projection.resolution;
        let whole = [self.whole()];
        let parts: Vec<StoredRect> = rects.unwrap_or(&whole).iter().flat_map(|rect| rect.stored(wrap, size)).collect();
        for parts in parts.chunks(VOLUMES) {
            self.cull_static(parts, plan);
        }
        if rects.is_some() {
            plan.rects.extend(parts.iter().map(|part| part.stored));
        }
        self.pass(plan, (PassContent::Static, layer, rects.is_none()), piece);
        if let Some(pass) = plan.passes.last_mut() {
            pass.cleared = first_rect..plan.rects.len();
        }
    }

    /// Adds pieces with the static casters over them.
    fn cull_static(&self, parts: &[StoredRect], plan: &mut FramePlan) {
        let volumes: Vec<CasterVolume> = parts.iter().map(|part| self.volume(part.window)).collect();
        let boxes = self.casters.boxes;
        plan.masks.clear();
        plan.masks.resize(boxes.boxes.len(), 0);
        cull(&volumes, boxes.origin, boxes.boxes, &mut plan.masks);
        for (bit, part) in parts.iter().enumerate() {
            let first = plan.casters.len();
            let is_over = |number: &u32| plan.masks[*number as usize] >> bit & 1 == 1;
            plan.casters.extend(self.known.fixed.iter().copied().filter(is_over));
            plan.pieces.push(PiecePlan { part: *part, casters: first..plan.casters.len() });
        }
    }

    /// A pass that restores the shown layer and draws moving casters over it, if there is anything to do. `drawn`:
    /// where static casters were drawn in this frame.
    fn moving_casters(&self, map: &mut KeptMap, drawn: &[TexelRect], plan: &mut FramePlan) {
        if !self.is_split {
            return;
        }
        let size = self.fitted.projection.resolution;
        let (piece, first_rect, first_box, first_view) =
            (plan.pieces.len(), plan.rects.len(), plan.boxes.len(), plan.views.len());
        if map.is_shown {
            plan.rects.extend(drawn.iter().flat_map(|rect| rect.stored(map.wrap, size)).map(|part| part.stored));
            plan.boxes.extend(map.moving.iter().map(|moved| self.mended(moved)));
        } else {
            plan.rects.push(self.whole());
        }
        let (last_rect, last_box) = (plan.rects.len(), plan.boxes.len());
        map.moving.clear();
        let parts: Vec<StoredRect> = self.whole().stored(map.wrap, size).collect();
        if last_box > first_box {
            plan.views.extend(parts.iter().map(StoredRect::viewport));
        }
        self.cull_moving(&parts, &mut map.moving, plan);
        map.is_shown = true;
        if first_rect == last_rect && first_box == last_box && map.moving.is_empty() {
            return;
        }
        let last_view = plan.views.len();
        self.pass(plan, (PassContent::Moving, Layer::Shown, false), piece);
        if let Some(pass) = plan.passes.last_mut() {
            pass.mended = first_rect..last_rect;
            pass.mended_boxes = first_box..last_box;
            pass.views = first_view..last_view;
        }
    }

    /// Adds pieces with the moving casters over them, and the boxes that these draw.
    fn cull_moving(&self, parts: &[StoredRect], moving: &mut Vec<WorldBox>, plan: &mut FramePlan) {
        let boxes = self.casters.boxes;
        plan.moving_boxes.clear();
        let offset = (boxes.origin - self.origin).abs().element_sum() as f32;
        let widened = |number: &u32| widened(&boxes.boxes[*number as usize], offset);
        plan.moving_boxes.extend(self.known.moving.iter().map(widened));
        let mut volumes = vec![self.in_view()];
        volumes.extend(parts.iter().map(|part| self.volume(part.window)));
        plan.masks.clear();
        plan.masks.resize(plan.moving_boxes.len(), 0);
        cull(&volumes, boxes.origin, &plan.moving_boxes, &mut plan.masks);
        for (index, part) in parts.iter().enumerate() {
            let first = plan.casters.len();
            let bits = 1 | 2 << index;
            let is_over = |mask: &u8| mask & bits == bits;
            let numbers = self.known.moving.iter().zip(&plan.masks).filter(|(_, mask)| is_over(mask));
            plan.casters.extend(numbers.map(|(number, _)| *number));
            if plan.casters.len() > first {
                plan.pieces.push(PiecePlan { part: *part, casters: first..plan.casters.len() });
            }
        }
        for (aabb, mask) in plan.moving_boxes.iter().zip(&plan.masks) {
            if mask & 1 == 1 && mask >> 1 != 0 {
                moving.push(WorldBox {
                    min: boxes.origin + aabb.min.as_dvec3(),
                    max: boxes.origin + aabb.max.as_dvec3(),
                });
            }
        }
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

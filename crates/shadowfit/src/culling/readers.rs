//! Caster volumes of several maps: the casters that each map needs for the visible shadows.
//!
//! A map that is redrawn in each frame needs only the casters that can shadow a point that reads it. They lie
//! in the part of the view that reads the map, swept toward the light. The order in which points look for a
//! map determines this part.

use glam::{DVec2, DVec3, DVec4, Vec3};

use super::sweep::Sweep;
use super::volume::CasterVolume;
use crate::base::checks::{UNIT, VIEW_DEPTH_ROUNDING};
use crate::base::{FitError, checks};
use crate::bias::{FilterRadius, MIN_COSINE};
use crate::map::{FittedMap, FittedMaps};
use crate::projection::LightProjection;
use crate::selection::{MapOrder, MapReading};
use crate::technique::Technique;
use crate::technique::settings::{CasterPolicy, MAX_MAPS, MapSelection};
use crate::view::ViewFrustum;

/// The origin of positions and view depths in a shader.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reader {
    /// World position that the shader's positions are relative to, in metres.
    pub origin: DVec3,
    /// World position of the eye that view depths are measured from, in metres.
    pub eye: DVec3,
    /// Unit viewing direction of that eye, in world axes.
    pub forward: Vec3,
}

impl Reader {
    /// Returns a reader whose positions and view depths are relative to an eye with the unit viewing
    /// direction `forward` (world axes).
    pub const fn from_eye(eye: DVec3, forward: Vec3) -> Self {
        Self { origin: eye, eye, forward }
    }
}

/// Greatest rounding error of texture coordinates in a shader, as a share of their summed terms: eight
/// roundings of 2⁻²⁴, two for the position, one each for the matrix and the product, and four for the sum.
const UV_ROUNDING: f64 = 8.0 * UNIT;

impl FittedMaps {
    /// Returns the caster volume of each map: all casters that can cast a shadow, through this map, on a
    /// visible point. Each is relative to the map's [origin](LightProjection::origin). `views` are the views
    /// of the fit. Positions and view depths are relative to the first view's eye. Volumes beyond the number
    /// of maps are empty. See [`caster_volumes`].
    ///
    /// ```
    /// # use shadowfit::glam::{DVec2, DVec3, Vec3};
    /// # use shadowfit::culling::cull;
    /// # use shadowfit::*;
    /// # let camera = PerspectiveCamera {
    /// #     eye: DVec3::new(0.0, 1.7, 5.0),
    /// #     forward: Vec3::NEG_Z,
    /// #     up: Vec3::Y,
    /// #     fov_y: 0.8,
    /// #     aspect: 16.0 / 9.0,
    /// #     near: 0.1,
    /// #     far: 200.0,
    /// # };
    /// # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    /// # let scratch = &mut Scratch::new(&mut storage);
    /// let (views, technique) = ([camera.frustum()?], Technique::default());
    /// let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
    /// let maps = FitState::new().fit(&input, &technique, scratch)?;
    /// let volumes = maps.caster_volumes(&views, &technique)?;
    ///
    /// let boxes = [Aabb::new(Vec3::new(-2.0, 0.0, -12.0), Vec3::new(2.0, 6.0, -8.0))];
    /// let mut masks = [0; 1]; // bit i: draw into map i
    /// cull(&volumes[..maps.len()], DVec3::ZERO, &boxes, &mut masks);
    /// # assert_ne!(masks[0], 0);
    /// # Ok::<(), FitError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NoView`] without a view, and the errors of [`CasterVolume::swept`].
    pub fn caster_volumes(
        &self,
        views: &[ViewFrustum],
        technique: &Technique,
    ) -> Result<[CasterVolume; MAX_MAPS], FitError> {
        let first = views.first().ok_or(FitError::NoView)?;
        let forward = checks::unit("the view's forward direction", first.forward)?.as_vec3();
        let mut volumes = [CasterVolume::nowhere(first.origin); MAX_MAPS];
        let reader = Reader::from_eye(first.origin, forward);
        caster_volumes(self, &technique.reading(), &reader, views, &mut volumes)?;
        Ok(volumes)
    }
}

/// Computes the caster volume of each map: all casters that can cast a shadow, through this map, on a visible
/// point. Drawing only these casters does not change the visible shadows. `views` must be all views that read
/// these maps, up to the cameras' far planes. `reading` describes the look-up, and `reader` the origin of
/// positions and view depths. Each volume is relative to its map's [origin](LightProjection::origin). Maps
/// past [`MAX_MAPS`] or past the end of `volumes` are ignored.
///
/// The volumes serve maps with and without depth clamp, because they are unbounded toward the light
/// ([`CasterVolume::cut_at_near_plane`] bounds them). They are for maps that are redrawn in each frame. A
/// kept or [scrolled](crate::scroll::Scroll) map shows casters to later frames too, so it needs
/// [`CasterVolume::of_map`].
///
/// With selection by coverage, a map serves every point that it covers, unless a finer map provably covers
/// it. The finer maps provably cover all points up to some view depth.
///
/// With selection by view depth, a point reads the first map that ends beyond its view depth and covers it.
/// So a map is read from the end of the map in front of it, or from the start of the blend into it. A map
/// that is fitted only to receivers does not cover whole slices of the views, and points outside it read the
/// next map. So if no map in front provably covers a nearer slice, the map counts as read from that slice on.
///
/// # Errors
///
/// Returns the errors of [`CasterVolume::swept`]. The maps before the failing one then have their volumes.
pub fn caster_volumes(
    maps: &[FittedMap],
    reading: &MapReading,
    reader: &Reader,
    views: &[ViewFrustum],
    volumes: &mut [CasterVolume],
) -> Result<(), FitError> {
    let maps = &maps[..maps.len().min(MAX_MAPS)];
    match reading.selection {
        MapSelection::Coverage { .. } => {
            let from = read_by_coverage(maps, reader, views, reading);
            for ((map, near), volume) in maps.iter().zip(from).zip(volumes) {
                let read = near.map(|near| DepthSpan { near, ..DepthSpan::ALL });
                *volume = swept(map, read, views, reading)?;
            }
        }
        MapSelection::ViewDepth { .. } => {
            let mismatch = views.iter().map(|frustum| depth_mismatch(reader, frustum)).fold(0.0, f64::max);
            let readers = Readers { maps, reader, views, mismatch };
            for ((index, map), volume) in maps.iter().enumerate().zip(volumes) {
                let read = readers.read(index).map(|read| readers.widened(read));
                *volume = swept(map, read, views, reading)?;
            }
        }
    }
    Ok(())
}

/// Returns the casters of a map that the views read at these depths. Empty volume for `None`.
fn swept(
    map: &FittedMap,
    read: Option<DepthSpan>,
    views: &[ViewFrustum],
    reading: &MapReading,
) -> Result<CasterVolume, FitError> {
    let reach = reading.softness.filter_radius_in(reading.filter, &map.projection);
    let normal_offset = map.bias.normal_offset.abs();
    let DepthSpan { near, far } = read.unwrap_or(DepthSpan::ALL);
    let volume =
        CasterVolume::swept(&map.projection, &Sweep { views, near, far, filter_radius: reach, normal_offset })?;
    Ok(if read.is_some() {
        lowered(volume, &map.projection, depth_below(map, reach))
    } else {
        CasterVolume::nowhere(map.projection.origin)
    })
}

/// The view depths of the points that read a map, in metres.
#[derive(Clone, Copy, Debug)]
struct DepthSpan {
    near: f32,
    far: f32,
}

impl DepthSpan {
    const ALL: Self = Self { near: f32::MIN, far: f32::MAX };
}

/// Finds the part of the views that reads a map by view depth.
struct Readers<'a> {
    maps: &'a [FittedMap],
    reader: &'a Reader,
    views: &'a [ViewFrustum],
    /// Greatest difference of a visible point's view depth between the shader and its frustum, in metres.
    mismatch: f64,
}

impl Readers<'_> {
    /// Returns the view depths of the points that may read a map, or `None` if there are none.
    fn read(&self, index: usize) -> Option<DepthSpan> {
        let is_read_from = |from: &usize| {
            let slice = self.slice(*from);
            slice.near < slice.far && !(*from..index).any(|map| self.covers(map, slice))
        };
        let first = (0..=index).find(is_read_from)?;
        // Nearer points may be blended into the map.
        let near = self.slice(first).near.min(self.maps[index].shader_blend_start());
        Some(DepthSpan { near, far: self.end(index) })
    }

    /// Returns the view depths of the points that try a map first.
    fn slice(&self, index: usize) -> DepthSpan {
        let near = if index == 0 { f32::MIN } else { self.end(index - 1) };
        DepthSpan { near, far: self.end(index) }
    }

    /// Returns the view depth at a map's end.
    fn end(&self, index: usize) -> f32 {
        self.maps[index].shader_end()
    }

    /// Returns a slice, widened by the depths that rounding or another eye may move into it.
    fn widened(&self, slice: DepthSpan) -> DepthSpan {
        let beside = |depth: f32| self.mismatch + f64::from(depth).abs() * f64::from(VIEW_DEPTH_ROUNDING);
        let bounded = |depth: f64| depth.clamp(f64::from(f32::MIN), f64::from(f32::MAX)) as f32;
        DepthSpan {
            near: bounded(f64::from(slice.near) - beside(slice.near)),
            far: bounded(f64::from(slice.far) + beside(slice.far)),
        }
    }

    /// Returns whether a map provably covers everything in a slice of the views, by the shader's test.
    fn covers(&self, index: usize, slice: DepthSpan) -> bool {
        let fit = self.maps[index].projection.relative_to(self.reader.origin);
        holds_slice(&fit, self.reader, self.views, self.widened(slice), 0.0)
    }
}

/// Returns whether a map, relative to the reader's origin, provably holds everything in a span of view depths
/// of the views, with `free` texels around it.
///
/// **Lemma.** A map holds a slice of a view if it holds the slice's eight corners with room for the greatest
/// rounding at the corners. Proof: A slice is the convex hull of its corners, and a map is a box. So the
/// whole slice is on the inner side of each side of the map if the corners are. The rounding of a point is
/// bounded by a sum of absolute values of terms that are linear in the point. This bound is a convex
/// function, so it is greatest at a corner. [Proofs](crate::proof) of coverage use the lemma for boxes that
/// are clipped to slices.
fn holds_slice(fit: &LightProjection, reader: &Reader, views: &[ViewFrustum], span: DepthSpan, free: f64) -> bool {
    views.iter().all(|frustum| {
        let offset = frustum.origin - reader.origin;
        let holds = |corner: &Vec3| holds_point(fit, corner.as_dvec3() + offset, free);
        // A view without a part between these depths has no points to hold.
        frustum.slice(span.near, span.far).map_or(true, |part| part.corners.iter().all(holds))
    })
}

/// Returns whether a map holds a point, relative to its origin, with `free` texels around it, for any rounding in a
/// shader.
fn holds_point(fit: &LightProjection, point: DVec3, free: f64) -> bool {
    let m = fit.uv_from_world.as_dmat4();
    let terms = [m.x_axis * point.x, m.y_axis * point.y, m.z_axis * point.z, m.w_axis].map(DVec4::truncate);
    let uv: DVec3 = terms.iter().sum();
    let rounding = terms.iter().map(|term| term.abs()).sum::<DVec3>() * UV_ROUNDING;
    let border = rounding + (DVec2::splat(free) / fit.resolution.as_dvec2()).extend(0.0);
    uv.cmpge(border).all() && uv.cmple(DVec3::ONE - border).all()
}

/// Returns the greatest difference between a point's view depth in a frustum and in the shader, in metres.
/// The shader may measure from another eye or along another direction.
fn depth_mismatch(reader: &Reader, frustum: &ViewFrustum) -> f64 {
    let own = frustum.forward.as_dvec3();
    let (forward, own) = (reader.forward.as_dvec3(), own / checks::length(own));
    let farthest = frustum.corners.iter().map(|corner| checks::length(corner.as_dvec3())).fold(0.0, f64::max);
    checks::length(forward - own) * farthest + (frustum.origin - reader.eye).dot(forward).abs()
}

/// Returns the greatest depth of a comparison below a point, along the light, in metres. With a
/// receiver-plane bias, the filter compares at the plane's own depth, which falls by the tangent of the
/// slope. Negative biases move the point itself.
fn depth_below(map: &FittedMap, reach: FilterRadius) -> f64 {
    let tangent = 1.0 / f64::from(MIN_COSINE);
    let (bias, range) = (map.bias, f64::from(map.projection.depth_range));
    let away = |bias: f32| f64::from((-bias).max(0.0));
    let size = map.projection.texel_size.as_dvec2();
    let texel = libm::sqrt(size.x * size.x + size.y * size.y);
    // Look-ups lie a texel less far away than the texels that they read. At the map's border they move by
    // half a texel.
    let disc = (reach.disc * map.projection.texel_size).max_element();
    let aside = f64::from((reach.taps - 1.0).max(0.5)) * texel + f64::from(disc + bias.normal_offset.abs());
    let plane = if bias.receiver_plane == 0.0 { 0.0 } else { aside + away(bias.receiver_plane) * texel };
    (away(bias.constant_depth) + away(bias.slope_depth) * tangent) * range + plane * tangent
}

/// Returns a swept volume, extended along the light by a depth in metres, but not beyond the map's stored
/// range.
fn lowered(mut volume: CasterVolume, fit: &LightProjection, depth: f64) -> CasterVolume {
    // Its planes are the four sides and the far plane.
    let stored = CasterVolume::of_map(fit, CasterPolicy::DepthClamp);
    let to_light: Vec3 = -fit.direction;
    let planes = volume.planes.iter_mut().take(volume.count as usize);
    for plane in planes.filter(|plane| !stored.active_planes().contains(plane)) {
        let upward = f64::from(plane.truncate().dot(to_light).max(0.0));
        // Biases may have any size, but planes must stay finite.
        plane.w = (plane.w + (upward * depth) as f32).min(f32::MAX);
    }
    volume
}

/// Number of halvings of the views' depths in the search for the part that a finer map holds. The result is
/// exact to 1/4096 of the depths.
const HALVINGS: u32 = 12;

/// Returns the least view depth, in metres, of the points that read each map, in the order of `maps`. `None`
/// if no point reads it.
///
/// A finer map holds all nearer points, with the filter's radius and the blend, for any rounding in a shader.
/// From this depth on, a map is read by all points that it covers and the finer maps do not.
fn read_by_coverage(
    maps: &[FittedMap],
    reader: &Reader,
    views: &[ViewFrustum],
    reading: &MapReading,
) -> [Option<f32>; MAX_MAPS] {
    let free = f64::from(reading.softness.filter_radius(reading.filter) + reading.selection.blend());
    let mut from = [None; MAX_MAPS];
    let mut held = Held::To(f32::MIN);
    for index in MapOrder::new(reading.selection, maps.iter().map(|map| &map.projection)).iter() {
        let Held::To(depth) = held else { break };
        from[index] = Some((depth - depth.abs() * VIEW_DEPTH_ROUNDING).max(f32::MIN));
        held = held_to(&maps[index], reader, views, free, depth);
    }
    from
}

/// The part of the views that finer maps hold.
enum Held {
    /// Everything up to a view depth, in metres.
    To(f32),
    /// Everything.
    Whole,
}

/// Finds the view depth up to which a map holds everything in the views from `from` on, with `free` texels
/// around it.
fn held_to(map: &FittedMap, reader: &Reader, views: &[ViewFrustum], free: f64, from: f32) -> Held {
    let fit = map.projection.relative_to(reader.origin);
    let holds = |far: f32| holds_slice(&fit, reader, views, DepthSpan { near: from, far }, free);
    let near = views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
    let far = views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
    if holds(far) {
        return Held::Whole;
    }
    let near = near.max(from);
    let (mut held, mut beyond) = (near, far);
    for _ in 0..HALVINGS {
        let middle = held + (beyond - held) * 0.5;
        *(if holds(middle) { &mut held } else { &mut beyond }) = middle;
    }
    // If the map holds nothing, the search has found no depth.
    Held::To(if held > near { held } else { from })
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use super::*;
    use crate::selection::DepthRange;
    use crate::settings::FitSettings;
    use crate::{Bias, PerspectiveCamera, fit};
    use alloc::vec::Vec;

    const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.2);
    const ENDS: [f32; 3] = [5.0, 20.0, f32::MAX];

    /// Returns the view of a camera with a vertical field of view, in radians.
    fn frustum(fov_y: f32) -> ViewFrustum {
        let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
        let camera = PerspectiveCamera { eye: DVec3::ZERO, forward, up, fov_y, aspect: 1.6, near: 0.1, far: 60.0 };
        camera.frustum().expect("a camera")
    }

    /// Returns maps around the slices of a view.
    fn maps(view: &ViewFrustum) -> Vec<FittedMap> {
        let mut near = f32::MIN;
        let map = |far: f32| {
            let slice = view.slice(near - 0.01, far + 0.01).expect("a slice");
            near = far;
            let light = fit(&slice, DIRECTION, &FitSettings::default().with_max_distance(f32::MAX)).expect("a fit");
            FittedMap::new(light, Bias::default()).with_depths(DepthRange::new(0.0, Some(far.into())))
        };
        ENDS.into_iter().map(map).collect()
    }

    fn by(selection: MapSelection) -> MapReading {
        MapReading { selection, ..Technique::default().reading() }
    }

    /// Returns the least view depth of the points that read each map, in metres.
    fn read_from(maps: &[FittedMap], views: &[ViewFrustum]) -> Vec<Option<f32>> {
        let reader = Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z);
        let readers = Readers { maps, reader: &reader, views, mismatch: 0.0 };
        (0..maps.len()).map(|index| readers.read(index).map(|slice| slice.near)).collect()
    }

    #[test]
    fn a_map_is_read_from_where_the_one_in_front_ends_if_that_covers_its_slice() {
        let view = frustum(0.9);
        let mut maps = maps(&view);
        assert_eq!(read_from(&maps, &[view]), [Some(f32::MIN), Some(5.0), Some(20.0)]);
        // This view is wider than the view of the fits, so no map covers its slice.
        assert_eq!(read_from(&maps, &[view, frustum(1.1)]), [Some(f32::MIN); 3]);
        // The second map lacks the sides of its slice, so the last one is read in both slices.
        maps[1].projection = self::maps(&frustum(0.5))[1].projection;
        assert_eq!(read_from(&maps, &[view]), [Some(f32::MIN), Some(5.0), Some(5.0)]);
    }

    #[test]
    fn maps_without_a_range_are_read_where_those_in_front_leave_points_out() {
        let view = frustum(0.9);
        let [a, b, c] = maps(&view)[..] else { panic!("three maps") };
        let empty = |depths| FittedMap { depths, ..c };
        let front = [empty(None), a, b, c];
        assert_eq!(read_from(&front, &[view]), [None, Some(f32::MIN), Some(5.0), Some(20.0)]);
        let behind = [a, b, c, empty(Some(DepthRange::new(50.0, None)))];
        assert_eq!(read_from(&behind, &[view])[3], None);
        assert_eq!(read_from(&behind, &[frustum(1.1)])[3], Some(f32::MIN));
        let reader = Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z);
        let mut volumes = [CasterVolume::everywhere(DVec3::ZERO); 4];
        caster_volumes(&behind, &by(MapSelection::ViewDepth { overlap: 0.0 }), &reader, &[view], &mut volumes)
            .expect("a good view");
        let holds = volumes.map(|volume| volume.intersects_sphere(Vec3::NEG_Z * 3.0, 1.0));
        assert_eq!(holds, [true, false, false, false]);
    }

    #[test]
    fn by_coverage_a_map_is_read_from_where_no_finer_one_holds_all() {
        let view = frustum(0.9);
        let reader = Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z);
        let [a, b, c] = maps(&view)[..] else { panic!("three maps") };
        let from = |maps: &[FittedMap], views: &[ViewFrustum], blend: f32| {
            let reading = by(MapSelection::Coverage { blend });
            let from = read_by_coverage(maps, &reader, views, &reading);
            from[..maps.len()].to_vec()
        };
        // Maps are ordered by texel size, in any order of the list. A map holds its slice and the filter
        // around it.
        let read = from(&[c, a, b], &[view], 0.0);
        assert_eq!(read[1], Some(f32::MIN));
        let near = |index: usize, depth: f32| read[index].is_some_and(|from| (from / depth - 1.0).abs() < 1e-2);
        assert!(near(2, 5.0) && near(0, 20.0), "{read:?}");
        // With a blend, holding the slice alone is not enough.
        assert!(from(&[a, b, c], &[view], 8.0)[1].is_some_and(|from| from < 4.9));
        // Another view, beside the maps.
        assert_eq!(from(&[a, b, c], &[view, frustum(1.5)], 0.0), [Some(f32::MIN); 3]);
        // A map of the whole view leaves no points to coarser maps. An empty map holds no points.
        let light = fit(&view, DIRECTION, &FitSettings::default()).expect("a fit");
        let whole = FittedMap::new(light, Bias::default());
        let mut coarse = whole;
        coarse.projection.texel_size *= 2.0;
        let held = view.slice(0.1, 59.0).expect("a slice");
        assert_eq!(from(&[whole, coarse], &[held], 0.0), [Some(f32::MIN), None]);
        let mut empty = whole;
        empty.projection.is_empty = true;
        assert_eq!(from(&[empty, coarse], &[held], 0.0), [None, Some(f32::MIN)]);
    }

    #[test]
    fn by_view_depth_a_map_is_read_from_where_the_one_in_front_is_blended_into_it() {
        let view = frustum(0.9);
        let mut maps = maps(&view);
        maps[1].depths.as_mut().expect("a range").covered_from = Some(4.0);
        assert_eq!(read_from(&maps, &[view]), [Some(f32::MIN), Some(4.0), Some(20.0)]);
    }

    #[test]
    fn a_view_that_counts_its_depths_from_elsewhere_is_off_by_as_much() {
        let frustum = frustum(0.9);
        let from = |eye: DVec3, forward: Vec3| {
            depth_mismatch(&Reader { eye, ..Reader::from_eye(DVec3::ZERO, forward) }, &frustum)
        };
        assert_eq!(from(DVec3::ZERO, Vec3::NEG_Z), 0.0);
        // The other eye of a headset has the same view depths.
        assert_eq!(from(DVec3::X * 0.03, Vec3::NEG_Z), 0.0);
        assert_eq!(from(DVec3::Z * 10.0, Vec3::NEG_Z), 10.0);
        assert!(from(DVec3::ZERO, Vec3::Z) > 120.0);
    }

    #[test]
    fn without_a_view_nothing_can_be_swept() {
        let maps = maps(&frustum(0.9));
        let reader = Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z);
        let mut volumes = [CasterVolume::nowhere(DVec3::ZERO); 3];
        for selection in [MapSelection::ViewDepth { overlap: 0.0 }, MapSelection::default()] {
            let swept = caster_volumes(&maps, &by(selection), &reader, &[], &mut volumes);
            assert_eq!(swept, Err(FitError::NoView));
        }
        assert_eq!(FittedMaps::default().caster_volumes(&[], &Technique::default()), Err(FitError::NoView));
    }
}

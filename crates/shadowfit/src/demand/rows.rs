//! Visible demand counted from a depth buffer that was read back, for graphics APIs without compute shaders.

use glam::{DMat4, DVec3, DVec4, Mat4, Vec3};

use super::counts::{Counts, VisibleDemandSpace};
use super::grid::PIXELS;
use super::histogram::needed_texel;
use crate::base::{DepthConvention, FitError, checks};
use crate::view::ViewFrustum;

/// A depth buffer that was read back.
#[derive(Clone, Copy, Debug)]
pub struct DepthRows<'a> {
    /// Stored depths, row by row from the top, without gaps. Pixels without a surface have the far plane's
    /// depth.
    pub depths: &'a [f32],
    /// Pixels per row.
    pub width: u32,
    /// Matrix that the depth buffer was drawn with, for positions relative to the eye
    /// ([`ViewFrustum::origin`](crate::ViewFrustum::origin)), in metres.
    pub clip_from_world: Mat4,
    /// Depth convention of that matrix. OpenGL stores -1..1 as 0..1: pass its buffers unchanged.
    pub depth: DepthConvention,
    /// Frustum of the view. It gives the view depths of points, and the part of the picture that belongs to
    /// the view.
    pub view: &'a ViewFrustum,
}

/// A depth buffer whose depths a function returns, such as one with gaps between its rows or with its bottom row
/// first.
#[derive(Clone, Copy, Debug)]
pub struct DepthPicture<'a> {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// As [`DepthRows::clip_from_world`].
    pub clip_from_world: Mat4,
    /// As [`DepthRows::depth`].
    pub depth: DepthConvention,
    /// As [`DepthRows::view`].
    pub view: &'a ViewFrustum,
}

impl VisibleDemandSpace {
    /// Counts the points of a depth buffer that face the light: one for each `stride` pixels across and down.
    /// Few points are enough. In a picture of 1280 × 720 pixels, a stride of 56 with some 300 points gave
    /// 0.301% wrong pixels, and 129,600 points gave 0.311%.
    ///
    /// The slope of a surface is computed from the depths of neighbouring pixels. So read back whole rows, or
    /// read back groups of three by three pixels and count each group as a separate picture with its own
    /// matrix.
    ///
    /// # Errors
    ///
    /// [`FitError::OutOfRange`] for incomplete rows, a width below 3 and a stride of 0.
    /// [`FitError::NotFinite`] for a matrix without an inverse.
    pub fn count_rows(&self, counts: &mut Counts, rows: &DepthRows, stride: u32) -> Result<(), FitError> {
        let DepthRows { depths, width, clip_from_world, depth, view } = *rows;
        checks::within("the width of depth rows", f64::from(width), 3.0, f64::from(u32::MAX))?;
        let height = depths.len() / width as usize;
        let rest = (depths.len() % width as usize) as f64;
        checks::within("the depths of the last row", rest, 0.0, 0.0)?;
        let size = [width, u32::try_from(height).unwrap_or(u32::MAX)];
        let picture = DepthPicture { size, clip_from_world, depth, view };
        self.count_picture(counts, &picture, stride, |x, y| depths[y * width as usize + x])
    }

    /// Counts points as [`Self::count_rows`]. `stored` returns the stored depth at a column and a row, counted
    /// from the top left.
    ///
    /// # Errors
    ///
    /// [`FitError::OutOfRange`] for a width or a height below 3 and a stride of 0. [`FitError::NotFinite`] for a
    /// matrix without an inverse.
    pub fn count_picture(
        &self,
        counts: &mut Counts,
        picture: &DepthPicture,
        stride: u32,
        stored: impl Fn(usize, usize) -> f32,
    ) -> Result<(), FitError> {
        let DepthPicture { clip_from_world, view, .. } = *picture;
        let picture = Picture::new(picture, stored)?;
        checks::within("the stride of depth rows", f64::from(stride), 1.0, f64::from(u32::MAX))?;
        let stride = stride as usize;
        // A grid is counted for pictures of a fixed height.
        let pixels = picture.height as f32 / PIXELS * view.height_in_picture(&clip_from_world);
        // Starts in the middle of the first stride, with a neighbour on all sides.
        let first = |pixels: usize| (stride / 2).clamp(1, pixels - 2);
        for y in (first(picture.height)..picture.height - 1).step_by(stride) {
            for x in (first(picture.width)..picture.width - 1).step_by(stride) {
                if let Some(point) = picture.point(x, y) {
                    self.count_point(counts, &point, view.forward, pixels);
                }
            }
        }
        Ok(())
    }

    fn count_point(&self, counts: &mut Counts, point: &Point, forward: Vec3, pixels: f32) {
        let Point { position, ray, right, down, pixel } = *point;
        let depth = position.dot(forward.as_dvec3());
        // Shadows end there.
        if depth >= f64::from(self.far) {
            return;
        }
        let normal = down.cross(right);
        let toward_eye = if normal.dot(ray) > 0.0 { -normal } else { normal };
        let Ok(normal) = checks::unit("a normal", toward_eye.as_vec3()) else { return };
        let direction = self.demand.direction;
        let [right, down] = [right, down].map(DVec3::as_vec3);
        if normal.dot(direction.as_dvec3()) < 0.0 {
            let texel = f64::from(needed_texel(right, down, direction));
            self.count_depth(counts, depth as f32, libm::log2(pixel / texel) as f32);
        }
        if let Some(cell) = self.demand.index(position.as_vec3(), normal.as_vec3(), right * pixels, down * pixels) {
            self.count_cell(counts, cell);
        }
    }
}

/// The visible point of a pixel, relative to the eye, in metres.
struct Point {
    position: DVec3,
    /// Direction of the view ray, away from the eye; of any length.
    ray: DVec3,
    /// Movement on the surface from one pixel to the next, to the right and down.
    right: DVec3,
    down: DVec3,
    /// Width of a pixel at this point if it faced the eye.
    pixel: f64,
}

struct Picture<F> {
    depth_at: F,
    width: usize,
    height: usize,
    world_from_clip: DMat4,
    forward: DVec3,
    far: f32,
    /// Factor and offset from stored depths to the matrix's depths.
    depth: (f64, f64),
}

impl<F: Fn(usize, usize) -> f32> Picture<F> {
    fn new(picture: &DepthPicture, stored: F) -> Result<Self, FitError> {
        let [width, height] = picture.size;
        checks::within("the width of depth rows", f64::from(width), 3.0, f64::from(u32::MAX))?;
        checks::within("the number of depth rows", f64::from(height), 3.0, f64::from(u32::MAX))?;
        let world_from_clip = picture.clip_from_world.as_dmat4().inverse();
        if !world_from_clip.is_finite() {
            return Err(FitError::NotFinite { input: "the inverse of a depth buffer's matrix", value: f64::NAN });
        }
        let (far, depth) = match picture.depth {
            DepthConvention::ZeroToOne => (1.0, (1.0, 0.0)),
            DepthConvention::Reversed => (0.0, (1.0, 0.0)),
            DepthConvention::NegativeOneToOne => (1.0, (2.0, -1.0)),
        };
        let forward = picture.view.forward.as_dvec3();
        let [width, height] = [width, height].map(|pixels| pixels as usize);
        Ok(Self { depth_at: stored, width, height, world_from_clip, forward, far, depth })
    }

    /// Returns the stored depth of a pixel, or `None` if no surface was drawn.
    fn stored(&self, x: usize, y: usize) -> Option<f64> {
        let depth = (self.depth_at)(x, y);
        (depth != self.far && depth.is_finite()).then_some(f64::from(depth))
    }

    /// Returns the point at a pixel's middle and a stored depth.
    fn at(&self, x: f64, y: f64, stored: f64) -> DVec3 {
        let (scale, offset) = self.depth;
        let ndc = |pixel: f64, pixels: usize| (pixel + 0.5) / pixels as f64 * 2.0 - 1.0;
        let clip = DVec4::new(ndc(x, self.width), -ndc(y, self.height), stored * scale + offset, 1.0);
        let world = self.world_from_clip * clip;
        world.truncate() / world.w
    }

    /// Returns the vector from a point to the view ray through another point, at the same view depth. If the
    /// near plane is tilted, equal stored depths are different view depths.
    fn across(&self, other: DVec3, point: DVec3) -> DVec3 {
        let (way, ray) = (other - point, self.ray(other));
        way - ray * (way.dot(self.forward) / ray.dot(self.forward))
    }

    /// Returns the direction of the view ray through a point, away from the eye, of any length.
    fn ray(&self, point: DVec3) -> DVec3 {
        let along = self.world_from_clip.z_axis;
        let ray = along.truncate() - point * along.w;
        if ray.dot(self.forward) < 0.0 { -ray } else { ray }
    }

    /// Returns the change of depth from one pixel to the next. It uses the neighbour that is nearer in depth,
    /// so surfaces behind a silhouette do not count.
    fn change(depth: f64, next: Option<f64>, previous: Option<f64>) -> Option<f64> {
        match (next.map(|next| next - depth), previous.map(|previous| depth - previous)) {
            (Some(after), Some(before)) => Some(if after.abs() <= before.abs() { after } else { before }),
            (after, before) => after.or(before),
        }
    }

    fn point(&self, x: usize, y: usize) -> Option<Point> {
        let depth = self.stored(x, y)?;
        let across = Self::change(depth, self.stored(x + 1, y), self.stored(x - 1, y))?;
        let along = Self::change(depth, self.stored(x, y + 1), self.stored(x, y - 1))?;
        let (column, row) = (x as f64, y as f64);
        let position = self.at(column, row, depth);
        let right = self.at(column + 1.0, row, depth + across) - position;
        let down = self.at(column, row + 1.0, depth + along) - position;
        let pixel = checks::length(self.across(self.at(column, row + 1.0, depth), position));
        Some(Point { position, ray: self.ray(position), right, down, pixel })
    }
}

#[cfg(all(test, feature = "alloc"))]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::demand::VisibleDemand;
    use crate::view::PerspectiveCamera;

    const WIDTH: u32 = 160;
    const HEIGHT: u32 = 90;

    fn camera() -> PerspectiveCamera {
        PerspectiveCamera {
            eye: DVec3::new(10.0, 2.0, -4.0),
            forward: Vec3::new(0.2, -0.3, -1.0),
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 300.0,
        }
    }

    /// Returns stored depths of ground 2 m below the eye, with the sky above it.
    fn ground(depth: DepthConvention) -> Vec<f32> {
        let clip_from_world = camera().clip_from_world(depth).as_dmat4();
        let world_from_clip = clip_from_world.inverse();
        let ray = |x: u32, y: u32| {
            let ndc = |pixel: u32, pixels: u32| (f64::from(pixel) + 0.5) / f64::from(pixels) * 2.0 - 1.0;
            let (x, y) = (ndc(x, WIDTH), -ndc(y, HEIGHT));
            let point = world_from_clip * DVec4::new(x, y, f64::from(depth.near()), 1.0);
            point.truncate() / point.w
        };
        let stored = |x: u32, y: u32| {
            let ray = ray(x, y);
            let point = ray * (-2.0 / ray.y);
            let clip = clip_from_world * point.extend(1.0);
            let is_seen = ray.y < 0.0 && clip.w < 300.0;
            let ndc = if is_seen { (clip.z / clip.w) as f32 } else { depth.far() };
            if depth == DepthConvention::NegativeOneToOne { ndc * 0.5 + 0.5 } else { ndc }
        };
        (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))).map(|(x, y)| stored(x, y)).collect()
    }

    fn counted(depth: DepthConvention, stride: u32, depths: &[f32]) -> Result<VisibleDemand, FitError> {
        let view = camera().frustum()?;
        let direction = Vec3::new(0.3, -0.8, 0.2);
        let mut seen = VisibleDemand::new(VisibleDemandSpace::new(&view, direction, Vec3::Y, 300.0)?);
        let clip_from_world = camera().clip_from_world(depth);
        seen.count_rows(&DepthRows { depths, width: WIDTH, clip_from_world, depth, view: &view }, stride)?;
        Ok(seen)
    }

    #[test]
    fn every_convention_counts_the_same_points_and_a_stride_its_share_of_them() {
        let of = |depth, stride| counted(depth, stride, &ground(depth)).expect("a picture");
        let sum = |seen: &VisibleDemand| seen.demand().counts.iter().sum::<u32>();
        let all = of(DepthConvention::Reversed, 1);
        // The sky is above the horizon, which lies in the upper third.
        assert!((7_000..12_000).contains(&sum(&all)), "{}", sum(&all));
        for depth in [DepthConvention::ZeroToOne, DepthConvention::NegativeOneToOne] {
            let other = of(depth, 1);
            let moved: u32 = all.demand().counts.iter().zip(other.demand().counts).map(|(a, b)| a.abs_diff(*b)).sum();
            assert!(moved * 20 < sum(&all), "{depth:?}: {moved} of {} points in other cells", sum(&all));
        }
        let few = of(DepthConvention::Reversed, 5);
        assert!(sum(&few).abs_diff(sum(&all) / 25) * 10 < sum(&few), "{}", sum(&few));
        assert!(few.demand().counts.iter().zip(all.demand().counts).all(|(few, all)| *few == 0 || *all > 0));
    }

    #[test]
    fn points_beyond_the_shadow_distance_do_not_count() {
        let depths = ground(DepthConvention::Reversed);
        let view = camera().frustum().expect("a camera");
        let counted_to = |distance: f32| {
            let space =
                VisibleDemandSpace::new(&view, Vec3::new(0.3, -0.8, 0.2), Vec3::Y, distance).expect("a distance");
            let (mut seen, depth) = (VisibleDemand::new(space), DepthConvention::Reversed);
            let clip_from_world = camera().clip_from_world(depth);
            let rows = DepthRows { depths: &depths, width: WIDTH, clip_from_world, depth, view: &view };
            seen.count_rows(&rows, 1).expect("a picture");
            (seen.demand().counts.iter().sum::<u32>(), seen.histogram().bins.iter().sum::<u32>())
        };
        let (near, far) = (counted_to(20.0), counted_to(300.0));
        assert!(near.0 > 0 && near.0 < far.0 * 9 / 10, "{near:?} of {far:?}");
        assert_eq!(near.0, near.1, "all of the ground is lit well enough for both");
    }

    #[test]
    fn a_slanted_surface_beside_the_axis_of_an_orthographic_picture_is_lit() {
        let lens = crate::view::Lens::Orthographic { half_height: 50.0 };
        let (eye, forward, up) = (DVec3::ZERO, Vec3::NEG_Z, Vec3::Y);
        let camera = crate::view::Camera { eye, forward, up, lens, aspect: 1.0, near: 0.0, far: 100.0 };
        let (view, depth) = (camera.frustum().expect("a camera"), DepthConvention::ZeroToOne);
        // A plane that faces away from the eye, but not from the rays of its right half.
        let stored = |x: u16| (60.0 - (f32::from(x) - 31.5) / 32.0 * 50.0 * 0.75) / 100.0;
        let depths: Vec<f32> = (0..64 * 64_u16).map(|i| stored(i % 64)).collect();
        let direction = Vec3::new(0.6, 0.0, -0.8);
        let mut seen = VisibleDemand::new(VisibleDemandSpace::new(&view, direction, Vec3::Y, 100.0).expect("a view"));
        let clip_from_world = camera.clip_from_world(depth);
        seen.count_rows(&DepthRows { depths: &depths, width: 64, clip_from_world, depth, view: &view }, 1)
            .expect("rows");
        assert_eq!(seen.demand().counts.iter().sum::<u32>(), 62 * 62);
    }

    #[test]
    fn points_lie_where_the_ground_is() {
        let depths = ground(DepthConvention::Reversed);
        let picture = DepthPicture {
            size: [WIDTH, HEIGHT],
            clip_from_world: camera().clip_from_world(DepthConvention::Reversed),
            depth: DepthConvention::Reversed,
            view: &camera().frustum().expect("a camera"),
        };
        let picture = Picture::new(&picture, |x, y| depths[y * WIDTH as usize + x]).expect("a picture");
        for x in [1, 40, 158] {
            let Point { position, ray: _, right, down, pixel } = picture.point(x, 80).expect("the ground");
            assert!((position.y + 2.0).abs() < 1e-3, "{position}");
            assert!(right.y.abs() < 1e-3 && down.y.abs() < 1e-3, "{right} {down}");
            assert!(checks::length(down) > pixel && pixel > 0.0, "a slanted surface needs longer steps");
        }
        assert!(picture.point(80, 1).is_none(), "the sky");
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let depth = DepthConvention::Reversed;
        let depths = ground(depth);
        assert!(counted(depth, 0, &depths).is_err());
        assert!(counted(depth, 1, &depths[1..]).is_err());
        assert!(counted(depth, 1, &depths[..2 * WIDTH as usize]).is_err());
        assert_eq!(counted(depth, 1000, &depths).expect("one point").demand().counts.iter().sum::<u32>(), 1);
    }
}

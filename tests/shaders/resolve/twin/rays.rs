//! The rays of a pixel: the arithmetic of `resolve_trace.wgsl`, in f32, asked of the CPU's tracer.

use shadowfit::glam::{Vec2, Vec3, Vec4};
use shadowfit_truth::Tracer;

use super::{Surface, Twin, dot, transformed};

/// Least height of a ray's start, in metres: [`ResolveView::new`](shadowfit_wgpu::resolve::ResolveView::new)'s.
const RAY_OFFSET: f32 = 1e-3;
const POSITION_ROUNDING: f32 = 4.768_371_6e-7;

/// The points of a pixel that rays start from, from its centre, in pixels, and of the sun that they go to, in its radii.
pub(super) fn places(count: u32, is_soft: bool) -> Vec<[Vec2; 2]> {
    let four = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]];
    let place = |index: u32| match count {
        1 => Vec2::ZERO,
        4 => Vec2::from(four[index as usize]),
        _ => {
            let column = f64::from(index.reverse_bits()) / f64::from(u32::MAX);
            Vec2::new(column as f32 - 0.5, (index as f32 + 0.5) / count as f32 - 0.5)
        }
    };
    let in_sun = |index| if is_soft { in_disc(index, count) } else { Vec2::ZERO };
    (0..count).map(|index| [place(index), in_sun(index)]).collect()
}

/// One of several places in the unit disc (H. Vogel, "A better way to construct the sunflower head", 1979).
pub(super) fn in_disc(index: u32, count: u32) -> Vec2 {
    let golden = core::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let (radius, angle) = (((f64::from(index) + 0.5) / f64::from(count)).sqrt(), f64::from(index) * golden);
    Vec2::new((radius * angle.cos()) as f32, (radius * angle.sin()) as f32)
}

impl Twin {
    /// The share of the light that the rays of a pixel let through, and what they would without the fade.
    pub(in super::super) fn traced(&self, index: usize, tracer: &Tracer) -> f32 {
        let (pixel, surface) = self.surface_at(index);
        let height = self.height_of(&surface);
        let rough = self.rough(pixel, &surface);
        let [x, y] = self.across_light();
        let (sine, cosine) = self.turn(pixel).sin_cos();
        let [x, y] = [x * cosine + y * sine, y * cosine - x * sine];
        let is_soft = self.descriptor.filter.is_soft();
        let count = self.descriptor.edges.samples();
        let is_lit = |[place, in_sun]: &[Vec2; 2]| {
            let place = *place - self.place(0);
            let bent = rough.x * place.x.abs() + rough.y * place.y.abs();
            let start = self.point_of(pixel, &surface, place) + surface.normal * (height + bent) + self.eye;
            let aside = *in_sun * self.sun_tangent();
            let direction = (Vec3::from(self.receiver.to_light) + x * aside.x + y * aside.y).normalize();
            !tracer.is_occluded(start, direction)
        };
        let lit = places(count, is_soft).iter().filter(|place| is_lit(place)).count() as f32 / count as f32;
        let faded = self.faded(surface.position);
        lit * (1.0 - faded) + faded
    }

    /// How many of as many rays over the sun's disc, from a pixel's centre, are not blocked.
    pub(in super::super) fn lit_of(&self, index: usize, count: u32, tracer: &Tracer) -> u32 {
        let (_, surface) = self.surface_at(index);
        let start = surface.position + surface.normal * self.height_of(&surface) + self.eye;
        let [x, y] = self.across_light();
        let is_lit = |index: &u32| {
            let aside = in_disc(*index, count) * self.sun_tangent();
            let direction = (Vec3::from(self.receiver.to_light) + x * aside.x + y * aside.y).normalize();
            !tracer.is_occluded(start, direction)
        };
        (0..count).filter(is_lit).count() as u32
    }

    fn surface_at(&self, index: usize) -> ([i32; 2], Surface) {
        let index = (index as u32).cast_signed();
        let pixel = [index % self.size[0], index / self.size[0]];
        (pixel, self.surface_of(pixel, self.depth_at(pixel)))
    }

    fn sun_tangent(&self) -> f32 {
        if self.descriptor.filter.is_soft() { self.descriptor.softness.tangent() } else { 0.0 }
    }

    /// Change of a position per pixel or per depth.
    fn moved(&self, column: usize, surface: &Surface) -> Vec3 {
        let change = self.world_from_pixel[column];
        (change.truncate() - surface.position * change.w) / surface.w
    }

    fn height_of(&self, surface: &Surface) -> f32 {
        let step = self.moved(2, surface).length() * self.rounding(surface.depth);
        let distance = surface.position.length() + self.eye.length();
        RAY_OFFSET.max(step).max(POSITION_ROUNDING * distance)
    }

    /// How far neighbours across and down leave the plane of a pixel, in metres.
    fn rough(&self, [x, y]: [i32; 2], surface: &Surface) -> Vec2 {
        if self.point_reach == 0.0 {
            return Vec2::ZERO;
        }
        let (ray, across) = (self.moved(2, surface), self.moved(0, surface));
        let up = dot(ray, surface.normal);
        let height = |[right, down]: [i32; 2]| {
            let found = self.depth_at([x + right, y + down]);
            let step = surface.steps.x * right as f32 + surface.steps.y * down as f32;
            let off = found - surface.depth - step;
            let is_same = found != 0.0 && off.abs() * ray.length() <= step.abs() * ray.length() + across.length();
            if is_same { (off * up).abs() } else { 0.0 }
        };
        Vec2::new(height([1, 0]).max(height([-1, 0])), height([0, 1]).max(height([0, -1])))
    }

    fn point_of(&self, [x, y]: [i32; 2], surface: &Surface, place: Vec2) -> Vec3 {
        let most = 0.5 * surface.depth.abs();
        let depth = surface.depth + (surface.steps.x * place.x + surface.steps.y * place.y).clamp(-most, most);
        let at = Vec2::new(x as f32, y as f32) + self.place(0) + place;
        let homogeneous = transformed(&self.world_from_pixel, Vec4::new(at.x, at.y, depth, 1.0));
        homogeneous.truncate() / homogeneous.w
    }

    /// Two directions across the light (T. Duff et al., "Building an orthonormal basis, revisited", 2017).
    fn across_light(&self) -> [Vec3; 2] {
        let n = Vec3::from(self.receiver.to_light);
        let side = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (side + n.z);
        let b = n.x * n.y * a;
        let x = Vec3::new(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
        [x, Vec3::new(b, side + n.y * n.y * a, -n.y)]
    }

    /// By how much a pixel's rays are turned about the light, in radians.
    fn turn(&self, [x, y]: [i32; 2]) -> f32 {
        let at = Vec2::new(x as f32, y as f32) + self.receiver.frame_shift;
        let inner = at.x * 0.067_110_56 + at.y * 0.005_837_15;
        let noise = (52.982_918 * (inner - inner.floor())).fract();
        noise * core::f32::consts::TAU
    }
}

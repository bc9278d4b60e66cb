//! The rays of a pixel: the arithmetic of `trace.wgsl`, in f32, with the CPU's tracer.

use shadowfit::glam::{Vec2, Vec3, Vec4};
use shadowfit_truth::{Hit, Tracer};

use super::{BEND, MOST_SNAP, POSITION_ROUNDING, ROUNDINGS, SAME_NORMAL, SNAP, Surface, Twin, dot, transformed};

/// Results of a pixel's rays.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Traced {
    /// Share of the light, combined with the map's estimate for the whole pixel or the whole sun.
    pub(in super::super) factor: f32,
    /// Share of the rays that are not blocked.
    pub(in super::super) share: f32,
}

/// A start point of rays, relative to the eye.
#[derive(Clone, Copy)]
struct Start {
    position: Vec3,
    /// Start of the ray, above the surface.
    above: Vec3,
    normal: Vec3,
    /// Position in the pixel relative to its first sample, in pixels.
    place: Vec2,
    /// Triangle of the point; `None` if its position comes from the depth buffer.
    triangle: Option<u32>,
}

/// Returns the start points of a pixel's rays, in pixels from its first sample, and their targets in the sun,
/// in radii. `first` is that sample's position relative to the pixel's centre.
pub(super) fn points(count: u32, is_soft: bool, first: Vec2) -> Vec<[Vec2; 2]> {
    let four = [[-0.125, -0.375], [0.375, -0.125], [-0.375, 0.125], [0.125, 0.375]];
    let place = |index: u32| match count {
        1 => Vec2::ZERO,
        4 => Vec2::from(four[index as usize]),
        _ => {
            let column = f64::from(index.reverse_bits()) / f64::from(u32::MAX);
            Vec2::new(column as f32 - 0.5, (index as f32 + 0.5) / count as f32 - 0.5)
        }
    };
    let point = |index: u32| {
        if is_soft { [Vec2::ZERO, in_disc(index, count)] } else { [place(index) - first, Vec2::ZERO] }
    };
    (0..count).map(point).collect()
}

/// Returns one of several positions in the unit disc (H. Vogel, "A better way to construct the sunflower
/// head", 1979).
pub(super) fn in_disc(index: u32, count: u32) -> Vec2 {
    let golden = core::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let (radius, angle) = (((f64::from(index) + 0.5) / f64::from(count)).sqrt(), f64::from(index) * golden);
    Vec2::new((radius * angle.cos()) as f32, (radius * angle.sin()) as f32)
}

/// Search for a surface on a ray.
struct Sought<'a> {
    tracer: &'a Tracer,
    begin: Vec3,
    direction: Vec3,
    /// Expected distance along the ray, which is also the tolerance.
    reach: f32,
    sure: f32,
    /// Greatest distance between the ray and a missed triangle.
    beside: f32,
    normal: Option<Vec3>,
}

impl Sought<'_> {
    /// Returns the first triangle that the ray hits within `sure` of the expected distance, or else the
    /// nearest one to it. If the ray hits none, or one with another normal, returns a triangle that it
    /// narrowly misses.
    fn triangle(&self) -> Option<u32> {
        let Self { tracer, begin, direction, reach, .. } = *self;
        let mut best = (f32::INFINITY, None);
        tracer.for_each_hit_within(begin, direction, 2.0 * reach, |hit| self.choose(hit, &mut best));
        if best.1.is_some_and(|triangle| self.is_same(triangle)) {
            return best.1;
        }
        best = (f32::INFINITY, None);
        for triangle in (0..tracer.len() as u32).filter(|triangle| self.is_same(*triangle) && self.passes(*triangle)) {
            let normal = tracer.normal(triangle);
            let distance = dot(normal, tracer.corners(triangle)[0] - begin) / dot(normal, direction);
            if (distance - reach).abs() <= self.sure {
                self.choose(Hit { distance, triangle }, &mut best);
            }
        }
        best.1
    }

    fn choose(&self, hit: Hit, best: &mut (f32, Option<u32>)) {
        let off = (hit.distance - self.reach).abs();
        let misfit = if off <= self.sure { hit.distance - self.reach - self.sure } else { off };
        if misfit < best.0 {
            *best = (misfit, Some(hit.triangle));
        }
    }

    fn is_same(&self, triangle: u32) -> bool {
        self.normal.is_none_or(|normal| dot(self.tracer.normal(triangle), normal).abs() >= SAME_NORMAL)
    }

    fn passes(&self, triangle: u32) -> bool {
        let [a, b, c] = self.tracer.corners(triangle);
        let side = dot(self.tracer.normal(triangle), self.direction).signum();
        [[a, b], [b, c], [c, a]].into_iter().all(|[from, to]| {
            let product = self.direction.cross(to - from);
            side * dot(product, self.begin - from) >= -self.beside * product.length()
        })
    }
}

impl Twin {
    pub(in super::super) fn traced(&self, index: usize, tracer: &Tracer) -> Traced {
        let (pixel, surface) = self.surface_at(index);
        let [x, y] = self.across_light();
        let turn = self.turn(pixel);
        let (sine, cosine) = turn.sin_cos();
        let across = [x * cosine + y * sine, y * cosine - x * sine];
        let estimate = self.estimate_of(&surface, across, turn);
        let (mut lit, mut expected, mut is_off) = (0.0, 0.0, false);
        let first = self.start_at(pixel, &surface, Vec2::ZERO, (tracer, None));
        for [place, in_sun] in &self.points {
            let start = self.start_at(pixel, &surface, *place, (tracer, Some(first)));
            let above = dot(start.position - surface.position, surface.normal).abs();
            let most = 0.5 * self.height_at(start.position) + dot(surface.off, surface.normal).abs();
            is_off |= start.place != *place || (*place != Vec2::ZERO && above > most);
            let aside = *in_sun * self.sun_tangent();
            let direction = Vec3::from(self.receiver.to_light) + across[0] * aside.x + across[1] * aside.y;
            let is_turned_away = start.triangle.is_some() && dot(start.normal, self.receiver.to_light.into()) <= 0.0;
            let is_lit = !is_turned_away && !tracer.is_occluded(start.above + self.eye, direction.normalize());
            lit += f32::from(u8::from(is_lit));
            expected += estimate.as_ref().map_or(0.0, |map| self.estimate_at(map, [start.place, *in_sun]));
        }
        let count = self.points.len() as f32;
        let share = lit / count;
        let corrected = |map| (self.estimate_whole(map) + (lit - expected) / count).clamp(0.0, 1.0);
        let faded = self.faded(surface.position);
        let factor = estimate.as_ref().filter(|_| !is_off).map_or(share, corrected) * (1.0 - faded) + faded;
        Traced { factor, share: share * (1.0 - faded) + faded }
    }

    /// Returns how many of `count` rays over the sun's disc, from a pixel's centre, are not blocked.
    pub(in super::super) fn lit_of(&self, index: usize, count: u32, tracer: &Tracer) -> u32 {
        let (pixel, surface) = self.surface_at(index);
        let start = self.start_at(pixel, &surface, Vec2::ZERO, (tracer, None)).above + self.eye;
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

    pub(super) fn sun_tangent(&self) -> f32 {
        if self.descriptor.filter.is_soft() { self.descriptor.softness.tangent() } else { 0.0 }
    }

    fn position_at(&self, at: Vec2, depth: f32) -> Vec3 {
        let homogeneous = transformed(&self.world_from_pixel, Vec4::new(at.x, at.y, depth, 1.0));
        homogeneous.truncate() / homogeneous.w
    }

    /// Returns the start of a ray from a position in a pixel, in pixels from its first sample. `first` is the
    /// start of the first sample.
    fn start_at(
        &self,
        [x, y]: [i32; 2],
        surface: &Surface,
        place: Vec2,
        (tracer, first): (&Tracer, Option<Start>),
    ) -> Start {
        let farthest = 0.5 * surface.depth.abs();
        let change = surface.steps.x * place.x + surface.steps.y * place.y;
        let depth = surface.depth + change.clamp(-farthest, farthest);
        let [across, down] = surface.most_steps.to_array();
        let bend = BEND * (across * place.x.abs() + down * place.y.abs());
        let likely = ROUNDINGS * self.rounding(depth) + SNAP * (across + down) + bend;
        let all = likely + (MOST_SNAP - SNAP) * (across + down);
        let off = all.min(0.5 * depth.abs());
        let at = Vec2::new(x as f32, y as f32) + self.place(0) + place;
        let middle = self.position_at(at, depth);
        let (one, other) = (self.position_at(at, depth - off), self.position_at(at, depth + off));
        let (near, far) = if dot(other - one, self.forward) > 0.0 { (one, other) } else { (other, one) };
        let rounded = POSITION_ROUNDING * (middle.length() + self.eye.length());
        let reach = (middle - near).length() + rounded;
        let sure = (middle - near).length() * (likely / all) + rounded;
        let direction = (far - near).normalize();
        let begin = middle - direction * reach + self.eye;
        let triangle = match first {
            None => {
                let normal = surface.is_stored.then_some(surface.normal);
                Sought { tracer, begin, direction, reach, sure, beside: self.beside_of(surface), normal }.triangle()
            }
            Some(first) => first.triangle,
        };
        let Some(triangle) = triangle else {
            let position = surface.position;
            let height = self.height_at(position).max(dot(surface.off, surface.normal).abs());
            let above = position + surface.normal * height;
            return Start { position, above, normal: surface.normal, place: Vec2::ZERO, triangle: None };
        };
        let mut is_inside = false;
        tracer.for_each_hit_within(begin, direction, 2.0 * reach, |hit| is_inside |= hit.triangle == triangle);
        let normal = tracer.normal(triangle);
        let distance = dot(normal, tracer.corners(triangle)[0] - begin) / dot(normal, direction);
        let is_near = (0.0..=2.0 * reach).contains(&distance);
        let beside = ((distance - reach) * dot(normal, direction)).abs();
        let is_flat = beside <= 0.5 * self.height_at(surface.position);
        let is_seen = is_near && (is_inside || (is_flat && self.reaches([x, y], surface, place)));
        if let Some(first) = first.filter(|_| !is_seen) {
            return first;
        }
        let position = middle + direction * (distance - reach);
        let normal = if dot(normal, direction) > 0.0 { -normal } else { normal };
        let least = self.height_at(position);
        let height = if is_inside || first.is_some() { least } else { least.max(self.beside_of(surface)) };
        let above = position + normal * height;
        Start { position, above, normal, place, triangle: Some(triangle) }
    }

    /// Returns how far the ray from the eye may miss the drawn triangle, in metres.
    fn beside_of(&self, surface: &Surface) -> f32 {
        let [across, down] = [0, 1].map(|axis| Self::moved(self.world_from_pixel[axis], surface).length());
        SNAP * across.max(down)
    }

    /// Returns whether a pixel lies close enough to the plane of another one for rays between them to start
    /// above the surface.
    fn is_on_plane(&self, [x, y]: [i32; 2], [right, down]: [i32; 2], surface: &Surface) -> bool {
        let found = self.depth_at([x + right, y + down]);
        let off = found - surface.depth - (surface.steps.x * right as f32 + surface.steps.y * down as f32);
        let up = dot(Self::moved(self.world_from_pixel[2], surface), surface.normal);
        found != 0.0 && (off * up).abs() * self.point_reach <= 0.5 * self.height_at(surface.position)
    }

    /// Returns whether the surface continues to a neighbour on the pixel's plane.
    fn goes_on(&self, pixel: [i32; 2], axis: [i32; 2], surface: &Surface) -> bool {
        let is_on_plane = |steps: i32| self.is_on_plane(pixel, axis.map(|side| side * steps), surface);
        is_on_plane(1) && (is_on_plane(-1) || is_on_plane(2))
    }

    /// Returns whether the surface continues to a position in its pixel, in pixels from its first sample.
    fn reaches(&self, pixel: [i32; 2], surface: &Surface, place: Vec2) -> bool {
        let [across, down] = [place.x, place.y].map(|side| if side > 0.0 { 1 } else { -1 });
        (place.x == 0.0 || self.goes_on(pixel, [across, 0], surface))
            && (place.y == 0.0 || self.goes_on(pixel, [0, down], surface))
    }

    /// Returns two directions across the light (T. Duff et al., "Building an orthonormal basis, revisited",
    /// 2017).
    fn across_light(&self) -> [Vec3; 2] {
        let n = Vec3::from(self.receiver.to_light);
        let side = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (side + n.z);
        let b = n.x * n.y * a;
        let x = Vec3::new(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
        [x, Vec3::new(b, side + n.y * n.y * a, -n.y)]
    }

    /// Returns the rotation of a pixel's rays about the light, in radians.
    fn turn(&self, [x, y]: [i32; 2]) -> f32 {
        let at = Vec2::new(x as f32, y as f32) + self.receiver.frame_shift;
        let inner = at.x * 0.067_110_56 + at.y * 0.005_837_15;
        let noise = (52.982_918 * (inner - inner.floor())).fract();
        noise * core::f32::consts::TAU
    }
}

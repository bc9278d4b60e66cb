//! Building blocks of all vehicles: wheels, wedges, bent sheets, and parts grouped by paint.
//!
//! Vehicles are modelled in units of half the terrain's, front toward +z, left toward +x, with the ground at
//! y = 0.

use std::f32::consts::{FRAC_PI_2, TAU};
use std::ops::Range;

use glam::{Affine3A, Quat, Vec2, Vec3};
use shadowfit_scene::Primitive;
use shadowfit_scene::parts::{Solid, extrude, lathe, plank};

use super::palette::Paint;

/// Solids, one for each paint and crease angle.
#[derive(Default)]
pub(super) struct Parts(Vec<(Paint, f32, Solid)>);

impl Parts {
    /// Adds a solid. Faces that meet at less than `crease` radians are smooth.
    pub(super) fn add(&mut self, paint: Paint, crease: f32, solid: Solid) {
        match self.0.iter_mut().find(|part| (part.0, part.1) == (paint, crease)) {
            Some(part) => part.2 = std::mem::take(&mut part.2).with(solid),
            None => self.0.push((paint, crease, solid)),
        }
    }

    /// Converts all parts to primitives.
    pub(super) fn primitives(&self) -> Vec<Primitive> {
        self.0.iter().map(|(paint, crease, solid)| solid.primitive((*paint).into(), *crease)).collect()
    }
}

/// A rectangle perpendicular to z: from `low` to `high` along x and y, at `z`.
#[derive(Clone, Copy)]
pub(super) struct Rect {
    pub(super) low: Vec2,
    pub(super) high: Vec2,
    pub(super) z: f32,
}

/// Returns a rectangle centred on x = 0.
pub(super) const fn rect(half: f32, [low, high]: [f32; 2], z: f32) -> Rect {
    Rect { low: Vec2::new(-half, low), high: Vec2::new(half, high), z }
}

/// Builds a body with flat faces from one rectangle to another of greater z.
pub(super) fn wedge(back: Rect, front: Rect) -> Solid {
    let corners = |r: Rect| {
        [(r.low.x, r.low.y), (r.high.x, r.low.y), (r.high.x, r.high.y), (r.low.x, r.high.y)]
            .map(|(x, y)| Vec3::new(x, y, r.z))
    };
    let positions = corners(front).into_iter().chain(corners(back)).collect();
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
    for a in 0..4 {
        let b = (a + 1) % 4;
        triangles.extend([[a, a + 4, b + 4], [a, b + 4, b]]);
    }
    Solid { positions, triangles }
}

/// Rotates a solid that was modelled across z so that it lies across x, with its x along z.
pub(super) fn sideways(solid: Solid) -> Solid {
    solid.transformed(Affine3A::from_rotation_y(-FRAC_PI_2))
}

/// Builds a sheet of a thickness, bent along `points` of (z, y) with ascending z, `width` across x.
pub(super) fn bent_sheet(points: &[(f32, f32)], thick: f32, width: f32) -> Solid {
    let at = |index: usize| Vec2::from(points[index]);
    let last = points.len() - 1;
    // Outward normal at a point: perpendicular to the line from its previous to its next neighbour.
    let out = |index: usize| (at((index + 1).min(last)) - at(index.saturating_sub(1))).normalize().perp() * thick;
    let mut outline = points.to_vec();
    outline.extend((0..=last).rev().map(|index| <(f32, f32)>::from(at(index) + out(index))));
    let above = |index: u32| outline.len() as u32 - 1 - index;
    let faces = |index: u32| [[index, index + 1, above(index + 1)], [index, above(index + 1), above(index)]];
    let faces: Vec<_> = (0..last as u32).flat_map(faces).collect();
    sideways(extrude(&outline, &faces, width))
}

/// Returns points (z, y) of an arc about `center`, whose coordinates are z and y. `turns` are angles in
/// radians, from the rear over the top.
pub(super) fn arc(center: Vec2, radius: f32, turns: Range<f32>, steps: usize) -> Vec<(f32, f32)> {
    let at = |step: usize| {
        let (sin, cos) = (turns.start + (turns.end - turns.start) * step as f32 / steps as f32).sin_cos();
        (center.x - radius * cos, center.y + radius * sin)
    };
    (0..=steps).map(at).collect()
}

/// A wheel about x, centred at the origin, its outer side toward +x.
pub(super) struct Wheel {
    /// Radius to the outside of the lugs.
    pub(super) radius: f32,
    /// Radius of the rim.
    pub(super) rim: f32,
    /// Half of its width.
    pub(super) half: f32,
    /// Lugs around each half of the tread.
    pub(super) lugs: usize,
    /// Height of the lugs.
    pub(super) lug: f32,
    /// Turn of the lugs against the axle, in radians.
    pub(super) slant: f32,
}

impl Wheel {
    /// Adds the wheel at a place. If `x` is negative, its outer side is toward -x.
    pub(super) fn add(&self, parts: &mut Parts, rim: Paint, at: Vec3) {
        let side = if at.x < 0.0 { -FRAC_PI_2 } else { FRAC_PI_2 };
        self.add_turned(parts, rim, at, Quat::from_rotation_y(side));
    }

    /// Adds the wheel, modelled about z with its outer side toward +z, rotated and moved.
    pub(super) fn add_turned(&self, parts: &mut Parts, rim: Paint, at: Vec3, turn: Quat) {
        let place = Affine3A::from_rotation_translation(turn, at);
        // Lathes are about y. Their +y becomes +z.
        let upright = place * Affine3A::from_rotation_x(FRAC_PI_2);
        parts.add(Paint::Rubber, 0.6, self.tyre().transformed(upright).with(self.tread().transformed(place)));
        parts.add(rim, 0.6, self.disc().transformed(upright));
        let hub = self.rim * 0.32;
        let cap = lathe(&[(hub, 0.0), (hub, self.half * 0.52), (hub * 0.75, self.half * 0.62)], 16);
        parts.add(Paint::Steel, 0.6, cap.transformed(upright));
    }

    fn tyre(&self) -> Solid {
        let (h, tread) = (self.half, self.radius - self.lug);
        let shoulder = tread - 0.12 * self.radius;
        let profile = [
            // The sides are hollow to the depth of the disc.
            (self.rim * 0.9, -h * 0.05),
            (self.rim * 0.9, -h * 0.72),
            (self.rim * 1.06, -h * 0.86),
            (f32::midpoint(self.rim, shoulder), -h),
            (shoulder, -h * 0.97),
            (tread, -h * 0.72),
            (tread, h * 0.72),
            (shoulder, h * 0.97),
            (f32::midpoint(self.rim, shoulder), h),
            (self.rim * 1.06, h * 0.86),
            (self.rim * 0.9, h * 0.72),
            (self.rim * 0.9, h * 0.05),
        ];
        lathe(&profile, 32)
    }

    /// Builds lugs in two rows, slanted toward each other.
    fn tread(&self) -> Solid {
        let mut tread = Solid::default();
        let thick = self.radius * TAU / self.lugs as f32 * 0.2;
        let length = self.half * 0.48;
        // The lugs' corners, not their middles, lie at the radius.
        let corner = thick * self.slant.cos() + length * self.slant.sin();
        let top = (self.radius * self.radius - corner * corner).sqrt();
        for index in 0..2 * self.lugs {
            let side = if index % 2 == 0 { 1.0 } else { -1.0 };
            let low = Vec3::new(-thick, self.radius - 2.0 * self.lug, -length);
            let lug = plank(low, Vec3::new(thick, top, length));
            let turn = Quat::from_rotation_z(TAU * index as f32 / (2 * self.lugs) as f32);
            let lie = Affine3A::from_rotation_translation(
                Quat::from_rotation_y(side * self.slant),
                Vec3::Z * side * self.half * 0.47,
            );
            tread = tread.with(lug.transformed(Affine3A::from_quat(turn) * lie));
        }
        tread
    }

    /// Builds a dished disc with a raised edge.
    fn disc(&self) -> Solid {
        let (h, r) = (self.half, self.rim);
        let profile = [
            (r * 0.9, -h * 0.6),
            (r, -h * 0.75),
            (r, h * 0.78),
            (r * 0.9, h * 0.8),
            (r * 0.82, h * 0.35),
            (r * 0.5, h * 0.3),
            (r * 0.45, h * 0.42),
        ];
        lathe(&profile, 24)
    }
}

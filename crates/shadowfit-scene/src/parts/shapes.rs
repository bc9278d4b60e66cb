//! Generators of closed shapes: surfaces of revolution, lofts, capsules, rounded boxes, arches.
//!
//! All consist of rings of vertices around an axis, so they are closed by construction.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Affine3A, Quat, Vec3};

use super::solid::Solid;

/// A cross-section of a [`loft`]: an ellipse across the y axis, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// Height.
    pub y: f32,
    /// Half width along x.
    pub rx: f32,
    /// Half depth along z.
    pub rz: f32,
    /// Centre along x.
    pub cx: f32,
    /// Centre along z.
    pub cz: f32,
}

/// Returns a section centred on x = 0.
pub const fn section(y: f32, rx: f32, rz: f32, cz: f32) -> Section {
    Section { y, rx, rz, cx: 0.0, cz }
}

/// Joins rings of equal length into a tube that ends in two poles. Rings are listed upwards, each
/// counter-clockwise from above.
pub fn tube(rings: &[Vec<Vec3>], bottom: Vec3, top: Vec3) -> Solid {
    let around = rings[0].len();
    let mut solid = Solid { positions: rings.concat(), triangles: Vec::new() };
    let id = |ring: usize, index: usize| (ring * around + index % around) as u32;
    for ring in 1..rings.len() {
        for index in 0..around {
            let [a, b] = [id(ring - 1, index), id(ring - 1, index + 1)];
            let [c, d] = [id(ring, index + 1), id(ring, index)];
            solid.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let poles = solid.positions.len() as u32;
    solid.positions.extend([bottom, top]);
    let last = rings.len() - 1;
    for index in 0..around {
        solid.triangles.push([poles, id(0, index + 1), id(0, index)]);
        solid.triangles.push([poles + 1, id(last, index), id(last, index + 1)]);
    }
    solid
}

/// Returns a point of a superellipse. A `power` of 2 is an ellipse, more is squarer. The turn starts at +z,
/// toward +x.
pub fn superellipse(turn: f32, power: f32) -> (f32, f32) {
    let (sin, cos) = turn.sin_cos();
    if power == 2.0 {
        return (sin, cos);
    }
    let scale = (sin.abs().powf(power) + cos.abs().powf(power)).powf(-1.0 / power);
    (sin * scale, cos * scale)
}

/// Builds a surface of revolution about y through `(radius, height)` points, listed upwards along the
/// outline. Ends that are not on the axis are closed by discs.
pub fn lathe(profile: &[(f32, f32)], segments: usize) -> Solid {
    modulated_lathe(profile, segments, |_, _| 1.0)
}

/// Builds a [`lathe`] whose radius is multiplied by `shape(turn, height)`.
pub fn modulated_lathe(profile: &[(f32, f32)], segments: usize, shape: impl Fn(f32, f32) -> f32) -> Solid {
    let ring = |&(radius, height): &(f32, f32)| {
        let point = |index: usize| {
            let turn = index as f32 / segments as f32 * TAU;
            let radius = radius * shape(turn, height);
            Vec3::new(radius * turn.sin(), height, radius * turn.cos())
        };
        (0..segments).map(point).collect::<Vec<_>>()
    };
    let rings: Vec<_> = profile.iter().filter(|point| point.0 > 0.0).map(ring).collect();
    let pole = |point: Option<&(f32, f32)>| Vec3::Y * point.map_or(0.0, |point| point.1);
    tube(&rings, pole(profile.first()), pole(profile.last()))
}

/// Builds a ball stretched to the given radii.
pub fn ellipsoid(radii: impl Into<Vec3>, segments: usize, rings: usize) -> Solid {
    let point = |ring: usize| {
        let (sin, cos) = (ring as f32 / rings as f32 * PI).sin_cos();
        (if ring == 0 || ring == rings { 0.0 } else { sin }, -cos)
    };
    let profile: Vec<_> = (0..=rings).map(point).collect();
    lathe(&profile, segments).transformed(Affine3A::from_scale(radii.into()))
}

/// Returns the Catmull-Rom value between `b` and `c`.
pub fn catmull_rom([a, b, c, d]: [f32; 4], t: f32) -> f32 {
    let cubic = -a + 3.0 * b - 3.0 * c + d;
    let square = 2.0 * a - 5.0 * b + 4.0 * c - d;
    0.5 * (2.0 * b + (c - a) * t + square * t * t + cubic * t * t * t)
}

/// Returns points on a smooth curve through all of `points`: `steps` from each to the next, and the last one.
pub fn curve<const N: usize>(points: &[[f32; N]], steps: usize) -> Vec<[f32; N]> {
    let last = points.len() - 1;
    let between = |index: usize, t: f32| {
        let near = [index.saturating_sub(1), index, index + 1, (index + 2).min(last)];
        std::array::from_fn(|axis| catmull_rom(near.map(|near| points[near][axis]), t))
    };
    let starts = (0..last).flat_map(|index| (0..steps).map(move |step| (index, step as f32 / steps as f32)));
    starts.map(|(index, t)| between(index, t)).chain([points[last]]).collect()
}

/// Builds a smooth body through `sections` (listed upwards), closed by domes. A `power` of 2 makes the
/// sections ellipses, more makes them squarer.
pub fn loft(sections: &[Section], power: f32, steps: usize, segments: usize) -> Solid {
    let stations: Vec<_> = sections.iter().map(|s| [s.y, s.rx, s.rz, s.cx, s.cz]).collect();
    let smooth = |[y, rx, rz, cx, cz]: [f32; 5]| Section { y, rx: rx.max(1e-3), rz: rz.max(1e-3), cx, cz };
    let path: Vec<Section> = curve(&stations, steps).into_iter().map(smooth).collect();
    let mut full = dome(path[0], -1.0);
    full.reverse();
    full.extend(&path);
    full.extend(dome(path[path.len() - 1], 1.0));
    let ring = |s: &Section| {
        let point = |index: usize| {
            let (x, z) = superellipse(index as f32 / segments as f32 * TAU, power);
            Vec3::new(s.cx + x * s.rx, s.y, s.cz + z * s.rz)
        };
        (0..segments).map(point).collect::<Vec<_>>()
    };
    let rings: Vec<_> = full.iter().map(ring).collect();
    let pole = |s: Section, up: f32| Vec3::new(s.cx, s.y + up * dome_height(s), s.cz);
    tube(&rings, pole(path[0], -1.0), pole(path[path.len() - 1], 1.0))
}

/// Rings of the dome that closes a loft, with its pole.
const DOME: usize = 3;

/// Returns the height of the dome that closes a loft.
fn dome_height(end: Section) -> f32 {
    0.6 * end.rx.min(end.rz)
}

/// Returns the sections of a dome on `end`, outwards, without its pole.
fn dome(end: Section, up: f32) -> Vec<Section> {
    let at = |step: usize| {
        let (sin, cos) = (step as f32 / DOME as f32 * FRAC_PI_2).sin_cos();
        let y = end.y + up * sin * dome_height(end);
        Section { y, rx: end.rx * cos, rz: end.rz * cos, ..end }
    };
    (1..DOME).map(at).collect()
}

/// Builds a limb that hangs from the origin along -y. `radii` are at even distances, top first.
pub fn limb(length: f32, radii: &[f32], segments: usize) -> Solid {
    let last = radii.len() - 1;
    let at = |index: usize| {
        let radius = radii[last - index];
        section(-length * (last - index) as f32 / last as f32, radius, radius, 0.0)
    };
    let sections: Vec<_> = (0..=last).map(at).collect();
    loft(&sections, 2.0, 2, segments)
}

/// Builds a tapered capsule from `a` (radius `ra`) to `b` (radius `rb`).
pub fn capsule(a: impl Into<Vec3>, ra: f32, b: impl Into<Vec3>, rb: f32, segments: usize) -> Solid {
    let (a, b) = (a.into(), b.into());
    let length = a.distance(b);
    let half = (segments / 4).max(2);
    let cap = |step: usize, y: f32, r: f32, turn: f32| {
        let (sin, cos) = (turn + step as f32 / half as f32 * FRAC_PI_2).sin_cos();
        (if cos < 1e-4 { 0.0 } else { r * cos }, y + r * sin)
    };
    let mut profile: Vec<_> = (0..=half).map(|step| cap(step, 0.0, ra, -FRAC_PI_2)).collect();
    profile.extend((0..=half).map(|step| cap(step, length, rb, 0.0)));
    let turn = Quat::from_rotation_arc(Vec3::Y, (b - a).normalize());
    lathe(&profile, segments).transformed(Affine3A::from_rotation_translation(turn, a))
}

/// Builds a ring of elliptical tube about y: `radius` to the tube's centre, `thick` across, `tall` along y.
pub fn torus(radius: f32, thick: f32, tall: f32, around: usize, across: usize) -> Solid {
    let mut solid = Solid::default();
    let id = |i: usize, j: usize| ((i % around) * across + j % across) as u32;
    for i in 0..around {
        let (sin, cos) = (i as f32 / around as f32 * TAU).sin_cos();
        for j in 0..across {
            let (up, out) = (j as f32 / across as f32 * TAU).sin_cos();
            let r = radius + out * thick;
            solid.positions.push(Vec3::new(r * sin, up * tall, r * cos));
            let [a, b] = [id(i, j), id(i + 1, j)];
            let [c, d] = [id(i + 1, j + 1), id(i, j + 1)];
            solid.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    solid
}

/// Builds a box about the origin whose edges are rounded with `radius` in `steps` steps.
pub fn rounded_box(half: impl Into<Vec3>, radius: f32, steps: usize) -> Solid {
    let inner = half.into() - radius;
    // Positions along an axis of a face: the rounded end, the flat middle, the other rounded end.
    let mut line: Vec<(f32, f32)> = Vec::new();
    for step in 0..=steps {
        line.push((-1.0, -(1.0 - step as f32 / steps as f32)));
    }
    for step in 0..=steps {
        line.push((1.0, step as f32 / steps as f32));
    }
    let mut solid = Solid::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            add_box_face(&mut solid, &line, axis, sign, inner, radius);
        }
    }
    weld(&solid)
}

/// Builds a box between two corners with slightly rounded edges.
pub fn block(low: impl Into<Vec3>, high: impl Into<Vec3>, edge: f32) -> Solid {
    let (low, high) = (low.into(), high.into());
    rounded_box((high - low) / 2.0, edge, 1).moved((low + high) / 2.0)
}

/// Builds a [`block`] about the y axis, from its half widths along x and z, and its lower and upper end.
pub fn pillar([x, z]: [f32; 2], [low, high]: [f32; 2], edge: f32) -> Solid {
    block([-x, low, -z], [x, high, z], edge)
}

/// Adds one face of a rounded box, not yet welded to its neighbours.
fn add_box_face(solid: &mut Solid, line: &[(f32, f32)], axis: usize, sign: f32, inner: Vec3, radius: f32) {
    let first = solid.positions.len() as u32;
    let count = line.len() as u32;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    for &(side_v, turn_v) in line {
        for &(side_u, turn_u) in line {
            let mut side = Vec3::ZERO;
            let mut out = Vec3::ZERO;
            (side[axis], side[u], side[v]) = (sign, side_u, side_v);
            // The two faces that meet at an edge each cover half of its quarter turn.
            let quarter = PI / 4.0;
            (out[axis], out[u], out[v]) = (sign, (turn_u * quarter).tan(), (turn_v * quarter).tan());
            solid.positions.push(side * inner + out.normalize() * radius);
        }
    }
    for row in 0..count - 1 {
        for column in 0..count - 1 {
            let a = first + row * count + column;
            let [b, c, d] = [a + 1, a + count + 1, a + count];
            let quad = if sign > 0.0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
            solid.triangles.extend(quad);
        }
    }
}

/// Merges vertices that agree to 0.01 mm, and drops triangles that collapse.
fn weld(solid: &Solid) -> Solid {
    let key = |p: Vec3| (p * 1e5).round().to_array().map(|value| value as i32);
    let mut known = std::collections::HashMap::new();
    let mut welded = Solid::default();
    let mut index = Vec::with_capacity(solid.positions.len());
    for &position in &solid.positions {
        let next = welded.positions.len() as u32;
        let id = *known.entry(key(position)).or_insert(next);
        if id == next {
            welded.positions.push(position);
        }
        index.push(id);
    }
    for triangle in &solid.triangles {
        let [a, b, c] = triangle.map(|corner| index[corner as usize]);
        if a != b && b != c && c != a {
            welded.triangles.push([a, b, c]);
        }
    }
    welded
}

/// A wall across z with an opening that ends in a round arch. It starts at y = 0 and is centred on x.
#[derive(Clone, Copy, Debug)]
pub struct Arch {
    /// Whole width.
    pub width: f32,
    /// Whole height.
    pub height: f32,
    /// Thickness along z.
    pub depth: f32,
    /// Radius of the arch: half the width of the opening.
    pub radius: f32,
    /// Height at which the arch springs from its piers.
    pub spring: f32,
}

impl Arch {
    /// Builds the wall. Its front is a fan for each pier and a quad for each arch segment:
    ///
    /// ```text
    ///   +----+-+-+-+----+  height
    ///   |   /| |_|_| |\   |
    ///   |  / |/     \| \  |
    ///   | /  +       +  \ |  spring
    ///   |/   |       |   \|
    ///   +----+       +----+
    /// ```
    pub fn solid(self, segments: usize) -> Solid {
        let (w, h) = (self.width / 2.0, self.height);
        let curve: Vec<(f32, f32)> = (0..=segments)
            .map(|step| {
                let (sin, cos) = (step as f32 / segments as f32 * PI).sin_cos();
                (-cos * self.radius, self.spring + sin.max(0.0) * self.radius)
            })
            .collect();
        // Counter-clockwise from +z: left foot, over the arch, right foot, right side, top, left side.
        let mut outline = vec![(-w, 0.0), (-self.radius, 0.0)];
        outline.extend(&curve);
        outline.extend([(self.radius, 0.0), (w, 0.0), (w, h)]);
        outline.extend(curve.iter().rev().map(|point| (point.0, h)));
        outline.push((-w, h));
        let low = |step: usize| (2 + step) as u32;
        let [right_in, right, right_top] = [3, 4, 5].map(|offset| (segments + offset) as u32);
        let high = |step: usize| right_top + 1 + (segments - step) as u32;
        let left_top = outline.len() as u32 - 1;
        let mut faces = vec![[0, 1, low(0)], [0, low(0), high(0)], [0, high(0), left_top]];
        for step in 0..segments {
            let [a, b] = [low(step), low(step + 1)];
            let [c, d] = [high(step + 1), high(step)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
        let end = low(segments);
        faces.extend([[right_in, right, end], [right, high(segments), end]]);
        faces.push([right, right_top, high(segments)]);
        extrude(&outline, &faces, self.depth)
    }
}

/// Builds a box between two corners with sharp edges, for thin or distant objects.
pub fn plank(low: impl Into<Vec3>, high: impl Into<Vec3>) -> Solid {
    let (low, high) = (low.into(), high.into());
    let outline = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
    prism(&outline, high.z - low.z).moved(Vec3::Z * (low.z + high.z) / 2.0)
}

/// Builds the walls of a house about z = 0 with a gable at each end, from half of its width, the heights of
/// its foot, eaves and ridge, and its length.
pub fn gabled(half: f32, [foot, eaves, ridge]: [f32; 3], length: f32) -> Solid {
    prism(&[(-half, foot), (half, foot), (half, eaves), (0.0, ridge), (-half, eaves)], length)
}

/// Builds a prism about z = 0 from a convex, counter-clockwise outline.
pub fn prism(outline: &[(f32, f32)], depth: f32) -> Solid {
    let faces: Vec<[u32; 3]> = (2..outline.len() as u32).map(|corner| [0, corner - 1, corner]).collect();
    extrude(outline, &faces, depth)
}

/// Builds a wall across z between `height` and a lower edge, whose points are listed with ascending x.
pub fn wall_over(edge: &[(f32, f32)], height: f32, depth: f32) -> Solid {
    let count = edge.len() as u32;
    let mut outline = edge.to_vec();
    outline.extend(edge.iter().rev().map(|point| (point.0, height)));
    let above = |index: u32| 2 * count - 1 - index;
    let faces = |index: u32| [[index, index + 1, above(index + 1)], [index, above(index + 1), above(index)]];
    let faces: Vec<_> = (0..count - 1).flat_map(faces).collect();
    extrude(&outline, &faces, depth)
}

/// Builds a prism about z = 0 from a counter-clockwise outline and the triangles that fill it.
pub fn extrude(outline: &[(f32, f32)], faces: &[[u32; 3]], depth: f32) -> Solid {
    let count = outline.len() as u32;
    let layer = |z: f32| outline.iter().map(move |&(x, y)| Vec3::new(x, y, z));
    let positions = layer(depth / 2.0).chain(layer(-depth / 2.0)).collect();
    let mut triangles = faces.to_vec();
    triangles.extend(faces.iter().map(|&[a, b, c]| [a + count, c + count, b + count]));
    for a in 0..count {
        let b = (a + 1) % count;
        triangles.extend([[a, a + count, b + count], [a, b + count, b]]);
    }
    Solid { positions, triangles }
}

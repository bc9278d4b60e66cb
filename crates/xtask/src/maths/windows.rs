//! Draws windows: the texel sizes that a street's visible points need, and the positions of the four windows
//! of `windows-4`.

use anyhow::Result;
use shadowfit::demand::{CELLS, DemandGrid, DemandSpace, SIDE};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, FittedMaps, PerspectiveCamera, Technique};

use super::canvas::{Canvas, Frame, INK, MAPS, RIGHT, fill, stroke};
use super::scene::{self, Fitter, Look, Visible, draw_box, visible};

/// Direction of travel of the sunlight.
const LIGHT: Vec3 = Vec3::new(0.25, -0.72, -0.42);

/// Number of rays through the picture.
const RAYS: u32 = 6000;

/// Number of frames without movement before the picture, so that the search for window sizes has finished.
const STILL: usize = 60;

/// A street with houses on both sides and a square at its end.
const STREET: [Aabb; 11] = [
    Aabb::new(Vec3::new(-45.0, -0.3, -110.0), Vec3::new(45.0, 0.0, 12.0)),
    Aabb::new(Vec3::new(-16.0, 0.0, -18.0), Vec3::new(-6.0, 7.0, -4.0)),
    Aabb::new(Vec3::new(-17.0, 0.0, -40.0), Vec3::new(-6.5, 9.0, -22.0)),
    Aabb::new(Vec3::new(-15.0, 0.0, -62.0), Vec3::new(-6.0, 6.0, -44.0)),
    Aabb::new(Vec3::new(6.0, 0.0, -14.0), Vec3::new(15.0, 6.0, 2.0)),
    Aabb::new(Vec3::new(6.5, 0.0, -34.0), Vec3::new(17.0, 8.0, -19.0)),
    Aabb::new(Vec3::new(6.0, 0.0, -60.0), Vec3::new(16.0, 10.0, -38.0)),
    Aabb::new(Vec3::new(-24.0, 0.0, -104.0), Vec3::new(-4.0, 12.0, -90.0)),
    Aabb::new(Vec3::new(4.0, 0.0, -100.0), Vec3::new(22.0, 9.0, -88.0)),
    Aabb::new(Vec3::new(1.2, 0.0, -7.0), Vec3::new(2.6, 1.1, -6.2)),
    Aabb::new(Vec3::new(-3.4, 0.0, -12.0), Vec3::new(-2.0, 2.2, -11.0)),
];

/// Colours of the octaves of texel sizes, the finest first.
const OCTAVES: [&str; 6] = ["#4a0010", "#b5131b", "#ef5a1f", "#fb9d3f", "#f3c35f", "#cfc29a"];

/// Texel size of the finest octave with its own colour, in metres.
const FINEST: f32 = 1.0 / 512.0;

pub(super) fn draw() -> Result<String> {
    let mut walk = Walk::new(&Technique::default());
    for _ in 1..STILL {
        walk.step(0.0)?;
    }
    let shown = walk.step(0.0)?;
    let mut canvas = Canvas::new(456.0, "Texel sizes that a street's visible points need, and four windows");
    let look = shown.look();
    for (left, count, title) in
        [(20.0, 4, "The four windows, seen from the light"), (376.0, 3, "The three finest, enlarged")]
    {
        let (low, size) = (DVec2::new(left, 38.0), DVec2::splat(324.0));
        let windows = shown.maps[..count].iter().flat_map(|map| look.map(&map.projection));
        let frame = Frame::around(windows, low + 10.0, low + size - 10.0);
        canvas.panel(low, size, title, |canvas| panel(canvas, &shown, &look, &frame));
    }
    legend(&mut canvas, &shown);
    Ok(canvas.finish())
}

/// Draws the visible points and the windows.
fn panel(canvas: &mut Canvas, shown: &Step, look: &Look, frame: &Frame) {
    street(canvas, look, frame);
    for (i, colour) in OCTAVES.into_iter().enumerate().rev() {
        let own = shown.seen.iter().filter(|seen| shown.octave(seen) == Some(i));
        canvas.dots(own.map(|seen| frame.at(look.relative(seen.point.as_dvec3()))), 2.6, colour);
    }
    shown.outline(canvas, look, frame, 3.0);
}

/// Draws the street without its ground.
pub(super) fn street(canvas: &mut Canvas, look: &Look, frame: &Frame) {
    for aabb in &STREET[1..] {
        draw_box(canvas, frame, &look.aabb(aabb));
    }
}

/// Draws the position of the camera.
fn eye(canvas: &mut Canvas, at: DVec2) {
    canvas.circle(at, 4.5, stroke(INK, 1.5).filled("#ffffff", 1.0));
}

/// Draws the legend: colours of the points and of the windows.
fn legend(canvas: &mut Canvas, shown: &Step) {
    canvas.text(DVec2::new(20.0, 396.0), RIGHT, INK, "Points need texels of, in mm");
    for (i, colour) in OCTAVES.into_iter().enumerate() {
        let at = DVec2::new(246.0 + 78.0 * i as f64, 391.0);
        canvas.circle(at, 5.0, fill(colour, 1.0));
        let least = FINEST * 1000.0 * (1 << i) as f32;
        canvas.text(at + DVec2::new(10.0, 5.0), RIGHT, INK, &format!("{least:.0}–{:.0}", least * 2.0));
    }
    canvas.text(DVec2::new(20.0, 430.0), RIGHT, INK, "Windows have texels of, in mm");
    for (i, (map, colour)) in shown.maps.iter().zip(MAPS).enumerate() {
        let at = DVec2::new(263.0 + 86.0 * i as f64, 425.0);
        canvas.rectangle(at - 7.0, at + 7.0, stroke(colour, 3.0));
        canvas.text(at + DVec2::new(14.0, 5.0), RIGHT, INK, &format!("{:.1}", map.projection.texel_size.x * 1000.0));
    }
    eye(canvas, DVec2::new(636.0, 425.0));
    canvas.text(DVec2::new(646.0, 430.0), RIGHT, INK, "eye");
}

/// Returns evenly spread positions in a picture (the additive sequence of M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018).
fn place(i: u32) -> DVec2 {
    (DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2) * f64::from(i) + 0.5).fract()
}

/// A frame: its maps and its visible points.
pub(super) struct Step {
    pub(super) camera: PerspectiveCamera,
    pub(super) maps: FittedMaps,
    pub(super) seen: Vec<Visible>,
    pub(super) space: DemandSpace,
}

impl Step {
    /// Returns the octave of the texel size that a point needs, or `None` for a point that does not count.
    pub(super) fn octave(&self, seen: &Visible) -> Option<usize> {
        let cell = self.space.index(seen.point, seen.normal, seen.right, seen.down)?;
        let texel = self.space.texel * (1 << (cell / (SIDE * SIDE))) as f32;
        Some((libm::log2f(texel / FINEST).round().max(0.0) as usize).min(OCTAVES.len() - 1))
    }

    /// Draws the outlines of the maps and the eye.
    pub(super) fn outline(&self, canvas: &mut Canvas, look: &Look, frame: &Frame, width: f64) {
        for (map, colour) in self.maps.iter().zip(MAPS).rev() {
            canvas.polygon(look.map(&map.projection).map(|p| frame.at(p)), stroke(colour, width));
        }
        eye(canvas, frame.at(look.relative(DVec3::ZERO)));
    }

    /// Returns a view along the light, in whose plane windows are squares.
    pub(super) fn look(&self) -> Look {
        Look { origin: self.space.origin, right: self.space.x.as_dvec3(), up: self.space.y.as_dvec3() }
    }
}

/// Consecutive frames, each fitted with the visible demand of the previous one.
pub(super) struct Walk {
    technique: Technique,
    fitter: Fitter,
    /// Visible demand of the last frame: the space of its cells and their counts.
    demand: Option<(DemandSpace, Vec<u32>)>,
}

impl Walk {
    pub(super) fn new(technique: &Technique) -> Self {
        Self { technique: *technique, fitter: Fitter::new(), demand: None }
    }

    /// Computes the next frame, with the camera at a heading in degrees from -z toward +x.
    pub(super) fn step(&mut self, heading: f64) -> Result<Step> {
        let camera = PerspectiveCamera { near: 0.1, ..scene::camera(heading, -4.0, 0.8, 120.0) };
        let view = [camera.frustum()?];
        let demand = self.demand.as_ref().map(|(space, counts)| DemandGrid { space: *space, counts });
        let street = Some(Boxes::world(&STREET));
        let input =
            FitInput { receivers: street, casters: street, demand: demand.as_slice(), ..FitInput::new(&view, LIGHT) };
        let maps = self.fitter.fit(&input, &self.technique)?;
        let seen = visible(&camera, &STREET, (0..RAYS).map(place))?;
        let space = DemandSpace::new(&view[0], LIGHT, Vec3::Y, self.technique.fit.max_distance)?;
        let mut counts = vec![0; CELLS];
        for Visible { point, normal, right, down, .. } in &seen {
            if let Some(cell) = space.index(*point, *normal, *right, *down) {
                counts[cell] += 1;
            }
        }
        self.demand = Some((space, counts));
        Ok(Step { camera, maps, seen, space })
    }
}

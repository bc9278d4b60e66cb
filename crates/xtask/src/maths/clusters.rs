//! Clusters: an arch as one box and as many, and the clusters that need no map.

use anyhow::Result;
use shadowfit::clusters::Clusters;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{FitInput, PerspectiveCamera};

use super::canvas::{Canvas, Frame, GREEN, GREY, INK, RED, Side, YELLOW, fill, stroke};
use super::scene::{Look, boxes, draw_body, fit_one, plain_fit};

/// The page is the plane of x and y.
const LOOK: Look = Look { origin: DVec3::ZERO, right: DVec3::X, up: DVec3::Y };

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(372.0, "An arch as one box and as clusters, and clusters that need no map");
    arch(&mut canvas, 1, DVec2::new(122.0, 158.0), RED, "one box")?;
    arch(&mut canvas, 24, DVec2::new(352.0, 158.0), GREEN, "24 clusters")?;
    dark_slopes(&mut canvas)?;
    Ok(canvas.finish())
}

/// A strip one metre deep along a curve of the page's plane, whose points are given by a share of its length.
fn strip(count: u32, curve: impl Fn(f64) -> DVec2) -> Vec<[Vec3; 3]> {
    let at = |i: u32, z: f64| curve(f64::from(i) / f64::from(count)).extend(z).as_vec3();
    let quads = (0..count).map(|i| [at(i, -0.5), at(i + 1, -0.5), at(i + 1, 0.5), at(i, 0.5)]);
    quads.flat_map(|[a, b, c, d]| [[a, b, d], [b, c, d]]).collect()
}

/// A half circle.
fn half_circle(share: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(std::f64::consts::PI * share);
    DVec2::new(cos, sin) * 4.0
}

/// Hills that grow lower to the right.
fn hills(share: f64) -> DVec2 {
    let phase = share * std::f64::consts::TAU * 2.0;
    DVec2::new(share * 11.0 - 5.5, (2.0 - 1.2 * share) * (1.0 - libm::cos(phase)))
}

/// An arch in a number of clusters, and the map that its boxes need.
fn arch(canvas: &mut Canvas, limit: usize, middle: DVec2, colour: &'static str, name: &str) -> Result<()> {
    let triangles = strip(48, half_circle);
    let clusters = Clusters::build(&[&triangles], limit)?;
    let eye = DVec3::new(0.0, 2.0, 14.0);
    let camera =
        PerspectiveCamera { eye, forward: Vec3::NEG_Z, up: Vec3::Y, fov_y: 1.0, aspect: 1.6, near: 0.5, far: 30.0 };
    let view = [camera.frustum()?];
    let light = Vec3::new(0.62, -0.72, 0.0);
    let input = FitInput { receivers: Some(boxes(clusters.boxes())), ..FitInput::new(&view, light) };
    let settings = plain_fit().with_kind(FitKind::Focused).with_caster_extension(0.0);
    let fit = fit_one(&input, &settings)?;
    let frame = Frame::scaled(DVec2::new(0.0, 2.0), middle, 19.0);
    let map = LOOK.map(&fit);
    draw_body(canvas, &frame, &map, stroke(colour, 2.5).filled(colour, 0.07), stroke(colour, 0.0));
    for aabb in clusters.boxes() {
        draw_body(canvas, &frame, &LOOK.aabb(aabb), fill(GREY, 0.25), stroke(GREY, 0.8));
    }
    let curve = triangles.iter().step_by(2).map(|t| frame.at(LOOK.at(t[0].as_dvec3())));
    canvas.path(curve, stroke(INK, 2.5));
    canvas.bold(DVec2::new(middle.x, 322.0), Side::Middle, colour, name);
    let width = fit.texel_size.max_element() * fit.resolution.x as f32;
    canvas.label(DVec2::new(middle.x, 342.0), Side::Middle, &format!("map {width:.1} m wide"));
    Ok(())
}

/// Hills before a low sun: clusters that the eye can only see from their dark side.
fn dark_slopes(canvas: &mut Canvas) -> Result<()> {
    let triangles = strip(160, hills);
    let clusters = Clusters::build(&[&triangles], 56)?;
    let (eye, to_light) = (Vec3::new(-5.2, 5.5, 0.0), Vec3::new(0.75, 0.66, 0.0));
    let frame = Frame::scaled(DVec2::new(0.0, 1.5), DVec2::new(602.0, 205.0), 18.5);
    for (i, (aabb, cone)) in clusters.boxes().iter().zip(clusters.cones()).enumerate() {
        let colour = if cone.faces_away(aabb, eye, to_light) { INK } else { GREEN };
        // The first triangle of each two has the strip's edge along the curve.
        for (_, triangle) in clusters.triangles(i).filter(|(_, triangle)| triangle % 2 == 0) {
            let [a, b, _] = triangles[triangle as usize].map(|p| frame.at(LOOK.at(p.as_dvec3())));
            canvas.line(a, b, stroke(colour, 5.0));
        }
    }
    let eye = frame.at(LOOK.at(eye.as_dvec3()));
    canvas.circle(eye, 5.0, stroke(INK, 1.5).filled("#ffffff", 1.0));
    canvas.label(eye + DVec2::new(10.0, 5.0), Side::Right, "eye");
    for shift in [0.0, 18.0, 36.0] {
        let end = DVec2::new(624.0 + shift * 0.66, 88.0 + shift * 0.75);
        canvas.arrow(end + DVec2::new(0.75, -0.66) * 46.0, end, YELLOW, 2.0);
    }
    canvas.label(DVec2::new(632.0, 58.0), Side::Left, "light");
    canvas.bold(DVec2::new(602.0, 322.0), Side::Middle, INK, "dark: passed over");
    canvas.label(DVec2::new(602.0, 342.0), Side::Middle, "eye and light on");
    canvas.label(DVec2::new(602.0, 360.0), Side::Middle, "opposite sides");
    Ok(())
}

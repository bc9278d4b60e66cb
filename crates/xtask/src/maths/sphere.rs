//! The stable fit: the sphere in the frustum's diagonal section, and two maps on one grid.

use anyhow::Result;
use shadowfit::fits::sphere::enclosing_sphere;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::{CasterPolicy, FitKind};
use shadowfit::{FitInput, PerspectiveCamera};

use super::canvas::{BLUE, Canvas, Frame, GREY, INK, PALE, RED, Side, YELLOW, fill, stroke};
use super::scene::{Look, camera, draw_frustum, fit_one, plain_fit};

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(386.0, "A frustum's enclosing sphere, and two of its maps on the world's grid");
    section(&mut canvas)?;
    grid(&mut canvas)?;
    Ok(canvas.finish())
}

/// A section of the frustum along its diagonal, where the half diagonals r₀ and r₁ are.
fn section(canvas: &mut Canvas) -> Result<()> {
    let view = PerspectiveCamera { near: 4.0, ..camera(0.0, 0.0, 0.46, 14.0) }.frustum()?;
    let (middle, radius) = enclosing_sphere(&view)?;
    let length = |v: DVec3| libm::sqrt(v.dot(v));
    let corner = |i: usize| view.corners[i].as_dvec3();
    let diagonal = (corner(5) - corner(7)) / length(corner(5) - corner(7));
    let look = Look { origin: view.origin, right: view.forward.as_dvec3(), up: diagonal };
    let centre = look.relative(middle);
    let frame = Frame::scaled(centre, DVec2::new(180.0, 164.0), 134.0 / radius);
    let [a, b, c, d] = [1, 5, 7, 3].map(|i| look.relative(corner(i)));
    canvas.circle(frame.at(centre), frame.scale() * radius, stroke(YELLOW, 2.5).filled(YELLOW, 0.08));
    canvas.polygon([a, b, c, d].map(|p| frame.at(p)), stroke("#b08d2a", 1.2).filled("#f4e3b2", 0.75));
    let (near, far) = (DVec2::new(a.x, 0.0), DVec2::new(b.x, 0.0));
    canvas.line(frame.at(near), frame.at(far), stroke(GREY, 1.0).dashed());
    canvas.line(frame.at(centre), frame.at(b), stroke(RED, 1.6));
    canvas.line(frame.at(centre), frame.at(a), stroke(RED, 1.6));
    canvas.line(frame.at(near), frame.at(a), stroke(BLUE, 2.5));
    canvas.line(frame.at(far), frame.at(b), stroke(BLUE, 2.5));
    canvas.dot(frame.at(centre), INK);
    let middle = |p: DVec2, q: DVec2| frame.at((p + q) * 0.5);
    canvas.bold(middle(far, b) + DVec2::new(8.0, 5.0), Side::Right, BLUE, "r₁");
    canvas.bold(middle(near, a) + DVec2::new(-8.0, 5.0), Side::Left, BLUE, "r₀");
    canvas.bold(middle(centre, b) + DVec2::new(-2.0, -10.0), Side::Left, RED, "r");
    canvas.bold(middle(centre, a) + DVec2::new(4.0, -8.0), Side::Right, RED, "r");
    let below = |p: DVec2, y: f64| frame.at(p) + DVec2::new(0.0, y);
    canvas.measure(below(near, 14.0), below(centre, 14.0), INK);
    canvas.measure(below(near, 92.0), below(far, 92.0), INK);
    canvas.label(middle(near, centre) + DVec2::new(0.0, 30.0), Side::Middle, "x");
    canvas.label(middle(near, far) + DVec2::new(0.0, 109.0), Side::Middle, "L");
    canvas.label(DVec2::new(180.0, 332.0), Side::Middle, "cut along the frustum's diagonal:");
    canvas.label(DVec2::new(180.0, 352.0), Side::Middle, "x = (L² + r₁² − r₀²) / 2L");
    Ok(())
}

/// Two cameras' maps of few texels, seen from the light.
fn grid(canvas: &mut Canvas) -> Result<()> {
    let first = [camera(25.0, 0.0, 0.6, 12.0).frustum()?];
    let second = [PerspectiveCamera { eye: DVec3::new(3.4, 1.7, 1.3), ..camera(-38.0, 0.0, 0.6, 12.0) }.frustum()?];
    let settings =
        plain_fit().with_kind(FitKind::Sphere).with_casters(CasterPolicy::None).with_resolution(UVec2::splat(16));
    let light = Vec3::new(0.2, -0.9, 0.1);
    let fits =
        [fit_one(&FitInput::new(&first, light), &settings)?, fit_one(&FitInput::new(&second, light), &settings)?];
    let look = Look { origin: DVec3::ZERO, ..Look::from_light(&fits[0]) };
    let maps = fits.map(|fit| look.map(&fit));
    let all = maps.into_iter().flatten();
    let frame = Frame::around(all, DVec2::new(390.0, 24.0), DVec2::new(700.0, 312.0));
    for (map, colour) in maps.iter().zip([BLUE, RED]) {
        canvas.polygon(map[..4].iter().map(|p| frame.at(*p)), fill(colour, 0.06));
    }
    for map in &maps {
        for i in 0..=16 {
            let t = f64::from(i) / 16.0;
            let between = |a: usize, b: usize| frame.at(map[a] * (1.0 - t) + map[b] * t);
            canvas.line(between(0, 1), between(3, 2), stroke(PALE, 0.8));
            canvas.line(between(0, 3), between(1, 2), stroke(PALE, 0.8));
        }
    }
    for view in [&first[0], &second[0]] {
        draw_frustum(canvas, &frame, &look.frustum(view));
    }
    for (map, colour) in maps.iter().zip([BLUE, RED]) {
        canvas.polygon(map[..4].iter().map(|p| frame.at(*p)), stroke(colour, 2.5));
    }
    let shift = (maps[1][0] - maps[0][0]) / fits[0].texel_size.as_dvec2();
    let text = format!("moved by {:.2} and {:.2} texels", shift.x, shift.y);
    canvas.label(DVec2::new(545.0, 332.0), Side::Middle, "two cameras' maps of 16² texels:");
    canvas.label(DVec2::new(545.0, 352.0), Side::Middle, &text.replace('-', "−"));
    canvas.label(DVec2::new(545.0, 372.0), Side::Middle, "of the same size, on the same lines");
    Ok(())
}

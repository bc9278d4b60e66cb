//! Caster culling: the view swept toward the light, from the side and from the light.

use anyhow::Result;
use shadowfit::culling::Sweep;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::settings::FitKind;
use shadowfit::{Aabb, CasterVolume, FitInput, LightFit, ViewFrustum};

use super::canvas::{BLUE, Canvas, Frame, GREEN, GREY, INK, Side, bounds, fill, stroke};
use super::near_plane::cut;
use super::scene::{Look, camera, draw_body, draw_frustum, fit_one, hull, plain_fit};

pub(super) fn draw() -> Result<String> {
    let mut canvas = Canvas::new(414.0, "Casters kept and culled by the view swept toward the light");
    from_side(&mut canvas)?;
    from_light(&mut canvas)?;
    Ok(canvas.finish())
}

/// A map of a view and the volume that can throw shadows into it.
fn volumes(view: ViewFrustum, light: Vec3) -> Result<(LightFit, CasterVolume)> {
    let views = [view];
    let settings = plain_fit().with_kind(FitKind::Oriented).with_caster_extension(12.0);
    let fit = fit_one(&FitInput::new(&views, light), &settings)?;
    let volume = CasterVolume::swept(&fit, &Sweep::new(&views))?;
    Ok((fit, volume))
}

/// A caster's box in its colour: kept or culled.
fn draw_caster(canvas: &mut Canvas, frame: &Frame, look: &Look, volume: &CasterVolume, aabb: &Aabb) {
    let to = |p: Vec3| (p.as_dvec3() - volume.origin).as_vec3();
    let is_kept = volume.intersects_aabb(to(aabb.min), to(aabb.max));
    let (colour, opacity) = if is_kept { (GREEN, 0.6) } else { (GREY, 0.15) };
    draw_body(canvas, frame, &look.aabb(aabb), stroke(colour, 1.2).filled(colour, opacity), stroke(colour, 0.0));
}

/// Small boxes at places that look random: the fractional parts of multiples of irrational numbers.
fn scattered(count: u32, low: DVec3, high: DVec3) -> Vec<Aabb> {
    let share = |i: u32, step: f64| f64::from(i) * step - libm::floor(f64::from(i) * step);
    let at =
        |i| low + (high - low) * DVec3::new(share(i, 0.819_172_51), share(i, 0.671_043_61), share(i, 0.549_700_48));
    (1..=count).map(at).map(|p| Aabb::new((p - 0.45).as_vec3(), (p + 0.45).as_vec3())).collect()
}

fn from_side(canvas: &mut Canvas) -> Result<()> {
    let view = camera(90.0, -3.0, 0.75, 15.0).frustum()?;
    let (fit, volume) = volumes(view, Vec3::new(0.5, -0.86, 0.0))?;
    let flat = fit_one(&FitInput::new(&[view], fit.direction), &plain_fit())?;
    let look = Look::from_side(&flat);
    let (low, high) = bounds(look.map(&fit));
    let (low, high) = (low - DVec2::new(3.0, 1.5), high + DVec2::new(3.0, 0.0));
    let frame = Frame::around([low, high], DVec2::new(20.0, 36.0), DVec2::new(330.0, 352.0));
    // The volume where it meets the page: the panel cut by each of its planes.
    let mut section = vec![low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
    for plane in volume.active_planes() {
        let normal = plane.truncate().as_dvec3();
        let offset = look.origin - volume.origin;
        let inside = |p: DVec2| normal.dot(look.right * p.x + look.up * p.y + offset) + f64::from(plane.w);
        section = cut(&section, inside);
    }
    canvas.polygon(section.iter().map(|p| frame.at(*p)), fill(GREEN, 0.12));
    canvas.polygon(hull(&look.map(&fit)).into_iter().map(|p| frame.at(p)), stroke(BLUE, 1.5).dashed());
    draw_frustum(canvas, &frame, &look.frustum(&view));
    canvas.path(section.iter().map(|p| frame.at(*p)), stroke(GREEN, 2.5));
    let (a, b) = (DVec3::new(-9.0, -7.0, 0.0), DVec3::new(17.0, 17.0, 0.0));
    for aabb in scattered(46, a, b) {
        let at = look.aabb(&aabb);
        let (from, to) = bounds(at);
        if from.x > low.x && to.x < high.x && from.y > low.y && to.y < high.y {
            draw_caster(canvas, &frame, &look, &volume, &aabb);
        }
    }
    canvas.label(DVec2::new(175.0, 24.0), Side::Middle, "open toward the light");
    canvas.bold(DVec2::new(175.0, 378.0), Side::Middle, INK, "From the side");
    canvas.label(DVec2::new(175.0, 398.0), Side::Middle, "green: kept; dashed: the map's own box");
    Ok(())
}

fn from_light(canvas: &mut Canvas) -> Result<()> {
    let view = camera(40.0, -4.0, 0.6, 26.0).frustum()?;
    let (fit, volume) = volumes(view, Vec3::new(0.3, -0.85, 0.2))?;
    let look = Look::from_light(&fit_one(&FitInput::new(&[view], fit.direction), &plain_fit())?);
    let map = look.map(&fit);
    let frame = Frame::around(map, DVec2::new(400.0, 36.0), DVec2::new(690.0, 352.0));
    draw_frustum(canvas, &frame, &look.frustum(&view));
    let casters = scattered(120, DVec3::new(-4.0, 0.0, -28.0), DVec3::new(30.0, 9.0, 4.0));
    let own = fit.caster_volume();
    let (mut in_map, mut kept) = (0, 0);
    for aabb in &casters {
        let to = |p: Vec3| (p.as_dvec3() - fit.origin).as_vec3();
        if own.intersects_aabb(to(aabb.min), to(aabb.max)) {
            in_map += 1;
            kept += u32::from(volume.intersects_aabb(to(aabb.min), to(aabb.max)));
            draw_caster(canvas, &frame, &look, &volume, aabb);
        }
    }
    canvas.polygon(hull(&look.frustum(&view)).into_iter().map(|p| frame.at(p)), stroke(GREEN, 2.5));
    canvas.polygon(map[..4].iter().map(|p| frame.at(*p)), stroke(BLUE, 1.5).dashed());
    canvas.bold(DVec2::new(545.0, 378.0), Side::Middle, INK, "From the light");
    let text = format!("the map's box holds {in_map}, the sweep {kept}");
    canvas.label(DVec2::new(545.0, 398.0), Side::Middle, &text);
    Ok(())
}

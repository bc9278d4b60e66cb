//! Windows under a light that is rounded, that steps, and that passes through the vertical.

use shadowfit::glam::{DQuat, DVec3, Vec3, Vec4};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::{FittedMap, FittedMaps};

use super::{Run, hits, street_view, town, windows};

/// Returns the direction of a sun on a circle over the sky: at an angle past the zenith, in radians, and
/// `off` its plane.
fn sun(angle: f64, off: f64) -> Vec3 {
    DVec3::new(angle.sin(), -angle.cos(), off).normalize().as_vec3()
}

#[test]
fn a_light_that_differs_by_rounding_changes_nothing() {
    let view = street_view(DVec3::new(12.0, 1.7, 20.0), Vec3::new(0.2, -0.1, -1.0));
    for light in [Vec3::new(0.3, -0.8, 0.4), Vec3::NEG_Y, sun(1.3, 0.2)] {
        let (mut run, mut other) = (Run::new(town(), &windows(4, 1024)), Run::new(town(), &windows(4, 1024)));
        for frame in 0..40_u8 {
            let next = |v: f32, i: u8| if (frame + i).is_multiple_of(3) { v.next_up() } else { v };
            // The grid's light is rounded too.
            let rounded = Vec3::new(next(light.x, 0), next(light.y, 1), next(light.z, 2));
            let first = if frame == 0 { light } else { rounded };
            let (plain, rounded) = (run.frame(&view, light), other.frame(&view, first));
            let same = |a: &FittedMaps, b: &FittedMaps| {
                a.iter().zip(b.iter()).all(|(a, b)| {
                    a.grid_position == b.grid_position && a.projection == b.projection && a.bias == b.bias
                })
            };
            assert!(same(&plain, &rounded), "frame {frame} of {light}");
        }
    }
}

/// Greatest movement of a window's middle, as a share of its side, when the light steps by about 0.1°: half
/// of the grid step of candidate positions.
const MOVED: f64 = 1.0 / 32.0;

#[test]
fn a_step_of_the_light_keeps_sizes_and_roughly_the_places() {
    let settings = LightSteps::default().with_texels(1.0).with_extent(1024.0);
    let view = street_view(DVec3::new(12.0, 1.7, 20.0), Vec3::new(0.2, -0.1, -1.0));
    for begin in [0.2, 0.9] {
        let (mut run, mut steps) = (Run::new(town(), &windows(4, 1024)), LightStepState::default());
        let mut before = None;
        let (mut taken, mut moved, mut resized) = (0, Vec::new(), 0);
        for frame in 0..160_u16 {
            // The light moves only after the search has settled.
            let angle = begin + f64::from(frame.saturating_sub(60)) * 1e-4;
            let light = steps.update(sun(angle, 0.2), &settings, 0.016).unwrap().direction;
            let now = run.frame(&view, light);
            if let Some((old_light, old)) = before.replace((light, now)).filter(|(old, _)| *old != light) {
                taken += 1;
                assert!(f64::from((light - old_light).length()) < 0.003, "{light} after {old_light}");
                for (old, map) in old.iter().zip(now.iter()) {
                    resized += usize::from(old.projection.texel_size.x != map.projection.texel_size.x);
                    // The point in the middle of the window, at the eye's position along the light.
                    let rows = old.projection.light_from_world.transpose();
                    let t = old.projection.light_from_world.w_axis.truncate();
                    let middle = old.projection.origin
                        - (rows.x_axis.truncate() * t.x + rows.y_axis.truncate() * t.y).as_dvec3();
                    let uv = map.projection.uv_from_world.transform_point3((middle - map.projection.origin).as_vec3());
                    moved.push((f64::from(uv.x) - 0.5).abs().max((f64::from(uv.y) - 0.5).abs()));
                }
            }
        }
        assert!(taken >= 4, "{taken} steps");
        assert_eq!(resized, 0, "windows changed their sizes with the light's steps");
        moved.sort_by(f64::total_cmp);
        let (median, most) = (moved[moved.len() / 2], moved[moved.len() - 1]);
        assert!(median < MOVED / 4.0 && most < MOVED, "middles moved by {median} and at most {most} of a side");
    }
}

/// A whole day and night in steps of three degrees, through the zenith and just beside it.
#[test]
fn nothing_is_uncovered_while_the_light_goes_round() {
    let view = street_view(DVec3::new(12.0, 1.7, 20.0), Vec3::new(0.2, -0.2, -1.0));
    let world = town();
    let seen: Vec<DVec3> =
        hits(&view, world.origin, &world.boxes, f64::MAX).iter().map(|hit| view.eye + hit.point).collect();
    for (off, up) in [(0.0, Vec3::Y), (1e-7, Vec3::Y), (0.3, Vec3::Y), (0.0, Vec3::Z), (0.2, Vec3::new(0.3, 0.7, -0.2))]
    {
        let technique = windows(4, 256);
        let mut run = Run::new(world.clone(), &technique.with_fit(technique.fit.with_up(up)));
        for degrees in (-180..180_i16).step_by(if off == 0.0 && up == Vec3::Y { 3 } else { 9 }) {
            let maps = run.frame(&view, sun(f64::from(degrees).to_radians(), off));
            let last = &maps[3].projection;
            assert!(
                seen.iter().all(|point| last.texels_to_edge(*point).is_some_and(|free| free > 2.0)),
                "at {degrees}°"
            );
        }
    }
}

/// The light and the camera jump randomly.
#[test]
fn nothing_is_uncovered_where_light_and_camera_leap() {
    let world = town();
    let mut run = Run::new(world.clone(), &windows(6, 256));
    for frame in 0..60_u16 {
        let f = f64::from(frame);
        let turn = DQuat::from_euler(shadowfit::glam::EulerRot::XYZ, f * 2.4, f * 1.1, f * 0.7);
        let eye = DVec3::new((f * 1.7).sin() * 100.0, 2.0 + f, (f * 2.3).cos() * 100.0);
        let view = street_view(eye, (turn * DVec3::new(0.1, -0.5, -1.0)).as_vec3());
        let maps = run.frame(&view, (turn * DVec3::NEG_X).as_vec3());
        for hit in hits(&view, world.origin, &world.boxes, f64::MAX) {
            let free = maps[5].projection.texels_to_edge(view.eye + hit.point);
            assert!(free.is_some_and(|free| free > 2.0), "{free:?} texels in frame {frame}");
        }
    }
}

/// Returns the slope of an edge in the map: rows per column of texels or columns per row, whichever is
/// smaller. A 5×5 filter smooths edges for which neither is near 0.
fn slant(map: &FittedMap, edge: DVec3) -> f64 {
    let rows = map.projection.light_from_world.transpose();
    let texel = map.projection.texel_size.as_dvec2();
    let along = |row: Vec4, side: f64| (row.truncate().as_dvec3().dot(edge) / side).abs();
    let (across, up) = (along(rows.x_axis, texel.x), along(rows.y_axis, texel.y));
    (across / up).min(up / across)
}

/// Tangent of the rotation angle of texels, divided by their ratio of height to width.
const TURN: f64 = 0.45;

#[test]
fn shadows_of_upright_edges_run_across_the_columns_of_texels() {
    let view = street_view(DVec3::new(12.0, 1.7, 20.0), Vec3::new(0.2, -0.1, -1.0));
    for elevation in [5.0_f64, 15.0, 25.0, 35.0, 45.0, 60.0] {
        for azimuth in [0.0_f64, 37.0, 90.0, 200.0] {
            let (e, a) = (elevation.to_radians(), azimuth.to_radians());
            let toward = DVec3::new(e.cos() * a.sin(), e.sin(), e.cos() * a.cos());
            let maps = Run::new(town(), &windows(4, 1024)).frame(&view, -toward.as_vec3());
            let texel = maps[0].projection.texel_size;
            let shape = f64::from(texel.y / texel.x);
            let (upright, level) = (slant(&maps[0], DVec3::Y), slant(&maps[0], DVec3::Y.cross(toward)));
            assert!((upright - shape * shape * TURN).abs() < 1e-3, "{upright} at {elevation}° with texels 1 : {shape}");
            assert!((level - TURN).abs() < 1e-3, "{level} at {elevation}°");
        }
    }
}

//! The XNA fit against the published vectors of the sample, 24 cameras and lights.

use shadowfit::LightProjection;
use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::settings::FitKind;

use crate::support::{XnaCase, exact, fitted, numbers, relative_error, xna_cases};

/// Precision of the vectors: 1e-5 of each quantity's largest element.
const TOLERANCE: f64 = 1e-5;

fn elements(matrix: &Mat4) -> Vec<f64> {
    matrix.to_cols_array().map(f64::from).to_vec()
}

fn check(index: usize, case: &XnaCase, quantity: &str, actual: &[f64]) {
    let error = relative_error(actual, &numbers(&case.json[quantity]));
    assert!(error <= TOLERANCE, "case {index}: {quantity} is off by {error:e}");
}

fn fit_of(case: &XnaCase) -> LightProjection {
    fitted(&case.camera, case.direction, &exact(FitKind::XnaSample))
}

#[test]
fn the_published_file_has_24_cases() {
    assert_eq!(xna_cases().len(), 24);
}

#[test]
fn corners_from_camera_parameters_equal_the_published_ones() {
    for (i, case) in xna_cases().iter().enumerate() {
        let frustum = case.camera.frustum().unwrap();
        let world: Vec<f64> = frustum.corners.iter().flat_map(|c| (frustum.origin + c.as_dvec3()).to_array()).collect();
        check(i, case, "frustum_corners", &world);
    }
}

#[test]
fn xna_box_size_equals_the_published_one() {
    for (i, case) in xna_cases().iter().enumerate() {
        let fit = fit_of(case);
        check(i, case, "box_size", &(fit.box_max - fit.box_min).as_dvec3().to_array());
    }
}

#[test]
fn xna_light_position_equals_the_published_one() {
    for (i, case) in xna_cases().iter().enumerate() {
        check(i, case, "light_position", &fit_of(case).light_position().to_array());
    }
}

#[test]
fn xna_world_matrices_equal_the_published_ones() {
    for (i, case) in xna_cases().iter().enumerate() {
        let matrices = fit_of(case).world_matrices();
        check(i, case, "light_view", &elements(&matrices.light_from_world));
        check(i, case, "light_projection", &elements(&matrices.clip_from_light));
        check(i, case, "light_view_projection", &elements(&matrices.clip_from_world));
    }
}

#[test]
fn xna_depth_range_is_twice_the_published_box_depth() {
    for (i, case) in xna_cases().iter().enumerate() {
        let depth = numbers(&case.json["box_size"])[2];
        let error = (f64::from(fit_of(case).depth_range) / (2.0 * depth) - 1.0).abs();
        assert!(error <= TOLERANCE, "case {i}: off by {error:e}");
    }
}

#[test]
fn xna_margin_enlarges_the_box_on_all_six_sides() {
    for case in &xna_cases() {
        let plain = fit_of(case);
        // A margin of the order of the box, so that rounding of the difference stays small.
        let margin = plain.depth_range;
        let settings = exact(FitKind::XnaSample).with_margin(margin);
        let wide = fitted(&case.camera, case.direction, &settings);
        let grown = (wide.box_max - wide.box_min) - (plain.box_max - plain.box_min);
        assert!((grown / (2.0 * margin) - Vec3::ONE).abs().max_element() < 1e-5, "{grown} for {margin}");
        // The light moves back by the margin and keeps its x and y.
        let moved = wide.light_position() - plain.light_position();
        let expected: DVec3 = case.direction.as_dvec3() * f64::from(margin);
        assert!((moved - expected).length() < 1e-5 * f64::from(margin), "{moved} for {expected}");
    }
}

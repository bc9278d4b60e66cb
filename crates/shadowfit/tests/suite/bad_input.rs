//! NaN, infinity, zero, subnormal and huge values in every float input: an error or a finite fit, never a
//! panic.

use proptest::prelude::*;
use shadowfit::glam::{DMat4, DVec3, Mat4, UVec2, Vec3};
use shadowfit::settings::FitSettings;
use shadowfit::{DepthConvention, FitError, LightProjection, PerspectiveCamera, ViewFrustum};

use crate::support::{DIRECTION, KINDS, any_kind, camera, cases, exact, fitted};

const NOT_FINITE: [f32; 3] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];

/// A float input of the whole chain with its name.
type Setter = (&'static str, fn(&mut Inputs, f32));

#[derive(Clone, Copy)]
struct Inputs {
    camera: PerspectiveCamera,
    direction: Vec3,
    settings: FitSettings,
}

impl Inputs {
    fn fit(&self) -> Result<LightProjection, FitError> {
        shadowfit::fit(&self.camera.frustum()?, self.direction, &self.settings)
    }
}

/// Every float of camera, light and settings.
const SETTERS: [Setter; 19] = [
    ("eye.x", |i, v| i.camera.eye.x = f64::from(v)),
    ("eye.y", |i, v| i.camera.eye.y = f64::from(v)),
    ("eye.z", |i, v| i.camera.eye.z = f64::from(v)),
    ("forward.x", |i, v| i.camera.forward.x = v),
    ("forward.y", |i, v| i.camera.forward.y = v),
    ("forward.z", |i, v| i.camera.forward.z = v),
    ("up.x", |i, v| i.camera.up.x = v),
    ("up.y", |i, v| i.camera.up.y = v),
    ("up.z", |i, v| i.camera.up.z = v),
    ("fov_y", |i, v| i.camera.fov_y = v),
    ("aspect", |i, v| i.camera.aspect = v),
    ("near", |i, v| i.camera.near = v),
    ("far", |i, v| i.camera.far = v),
    ("direction.x", |i, v| i.direction.x = v),
    ("direction.y", |i, v| i.direction.y = v),
    ("direction.z", |i, v| i.direction.z = v),
    ("max_distance", |i, v| i.settings.map.max_distance = v),
    ("margin", |i, v| i.settings.map.margin = v),
    ("caster_extension", |i, v| i.settings.map.caster_extension = v),
];

fn good(kind: shadowfit::settings::FitKind) -> Inputs {
    Inputs { camera: camera(), direction: DIRECTION, settings: exact(kind) }
}

fn is_finite(fit: &LightProjection) -> bool {
    let world = fit.world_matrices();
    let matrices = [
        fit.light_from_world,
        fit.clip_from_light,
        fit.clip_from_world,
        fit.uv_from_world,
        world.light_from_world,
        world.clip_from_world,
    ];
    matrices.iter().all(Mat4::is_finite)
        && fit.texel_size.is_finite()
        && fit.texel_size.min_element() > 0.0
        && fit.depth_range.is_finite()
        && fit.depth_range > 0.0
        && fit.light_position().is_finite()
}

#[test]
fn nan_and_infinity_in_each_float_input_are_refused_as_not_finite() {
    for kind in KINDS {
        for (name, set) in SETTERS {
            for value in NOT_FINITE {
                let mut inputs = good(kind);
                set(&mut inputs, value);
                let result = inputs.fit();
                assert!(matches!(result, Err(FitError::NotFinite { .. })), "{name} = {value}: {result:?}");
            }
        }
    }
}

#[test]
fn zero_subnormal_and_huge_values_give_an_error_or_a_finite_fit() {
    for kind in KINDS {
        for (name, set) in SETTERS {
            for value in [0.0, -0.0, 1e-45, -1e-45, f32::MIN_POSITIVE, 1e-20, 1e20, f32::MAX, f32::MIN] {
                let mut inputs = good(kind);
                set(&mut inputs, value);
                if let Ok(fit) = inputs.fit() {
                    assert!(is_finite(&fit), "{name} = {value:e}: {fit:?}");
                }
            }
        }
    }
}

#[test]
fn lengths_and_lens_values_without_meaning_are_refused() {
    let tables: [(&str, &[f32]); 8] = [
        ("fov_y", &[0.0, -1.0, 1e-45, 3.2, f32::MAX]),
        ("aspect", &[0.0, -1.0, 1e-45, f32::MAX]),
        ("near", &[0.0, -1.0, 1e-45, f32::MAX]),
        ("far", &[0.0, -1.0, 1e-45, f32::MAX]),
        ("margin", &[-1.0, f32::MAX]),
        ("caster_extension", &[-1.0, f32::MAX]),
        ("max_distance", &[0.0, -1.0, 1e-45]),
        ("eye.x", &[f32::MAX, f32::MIN]),
    ];
    for (name, values) in tables {
        let (_, set) = SETTERS.into_iter().find(|(n, _)| *n == name).unwrap();
        for value in values {
            for kind in KINDS {
                let mut inputs = good(kind);
                set(&mut inputs, *value);
                assert!(inputs.fit().is_err(), "{name} = {value:e}");
            }
        }
    }
}

#[test]
fn zero_subnormal_and_huge_directions_are_refused_with_their_length() {
    for length in [0.0, 1e-45, 1e-20, 1e20, f32::MAX] {
        for kind in KINDS {
            let inputs = Inputs { direction: Vec3::new(0.0, -length, 0.0), ..good(kind) };
            let expected = FitError::BadDirection { input: "the light's direction", length: f64::from(length) };
            assert_eq!(inputs.fit(), Err(expected));
        }
        let forward = PerspectiveCamera { forward: Vec3::X * length, ..camera() };
        assert!(matches!(forward.frustum(), Err(FitError::BadDirection { .. })), "{length:e}");
        let up = PerspectiveCamera { up: Vec3::X * length, ..camera() };
        assert!(matches!(up.frustum(), Err(FitError::BadDirection { .. })), "{length:e}");
    }
}

#[test]
fn an_up_parallel_to_forward_is_refused() {
    let flat = PerspectiveCamera { forward: Vec3::NEG_Y, up: Vec3::Y * 2.0, ..camera() };
    let (forward, up) = (flat.forward, flat.up);
    assert_eq!(flat.frustum(), Err(FitError::ParallelUp { forward, up }));
}

#[test]
fn near_at_or_beyond_far_is_refused_with_both() {
    for (near, far) in [(80.0, 80.0), (90.0, 80.0)] {
        let camera = PerspectiveCamera { near, far, ..camera() };
        assert_eq!(camera.frustum(), Err(FitError::NearNotBelowFar { near, far }));
    }
}

#[test]
fn a_resolution_with_no_texels_is_refused() {
    for resolution in [UVec2::ZERO, UVec2::new(0, 64), UVec2::new(64, 0)] {
        for kind in KINDS {
            let result =
                shadowfit::fit(&camera().frustum().unwrap(), DIRECTION, &exact(kind).with_resolution(resolution));
            assert_eq!(result, Err(FitError::ZeroResolution { resolution }));
        }
    }
}

#[test]
fn a_frustum_filled_with_bad_numbers_by_hand_is_refused() {
    let good = camera().frustum().unwrap();
    for kind in KINDS {
        for value in NOT_FINITE {
            for i in 0..8 {
                let mut bad = good;
                bad.corners[i].y = value;
                assert!(matches!(shadowfit::fit(&bad, DIRECTION, &exact(kind)), Err(FitError::NotFinite { .. })));
            }
            for bad in [ViewFrustum { near: value, ..good }, ViewFrustum { far: value, ..good }] {
                let result = shadowfit::fit(&bad, DIRECTION, &exact(kind));
                assert!(matches!(result, Err(FitError::NotFinite { .. })), "{result:?}");
            }
            let bad = ViewFrustum { origin: DVec3::new(0.0, f64::from(value), 0.0), ..good };
            assert!(matches!(shadowfit::fit(&bad, DIRECTION, &exact(kind)), Err(FitError::NotFinite { .. })));
        }
        let flat = ViewFrustum { corners: good.corners.map(|c| c.with_y(0.0)), ..good };
        assert!(matches!(shadowfit::fit(&flat, DIRECTION, &exact(kind)), Err(FitError::EmptyFrustum { .. })));
        let point = ViewFrustum { corners: [Vec3::ONE; 8], ..good };
        assert!(matches!(shadowfit::fit(&point, DIRECTION, &exact(kind)), Err(FitError::EmptyFrustum { .. })));
    }
}

#[test]
fn slice_depths_that_are_not_finite_are_refused() {
    let frustum = camera().frustum().unwrap();
    for value in NOT_FINITE {
        assert!(matches!(frustum.slice(value, 10.0), Err(FitError::NotFinite { .. })));
        assert!(matches!(frustum.slice(1.0, value), Err(FitError::NotFinite { .. })));
    }
}

fn read(matrix: &Mat4, eye: DVec3, max_distance: f32) -> Result<ViewFrustum, FitError> {
    ViewFrustum::from_world_from_clip(matrix, eye, DepthConvention::ZeroToOne, max_distance)
}

#[test]
fn matrices_with_a_bad_element_are_refused() {
    let good = camera().clip_from_world(DepthConvention::ZeroToOne).inverse();
    for i in 0..16 {
        for value in NOT_FINITE {
            let mut elements = good.to_cols_array();
            elements[i] = value;
            let result = read(&Mat4::from_cols_array(&elements), DVec3::ZERO, 50.0);
            assert!(matches!(result, Err(FitError::NotFinite { .. })), "element {i} = {value}: {result:?}");
        }
    }
}

#[test]
fn singular_matrices_are_refused() {
    let one = DMat4::IDENTITY;
    let singular = [
        DMat4::ZERO,
        DMat4::from_scale(DVec3::new(0.0, 1.0, 1.0)),
        DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0)),
        DMat4::from_scale(DVec3::new(1.0, 1.0, 0.0)),
        DMat4::from_cols(one.x_axis, one.y_axis, one.z_axis, one.z_axis * 0.0),
        DMat4::from_cols(one.x_axis, one.x_axis, one.z_axis, one.w_axis),
    ];
    for matrix in singular {
        let result = read(&matrix.as_mat4(), DVec3::ZERO, 50.0);
        assert!(matches!(result, Err(FitError::SingularMatrix { .. })), "{matrix}: {result:?}");
    }
}

#[test]
fn eye_and_maximum_distance_of_a_matrix_frustum_are_checked() {
    let good = camera().clip_from_world(DepthConvention::ZeroToOne).inverse();
    for value in NOT_FINITE {
        let eye = DVec3::splat(f64::from(value));
        assert!(matches!(read(&good, eye, 50.0), Err(FitError::NotFinite { .. })));
        assert!(matches!(read(&good, DVec3::ZERO, value), Err(FitError::NotFinite { .. })));
    }
    for value in [0.0, -1.0, 1e-45, f32::MIN] {
        assert!(matches!(read(&good, DVec3::ZERO, value), Err(FitError::NearNotBelowFar { .. })), "{value}");
    }
}

#[test]
fn diagnostics_refuse_bad_points_normals_and_matrices() {
    let fit = fitted(&camera(), DIRECTION, &exact(shadowfit::settings::FitKind::FrustumAabb));
    let clip = camera().clip_from_world(DepthConvention::ZeroToOne);
    let at = |clip: &Mat4, point, normal| {
        shadowfit::diagnostics::pixels_per_texel(&fit, clip, UVec2::new(640, 480), point, normal)
    };
    for value in NOT_FINITE {
        let bad = Vec3::new(0.0, value, 0.0);
        assert!(matches!(at(&clip, bad, Vec3::Y), Err(FitError::NotFinite { .. })));
        assert!(matches!(at(&clip, Vec3::NEG_Z, bad), Err(FitError::NotFinite { .. })));
        let matrix = Mat4::from_cols_array(&[value; 16]);
        assert!(matches!(at(&matrix, Vec3::NEG_Z, Vec3::Y), Err(FitError::NotFinite { .. })));
    }
    assert!(matches!(at(&clip, Vec3::NEG_Z, Vec3::ZERO), Err(FitError::BadDirection { .. })));
}

#[test]
fn every_error_says_the_value_and_what_to_do() {
    let errors = [
        (FitError::NotFinite { input: "near", value: f64::NAN }, "near is NaN; give"),
        (
            FitError::OutOfRange { input: "fov_y", value: 9.0, min: 0.0, max: 3.0 },
            "fov_y is 9; give a value from 0 to 3",
        ),
        (FitError::BadDirection { input: "the light's direction", length: 0.0 }, "length 0; give"),
        (FitError::ParallelUp { forward: Vec3::Y, up: Vec3::Y }, "tilt one"),
        (FitError::SingularMatrix { corner: 4, w: 0.0 }, "clip corner 4; pass"),
        (FitError::EmptyFrustum { size: Vec3::ZERO }, "(0, 0, 0) m; check"),
        (FitError::NearNotBelowFar { near: 2.0, far: 1.0 }, "near 2 m is not below far 1 m; raise"),
        (FitError::ClampedCasters, "needs the distance of each caster, which depth clamp loses; choose another"),
        (FitError::ZeroResolution { resolution: UVec2::ZERO }, "0 × 0; give"),
    ];
    for (error, part) in errors {
        assert!(error.to_string().contains(part), "{error}");
    }
}

proptest! {
    #![proptest_config(cases(2000))]

    /// All floats at once, from any bit pattern.
    #[test]
    fn no_bit_pattern_panics_and_every_fit_that_is_made_is_finite(
        bits in prop::array::uniform19(any::<u32>()), replaced in any::<u32>(), kind in any_kind(),
    ) {
        let mut inputs = good(kind);
        for (i, (_, set)) in SETTERS.into_iter().enumerate() {
            if replaced & (1 << i) != 0 {
                set(&mut inputs, f32::from_bits(bits[i]));
            }
        }
        if let Ok(fit) = inputs.fit() {
            prop_assert!(is_finite(&fit), "{fit:?}");
        }
    }

    #[test]
    fn no_matrix_panics(bits in prop::array::uniform16(any::<u32>()), replaced in any::<u16>(), limit in any::<u32>()) {
        let mut elements = camera().clip_from_world(DepthConvention::ZeroToOne).inverse().to_cols_array();
        for (i, element) in elements.iter_mut().enumerate() {
            if replaced & (1 << i) != 0 {
                *element = f32::from_bits(bits[i]);
            }
        }
        let frustum = read(&Mat4::from_cols_array(&elements), DVec3::ZERO, f32::from_bits(limit));
        let settings = exact(shadowfit::settings::FitKind::FrustumAabb);
        if let Ok(fit) = frustum.and_then(|frustum| shadowfit::fit(&frustum, DIRECTION, &settings)) {
            prop_assert!(is_finite(&fit), "{fit:?}");
        }
    }
}

//! Fits made from other code's matrices.

use shadowfit::glam::{DMat4, DVec3, Mat4, UVec2, Vec3};
use shadowfit::settings::{FitKind, FitSettings};
use shadowfit::{DepthConvention, FitError, LightProjection, PerspectiveCamera, fit};

const REVERSED: DepthConvention = DepthConvention::Reversed;
const DEPTHS: [DepthConvention; 3] = [DepthConvention::ZeroToOne, REVERSED, DepthConvention::NegativeOneToOne];
const DIRECTION: Vec3 = Vec3::new(0.4, -0.8, 0.3);

fn known(kind: FitKind, depth: DepthConvention) -> LightProjection {
    let camera = PerspectiveCamera {
        eye: DVec3::new(120.0, 30.0, -75.0),
        forward: Vec3::new(0.3, -0.2, -1.0),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 100.0,
    };
    let settings = FitSettings::default().with_kind(kind).with_depth(depth).with_resolution(UVec2::new(1024, 512));
    fit(&camera.frustum().unwrap(), DIRECTION, &settings).unwrap()
}

/// Returns the clip-from-world matrix in f64.
fn world_matrix(fit: &LightProjection) -> DMat4 {
    fit.clip_from_world.as_dmat4() * DMat4::from_translation(-fit.origin)
}

#[test]
fn the_matrix_of_a_fit_gives_the_fit_back() {
    for kind in [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere] {
        for depth in DEPTHS {
            let known = known(kind, depth);
            let again = LightProjection::from_clip_from_world(
                &world_matrix(&known),
                depth,
                DIRECTION,
                known.resolution,
                known.origin,
            )
            .unwrap();
            for other in DEPTHS.into_iter().filter(|other| (*other == REVERSED) != (depth == REVERSED)) {
                let matrix = world_matrix(&known);
                LightProjection::from_clip_from_world(&matrix, other, DIRECTION, UVec2::ONE, known.origin)
                    .expect_err("its depth runs the other way");
            }
            assert_eq!((again.depth, again.resolution, again.origin), (depth, known.resolution, known.origin));
            // Rows are normalised once more: a few roundings of the extent, which is about 100 m.
            assert!(again.clip_from_world.abs_diff_eq(known.clip_from_world, 4e-6), "{again:?}\n{known:?}");
            assert!(again.uv_from_world.abs_diff_eq(known.uv_from_world, 4e-6));
            assert!(again.texel_size.abs_diff_eq(known.texel_size, 1e-6));
            assert!((again.depth_range - known.depth_range).abs() < 1e-3, "{kind:?} {depth:?}");
            assert!((again.direction - known.direction).length() < 1e-6);
            assert!((again.box_max - known.box_max).length() < 1e-3, "{:?} {:?}", again.box_max, known.box_max);
        }
    }
}

#[test]
fn what_is_no_orthographic_view_projection_of_the_light_is_refused() {
    let known = known(FitKind::Oriented, DepthConvention::ZeroToOne);
    let good = world_matrix(&known);
    let why = |matrix: DMat4, direction: Vec3| match LightProjection::from_clip_from_world(
        &matrix,
        DepthConvention::ZeroToOne,
        direction,
        UVec2::splat(64),
        known.origin,
    ) {
        Err(FitError::NotOrthographic { why }) => why.to_owned(),
        other => format!("{other:?}"),
    };
    let perspective = shadowfit::glam::camera::rh::proj::directx::perspective(1.0, 1.0, 0.1, 10.0).as_dmat4();
    assert_eq!(why(perspective, Vec3::NEG_Z), "it is a perspective");
    assert_eq!(why(good, Vec3::X), "its depth does not run along the light's direction");
    let sheared =
        Mat4::from_cols_array(&[1.0, 0.3, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    assert_eq!(why(sheared.as_dmat4() * good, DIRECTION), "its axes are not perpendicular");
    assert_eq!(why(DMat4::from_scale(DVec3::new(0.0, 1.0, 1.0)) * good, DIRECTION), "it is flat");
    let mut broken = good;
    broken.w_axis.x = f64::NAN;
    assert!(why(broken, DIRECTION).contains("NotFinite"));
    let made = |direction, resolution| {
        LightProjection::from_clip_from_world(&good, DepthConvention::ZeroToOne, direction, resolution, DVec3::ZERO)
    };
    assert!(made(Vec3::ZERO, UVec2::ONE).is_err() && made(DIRECTION, UVec2::ZERO).is_err());
}

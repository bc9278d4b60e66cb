//! Batched culling gives the same results as the tests of single shapes, to the last bit.

use proptest::prelude::*;
use shadowfit::culling::{Bounds, OrientedBox, Sphere, Sweep, cull};
use shadowfit::glam::{DVec3, Vec3, Vec4};
use shadowfit::settings::FitKind;
use shadowfit::{Aabb, CasterVolume};

use crate::support::{any_camera, any_direction, camera, exact, fitted, float};

/// Ordinary numbers, and occasionally an awkward one.
fn any_number(half: f64) -> impl Strategy<Value = f32> {
    prop_oneof![
        40 => float(-half, half),
        1 => prop_oneof![
            Just(0.0), Just(-0.0), Just(f32::NAN), Just(f32::INFINITY), Just(f32::NEG_INFINITY), Just(f32::MAX),
            Just(f32::MIN), Just(1e-40)
        ],
    ]
}

fn any_vector(half: f64) -> impl Strategy<Value = Vec3> {
    (any_number(half), any_number(half), any_number(half)).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn any_box() -> impl Strategy<Value = Aabb> {
    // One in twenty has a negative extent.
    let half = (float(-1.0, 20.0), float(-1.0, 20.0), float(-1.0, 20.0)).prop_map(|(x, y, z)| Vec3::new(x, y, z));
    (any_vector(150.0), half).prop_map(|(centre, half)| Aabb::new(centre - half, centre + half))
}

fn any_sphere() -> impl Strategy<Value = Sphere> {
    (any_vector(150.0), any_number(20.0)).prop_map(|(centre, radius)| Sphere { centre, radius })
}

fn any_oriented() -> impl Strategy<Value = OrientedBox> {
    (any_vector(150.0), any_vector(10.0), any_vector(10.0), any_vector(10.0))
        .prop_map(|(centre, a, b, c)| OrientedBox { centre, half_axes: [a, b, c] })
}

/// Volumes of all kinds: whole and swept maps that share normals, and invalid planes.
fn any_volumes() -> impl Strategy<Value = Vec<CasterVolume>> {
    let scene = (any_camera(), any_direction());
    let any_volume = (scene, 0..6_u8, float(0.0, 1.0), any_vector(1.0), any_number(50.0)).prop_map(
        |((other, direction), sort, share, normal, d)| {
            let camera = if sort == 1 { other } else { camera() };
            let view = [camera.frustum().unwrap()];
            let kind = if sort == 2 { FitKind::Oriented } else { FitKind::FrustumAabb };
            let fit = fitted(&camera, direction, &exact(kind));
            let mut nonsense = CasterVolume::everywhere(camera.eye);
            (nonsense.planes[0], nonsense.planes[1], nonsense.count) = (normal.extend(d), Vec4::splat(d), 3);
            match sort {
                0 => CasterVolume::everywhere(camera.eye),
                3 => CasterVolume::nowhere(camera.eye),
                4 => nonsense,
                2 => fit.caster_volume(),
                _ => {
                    let far = view[0].near + (view[0].far - view[0].near) * share.max(0.01);
                    let fit = fitted(&camera, Vec3::new(0.3, -0.8, 0.4), &exact(kind).with_max_distance(far));
                    CasterVolume::swept(&fit, &Sweep { far, ..Sweep::new(&view) }).unwrap()
                }
            }
        },
    );
    prop::collection::vec(any_volume, 0..10)
}

/// Compares every bit, including the bits that must stay unchanged.
fn assert_same<S: Bounds>(
    volumes: &[CasterVolume],
    origin: DVec3,
    shapes: &[S],
    missing: usize,
    single: impl Fn(&CasterVolume, &S) -> bool,
) -> Result<(), TestCaseError> {
    const UNTOUCHED: u8 = 0b1010_0101;
    let mut masks = vec![UNTOUCHED; shapes.len() + 3];
    let tested = shapes.len().saturating_sub(missing);
    let room = if missing > 0 { tested } else { masks.len() };
    cull(volumes, origin, shapes, &mut masks[..room]);
    for (i, shape) in shapes[..tested].iter().enumerate() {
        let mut expected = 0;
        for (bit, volume) in volumes.iter().take(8).enumerate() {
            expected |= u8::from(single(&volume.relative_to(origin), shape)) << bit;
        }
        prop_assert_eq!(masks[i], expected, "shape {}", i);
    }
    prop_assert!(masks[tested..].iter().all(|mask| *mask == UNTOUCHED));
    Ok(())
}

proptest! {
    #[test]
    fn masks_of_boxes_are_those_of_the_single_test(
        volumes in any_volumes(), boxes in prop::collection::vec(any_box(), 0..300), missing in 0_usize..2,
        (x, y, z) in (float(-50.0, 50.0), float(-50.0, 50.0), float(-50.0, 50.0)),
    ) {
        let origin = camera().eye + Vec3::new(x, y, z).as_dvec3();
        assert_same(&volumes, origin, &boxes, missing, |volume, b| volume.intersects_aabb(b.min, b.max))?;
    }

    #[test]
    fn masks_of_spheres_are_those_of_the_single_test(
        volumes in any_volumes(), spheres in prop::collection::vec(any_sphere(), 0..300), missing in 0_usize..2,
    ) {
        assert_same(&volumes, camera().eye, &spheres, missing, |volume, s| volume.intersects_sphere(s.centre, s.radius))?;
    }

    #[test]
    fn masks_of_oriented_boxes_are_those_of_the_single_test(
        volumes in any_volumes(), boxes in prop::collection::vec(any_oriented(), 0..300), missing in 0_usize..2,
    ) {
        assert_same(&volumes, camera().eye, &boxes, missing, CasterVolume::intersects_obb)?;
    }
}

#[test]
fn eight_bits_are_enough_and_a_ninth_volume_is_left_out() {
    let volumes = [CasterVolume::everywhere(DVec3::ZERO); 9];
    let mut masks = [0; 2];
    cull(&volumes, DVec3::ZERO, &[Aabb::default(), Aabb::EMPTY], &mut masks);
    assert_eq!(masks, [0xff, 0]);
    cull(&[], DVec3::ZERO, &[Aabb::default(); 2], &mut masks);
    assert_eq!(masks, [0, 0]);
}

#[test]
fn many_boxes_of_which_all_or_few_are_kept_go_through_every_path() {
    let fit = fitted(&camera(), Vec3::new(0.3, -0.8, 0.4), &exact(FitKind::FrustumAabb));
    let view = [camera().frustum().unwrap()];
    let volumes = [fit.caster_volume(), CasterVolume::swept(&fit, &Sweep { far: 20.0, ..Sweep::new(&view) }).unwrap()];
    for (spread, least, most) in [(0.5, 1000, 1000), (40.0, 100, 900), (400.0, 0, 100)] {
        let at = |i: usize, step: f32| ((i as f32 * step) % 1.0 - 0.5) * 2.0 * spread;
        let middle = camera().forward.normalize() * 10.0;
        let centres = (0..1000).map(|i| middle + Vec3::new(at(i, 0.618_034), at(i, 0.414_214), at(i, 0.732_051)));
        let boxes: Vec<Aabb> = centres.map(|centre| Aabb::new(centre - 0.5, centre + 0.5)).collect();
        let mut masks = vec![0; boxes.len()];
        cull(&volumes, fit.origin, &boxes, &mut masks);
        for (mask, b) in masks.iter().zip(&boxes) {
            let single = volumes.map(|volume| u8::from(volume.intersects_aabb(b.min, b.max)));
            assert_eq!(*mask, single[0] | single[1] << 1);
        }
        let kept = masks.iter().filter(|mask| **mask != 0).count();
        assert!((least..=most).contains(&kept), "{kept} of 1000 within {spread} m");
    }
}

//! Feature `bytemuck`: bytes for GPUs, without uninitialised padding, equal on every target.

use bytemuck::{Pod, bytes_of, cast_slice, from_bytes, offset_of};
use shadowfit::NormalCone;
use shadowfit::culling::{CasterPlanes, OrientedBox, Sphere};
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{CasterPolicy, FitSettings};
use shadowfit::spot::SpotBias;
use shadowfit::{Aabb, Bias, CasterVolume};

use crate::support::{DIRECTION, camera, fitted};

fn survives<T: Pod + PartialEq + std::fmt::Debug>(value: &T) {
    assert_eq!(from_bytes::<T>(bytes_of(value)), value);
}

#[test]
fn shapes_are_their_numbers_in_order() {
    let aabb = Aabb::new(Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0));
    survives(&aabb);
    assert_eq!(cast_slice::<Aabb, f32>(&[aabb]), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let sphere = Sphere { centre: DIRECTION, radius: 2.0 };
    survives(&sphere);
    assert_eq!(cast_slice::<Sphere, f32>(&[sphere])[3], 2.0);
    let cone = NormalCone { axis: DIRECTION, cos_half_angle: 0.5 };
    survives(&cone);
    assert_eq!(cast_slice::<NormalCone, f32>(&[cone])[3], 0.5);
    let oriented = OrientedBox { centre: Vec3::ZERO, half_axes: [Vec3::X, Vec3::Y, DIRECTION] };
    survives(&oriented);
    assert_eq!(cast_slice::<OrientedBox, f32>(&[oriented])[9..], DIRECTION.to_array());
}

#[test]
fn a_bias_is_four_numbers_in_order() {
    let bias = Bias { constant_depth: 1.0, slope_depth: 2.0, normal_offset: 3.0, receiver_plane: 4.0 };
    survives(&bias);
    assert_eq!(cast_slice::<Bias, f32>(&[bias]), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn a_spot_light_s_bias_is_six_numbers_in_order() {
    let bias = SpotBias {
        constant_depth: 1.0,
        distance_depth: 2.0,
        slope_depth: 3.0,
        normal_offset: 4.0,
        constant_offset: 5.0,
        receiver_plane: 6.0,
    };
    survives(&bias);
    assert_eq!(cast_slice::<SpotBias, f32>(&[bias]), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn the_planes_of_a_volume_are_laid_out_as_wgsl_has_them() {
    let fit = fitted(&camera(), DIRECTION, &FitSettings::default());
    let volume = CasterVolume::of_map(&fit, CasterPolicy::DepthClamp);
    let planes = CasterPlanes::from(&volume);
    survives(&planes);
    let zeroed: CasterPlanes = bytemuck::Zeroable::zeroed();
    assert_eq!((size_of::<CasterPlanes>(), offset_of!(zeroed, CasterPlanes, count)), (272, 256));
    assert_eq!(planes.count, 5);
    for (plane, expected) in planes.planes.iter().zip(&volume.planes) {
        assert_eq!(plane, &expected.to_array());
    }
    assert_eq!(CasterPlanes::from(&CasterVolume::everywhere(DVec3::ZERO)).count, 0);
}

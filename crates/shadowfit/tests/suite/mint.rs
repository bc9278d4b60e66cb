//! Feature `mint`: inputs from other maths crates, and outputs for them.

use mint::{ColumnMatrix4, Point3, RowMatrix4, Vector3};
use shadowfit::culling::{OrientedBox, Sphere};
use shadowfit::glam::{DMat4, DVec3, Mat4, Vec3};
use shadowfit::mint::{dmat4, dvec3, frustum_from_eye_from_clip, mat4, matrix, point, vec3, vector, world_point};
use shadowfit::settings::FitSettings;
use shadowfit::{Aabb, DepthConvention, FitError, ViewFrustum};

use crate::support::{DIRECTION, camera, fitted};

#[test]
fn vectors_survive() {
    assert_eq!(vec3(vector(DIRECTION)), DIRECTION);
    assert_eq!(vec3([1.0, 2.0, 3.0]), Vec3::new(1.0, 2.0, 3.0));
    let p = point(DIRECTION);
    assert_eq!([p.x, p.y, p.z], DIRECTION.to_array());
    assert_eq!(dvec3(world_point(DVec3::new(0.1, 2.0, 3.0))), DVec3::new(0.1, 2.0, 3.0));
}

#[test]
fn matrices_keep_their_columns() {
    let columns = Mat4::from_cols_array(&core::array::from_fn(|i| i as f32));
    let m = matrix(&columns);
    assert_eq!([m.y.x, m.y.y, m.y.z, m.y.w], [4.0, 5.0, 6.0, 7.0]);
    assert_eq!(mat4(m), columns);
    assert_eq!(mat4(RowMatrix4::from(m)), columns);
    assert_eq!(dmat4(ColumnMatrix4::from([[0.1; 4]; 4])), DMat4::from_cols_array(&[0.1; 16]));
}

#[test]
fn shapes_survive() {
    let aabb = Aabb::new(Vec3::NEG_X, Vec3::splat(2.0));
    let corners: [Point3<f32>; 2] = aabb.into();
    assert_eq!(corners[1].y, 2.0);
    assert_eq!(Aabb::from(corners), aabb);
    assert_eq!(Sphere::from((point(DIRECTION), 2.0)), Sphere { centre: DIRECTION, radius: 2.0 });
    let axes = [Vec3::X, Vec3::Y, DIRECTION];
    let oriented = OrientedBox::from((point(DIRECTION), axes.map(vector)));
    assert_eq!(oriented, OrientedBox { centre: DIRECTION, half_axes: axes });
}

#[test]
fn a_frustum_comes_from_a_matrix_of_any_crate() -> Result<(), FitError> {
    let camera = camera();
    let depth = DepthConvention::Reversed;
    let relative = camera.clip_from_world(depth).as_dmat4().inverse();
    let world_from_clip = DMat4::from_translation(camera.eye) * relative;
    let foreign = ColumnMatrix4::from(world_from_clip.to_cols_array_2d());
    let eye = Point3::from(camera.eye.to_array());
    let expected = ViewFrustum::from_world_from_clip_f64(&world_from_clip, camera.eye, depth, 50.0)?;
    assert_eq!(ViewFrustum::from_world_from_clip_f64(&dmat4(foreign), dvec3(eye), depth, 50.0)?, expected);
    let relative = relative.as_mat4();
    let expected = ViewFrustum::from_eye_from_clip(&relative, camera.eye, depth, 50.0)?;
    let foreign = ColumnMatrix4::from(relative.to_cols_array_2d());
    assert_eq!(frustum_from_eye_from_clip(foreign, eye, depth, 50.0)?, expected);
    Ok(())
}

#[test]
fn a_fit_gives_its_matrices() {
    let fit = fitted(&camera(), vec3(Vector3::from([0.3, -0.8, 0.4])), &FitSettings::default());
    let world = fit.world_matrices();
    let [light_from_world, clip_from_light, clip_from_world] = <[ColumnMatrix4<f32>; 3]>::from(world);
    assert_eq!(mat4(light_from_world), world.light_from_world);
    assert_eq!(mat4(clip_from_light), world.clip_from_light);
    assert_eq!(mat4(clip_from_world), world.clip_from_world);
    assert_eq!(mat4(matrix(&fit.uv_from_world)), fit.uv_from_world);
}

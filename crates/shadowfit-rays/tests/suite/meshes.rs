//! Tests of meshes and images on the CPU: rejected input, the order of triangles, and memory.

use allocation_counter::measure;
use shadowfit_rays::glam::Vec3;
use shadowfit_rays::{AlphaImage, CutMaterial, CutOut, RayError, RayMesh};

use super::brute_force::Random;

#[test]
fn indices_that_are_not_those_of_triangles_are_refused_with_their_place() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let wanted = RayError::Index { place: 4, index: 3, vertices: 3 };
    assert_eq!(RayMesh::new(&positions, &[0, 1, 2, 0, 3, 1]).err(), Some(wanted));
    assert_eq!(RayMesh::new(&positions, &[0, 1, 2, 0]).err(), Some(RayError::Indices(4)));
    assert_eq!(RayMesh::new(&[], &[]).map(|mesh| (mesh.len(), mesh.bounds())), Ok((0, None)));
}

#[test]
fn a_cut_out_of_a_triangle_that_does_not_exist_is_refused_with_its_index() {
    let mesh = RayMesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[0, 1, 2]).expect("a mesh");
    let cut_out = CutOut { uvs: Default::default(), alphas: [1.0; 3], material: CutMaterial::default() };
    assert_eq!(mesh.with_cut_outs([(1, cut_out)]).err(), Some(RayError::CutOut { triangle: 1, triangles: 1 }));
}

#[test]
fn every_triangle_has_one_place_in_leaf_order() {
    let mesh = RayMesh::from_triangles(Random(14).triangles(1000, 9.0)).expect("a mesh");
    let mut order: Vec<_> = mesh.order().collect();
    assert!(!order.is_sorted());
    order.sort_unstable();
    assert!(order.into_iter().eq(0..1000));
}

#[test]
fn memory_is_estimated_within_a_factor_of_one_and_a_half() {
    for count in [1_000, 30_000] {
        let triangles = Random(15).triangles(count, 100.0);
        let mut mesh = None;
        let counted = measure(|| mesh = Some(RayMesh::from_triangles(triangles.iter().copied())));
        let estimate = RayMesh::memory(count);
        for (what, estimate, measured) in
            [("building", estimate.building, counted.bytes_max), ("kept", estimate.kept, counted.bytes_current as u64)]
        {
            let ratio = estimate as f64 / measured as f64;
            assert!((1.0 / 1.5..1.5).contains(&ratio), "{what} {count}: {estimate} estimated, {measured} measured");
        }
    }
}

#[test]
fn images_without_texels_or_with_too_few_are_refused() {
    assert_eq!(AlphaImage::new(0, 4, &[]).err(), Some(RayError::Image { width: 0, height: 4, bytes: 0 }));
    assert!(AlphaImage::new(2, 2, &[0; 3]).is_err() && AlphaImage::new(1, 2, &[0; 2]).is_ok());
}

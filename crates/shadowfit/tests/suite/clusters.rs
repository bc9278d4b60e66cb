//! Clusters contain their triangles, obey their limit, and their normal cones are never wrong.

use std::collections::HashMap;

use proptest::collection::vec;
use proptest::prelude::*;
use shadowfit::Clusters;
use shadowfit::NormalCone;
use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, FitError};

use crate::support::{any_direction, double, float};

type Triangle = [Vec3; 3];

fn point(reach: f64) -> impl Strategy<Value = Vec3> {
    (float(-reach, reach), float(-reach, reach), float(-reach, reach)).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// Triangles of all sizes, some of them flat in an axis or without area.
fn triangle() -> impl Strategy<Value = Triangle> {
    let size = prop_oneof![Just(0.0_f32), Just(1e-3), Just(1.0), Just(30.0)];
    let flat = prop_oneof![Just(Vec3::ONE), Just(Vec3::new(1.0, 0.0, 1.0)), Just(Vec3::ZERO.with_y(1.0))];
    (point(20.0), size, flat, [point(1.0), point(1.0), point(1.0)])
        .prop_map(|(middle, size, flat, corners)| corners.map(|corner| middle + corner * flat * size))
}

/// Up to six objects of up to 60 triangles each, some of them empty.
fn objects() -> impl Strategy<Value = Vec<Vec<Triangle>>> {
    vec(vec(triangle(), 0..60), 0..6)
}

fn slices(objects: &[Vec<Triangle>]) -> Vec<&[Triangle]> {
    objects.iter().map(Vec::as_slice).collect()
}

/// Returns a bowl of `n` by `n` quads, one metre each.
fn bowl(n: usize) -> Vec<Triangle> {
    let at = |x: usize, z: usize| Vec3::new(x as f32, (x * x + z * z) as f32 * 0.05, z as f32);
    let quad = |x, z| {
        let (a, b, c, d) = (at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z));
        [[a, b, c], [a, c, d]]
    };
    (0..n * n).flat_map(|i| quad(i % n, i / n)).collect()
}

/// Returns all numbers of the clusters, for comparing them bit by bit.
fn bits(clusters: &Clusters) -> Vec<u32> {
    let boxes = clusters.boxes().iter().flat_map(|b| [b.min.to_array(), b.max.to_array()]).flatten();
    let cones = clusters.cones().iter().flat_map(|c| c.axis.extend(c.cos_half_angle).to_array());
    boxes.chain(cones).map(f32::to_bits).collect()
}

/// Returns the total volume of all boxes, in cubic metres.
fn volume(clusters: &Clusters) -> f32 {
    clusters.boxes().iter().map(|b| (b.max - b.min).element_product()).sum()
}

/// Returns the clusters of each triangle.
fn owners(clusters: &Clusters) -> HashMap<(u32, u32), Vec<usize>> {
    let mut owners: HashMap<_, Vec<usize>> = HashMap::new();
    for cluster in 0..clusters.boxes().len() {
        for triangle in clusters.triangles(cluster) {
            owners.entry(triangle).or_default().push(cluster);
        }
    }
    owners
}

/// Returns whether points on the triangles, given by two numbers in 0..1, lie in boxes of their clusters.
fn holds_all(clusters: &Clusters, objects: &[Vec<Triangle>], places: &[(f64, f64)]) -> bool {
    let owners = owners(clusters);
    let keys =
        (0..).zip(objects).flat_map(|(o, triangles)| (0..).zip(triangles).map(move |(t, corners)| ((o, t), corners)));
    keys.into_iter().all(|(key, corners)| {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        // Boxes of parts of a triangle may have gaps of the rounding of f64.
        let error = 1e-12 * (a.length() + b.length() + c.length());
        places.iter().all(|&(u, v)| {
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = a + (b - a) * u + (c - a) * v;
            let is_in = |cluster: &usize| {
                let aabb = clusters.boxes()[*cluster];
                p.cmpge(aabb.min.as_dvec3() - error).all() && p.cmple(aabb.max.as_dvec3() + error).all()
            };
            owners.get(&key).is_some_and(|own| own.iter().any(is_in))
        })
    })
}

/// Points on a triangle: its corners and random ones.
fn places() -> impl Strategy<Value = Vec<(f64, f64)>> {
    vec((double(0.0, 1.0), double(0.0, 1.0)), 8)
        .prop_map(|others| [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].into_iter().chain(others).collect())
}

proptest! {
    #[test]
    fn every_point_of_every_triangle_lies_in_a_box_of_its_clusters(
        objects in objects(), limit in 1_usize..300, places in places(),
    ) {
        let clusters = Clusters::build(&slices(&objects), limit).unwrap();
        prop_assert!(holds_all(&clusters, &objects, &places));
    }

    #[test]
    fn parts_of_triangles_follow_however_their_corners_move(
        mut objects in objects(), limit in 1_usize..300, places in places(),
        moves in vec(point(40.0), 1..50),
    ) {
        let mut clusters = Clusters::build(&slices(&objects), limit).unwrap();
        let corners = objects.iter_mut().flatten().flatten();
        corners.zip(moves.iter().cycle()).for_each(|(corner, by)| *corner += *by);
        clusters.refit(&slices(&objects)).unwrap();
        prop_assert!(holds_all(&clusters, &objects, &places));
    }

    #[test]
    fn the_limit_holds_and_objects_are_not_mixed(objects in objects(), limit in 1_usize..300) {
        let clusters = Clusters::build(&slices(&objects), limit).unwrap();
        let filled = objects.iter().filter(|triangles| !triangles.is_empty()).count();
        prop_assert!(clusters.boxes().len() <= limit.max(filled));
        prop_assert_eq!(clusters.boxes().len(), clusters.cones().len());
        let mut last = 0;
        for (i, aabb) in clusters.boxes().iter().enumerate() {
            prop_assert!(!aabb.is_empty());
            let object = clusters.triangles(i).next().unwrap().0;
            prop_assert!(object >= last, "objects follow one another");
            prop_assert!(clusters.triangles(i).all(|(o, _)| o == object));
            last = object;
        }
        prop_assert_eq!(clusters.triangles(clusters.boxes().len()).len(), 0);
        prop_assert_eq!(clusters.triangles(usize::MAX).len(), 0);
    }

    #[test]
    fn the_same_triangles_give_the_same_bits(objects in objects(), limit in 1_usize..300) {
        let build = || Clusters::build(&slices(&objects), limit).unwrap();
        prop_assert_eq!(bits(&build()), bits(&build()));
    }

    #[test]
    fn refitted_to_the_same_places_nothing_changes(objects in objects(), limit in 1_usize..300) {
        let clusters = Clusters::build(&slices(&objects), limit).unwrap();
        let mut again = clusters.clone();
        again.refit(&slices(&objects)).unwrap();
        prop_assert_eq!(bits(&clusters), bits(&again));
    }

    #[test]
    fn what_faces_away_has_no_lit_side_that_the_eye_sees(
        triangles in vec(triangle(), 1..4),
        lift in float(-3.0, 30.0),
        (eye, to_light) in (point(60.0), any_direction()),
        picks in vec((double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)), 20),
    ) {
        let clusters = Clusters::build(&[&triangles], 1).unwrap();
        let (bounds, cone) = (clusters.boxes()[0], clusters.cones()[0]);
        let eye = eye + cone.axis * lift;
        if cone.faces_away(&bounds, eye, to_light) {
            for [a, b, c] in triangles.iter().map(|triangle| triangle.map(Vec3::as_dvec3)) {
                let n = (b - a).cross(c - a).normalize_or_zero();
                for (x, y, z) in &picks {
                    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
                    let p = min + (max - min) * DVec3::new(*x, *y, *z);
                    prop_assert!(n.dot(eye.as_dvec3() - p) * n.dot(to_light.as_dvec3()) <= 0.0);
                }
            }
        }
    }
}

#[test]
fn boxes_go_with_an_object_that_is_moved() {
    let there = bowl(12);
    let offset = Vec3::new(64.0, -32.0, 8.0);
    let here: Vec<Triangle> = there.iter().map(|corners| corners.map(|p| p + offset)).collect();
    let clusters = Clusters::build(&[&there], 40).unwrap();
    let mut moved = clusters.clone();
    moved.refit(&[&here]).unwrap();
    for (a, b) in clusters.boxes().iter().zip(moved.boxes()) {
        // Coordinates below 128 m are rounded by a step of 2⁻¹⁷ m, and rounded out by another.
        assert!((a.min + offset).abs_diff_eq(b.min, 2e-5) && (a.max + offset).abs_diff_eq(b.max, 2e-5), "{a:?} {b:?}");
    }
    // Without cuts, the boxes equal the boxes of a fresh build.
    let mut whole = Clusters::build(&[&there], 1).unwrap();
    whole.refit(&[&here]).unwrap();
    assert_eq!(bits(&whole), bits(&Clusters::build(&[&here], 1).unwrap()));
}

#[test]
fn a_large_slanted_triangle_gets_many_small_boxes() {
    let roof = [[Vec3::new(0.0, 0.0, 0.0), Vec3::new(30.0, 30.0, 30.0), Vec3::new(30.0, 0.0, 0.0)]];
    let clusters = Clusters::build(&[&roof], 100).unwrap();
    assert_eq!(clusters.boxes().len(), 100);
    assert!((0..100).all(|i| clusters.triangles(i).eq([(0, 0)])));
    assert!(volume(&clusters) < 0.1 * 30.0 * 30.0 * 30.0, "{} m³", volume(&clusters));
}

#[test]
fn a_full_flat_box_stays_whole() {
    let [a, b, c, d] = [(-9.0, -9.0), (-9.0, 9.0), (9.0, 9.0), (9.0, -9.0)].map(|(x, z)| Vec3::new(x, 0.25, z));
    let clusters = Clusters::build(&[&[[a, b, c], [a, c, d]]], 1024).unwrap();
    assert_eq!(clusters.boxes(), [Aabb::new(a, c)]);
}

#[test]
fn neighbours_in_the_list_are_neighbours_in_space() {
    let clusters = Clusters::build(&[&bowl(32)], 256).unwrap();
    let centres: Vec<Vec3> = clusters.boxes().iter().map(|b| (b.min + b.max) * 0.5).collect();
    let steps: f32 = centres.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let size = (centres[0].distance(centres[255])).max(32.0);
    assert!(steps / 255.0 < size / 8.0, "{} m from one to the next", steps / 255.0);
}

#[test]
fn triangles_that_pierce_one_another_everywhere_keep_to_the_room_for_corners() {
    let mut seed = 1_u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    let soup: Vec<Triangle> = (0..3000).map(|_| [(); 3].map(|()| Vec3::new(random(), random(), random()))).collect();
    let clusters = Clusters::build(&[&soup], 2048).unwrap();
    assert_eq!(clusters.boxes().len(), 2048);
    let pieces: usize = (0..clusters.boxes().len()).map(|i| clusters.triangles(i).len()).sum();
    assert!(pieces < 30_000, "{pieces} parts of 3000 triangles");
    assert!(holds_all(&clusters, &[soup], &[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.3, 0.3), (0.5, 0.5), (0.1, 0.7)]));
}

#[test]
fn each_object_has_a_box_even_beyond_the_limit() {
    let objects: Vec<Vec<Triangle>> = (0..5).map(|i| vec![[Vec3::splat(i as f32), Vec3::X, Vec3::Y]]).collect();
    assert_eq!(Clusters::build(&slices(&objects), 2).unwrap().boxes().len(), 5);
}

#[test]
fn more_clusters_hold_less_air() {
    let triangles = bowl(20);
    let mut before = f32::MAX;
    for limit in [1, 4, 16, 64, 256] {
        let air = volume(&Clusters::build(&[&triangles], limit).unwrap());
        assert!(air < before, "{limit} clusters: {air} after {before}");
        before = air;
    }
}

#[test]
fn triangles_in_one_place_and_no_triangles_are_no_trouble() {
    let same = vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 100];
    let points = vec![[Vec3::ONE; 3]; 100];
    let clusters = Clusters::build(&[&same, &points], usize::MAX).unwrap();
    assert_eq!(clusters.boxes().last(), Some(&Aabb::new(Vec3::ONE, Vec3::ONE)));
    assert_eq!(clusters.cones().last(), Some(&NormalCone::ALL));
    assert!((0..clusters.boxes().len()).all(|i| clusters.triangles(i).len() >= 1));
    for clusters in [Clusters::build(&[], 1), Clusters::build(&[&[], &[]], usize::MAX)] {
        assert!(clusters.unwrap().boxes().is_empty());
    }
}

#[test]
fn extreme_coordinates_are_kept() {
    for scale in [1e-45_f32, 1e-30, 1.0, 1e18] {
        let triangles: Vec<Triangle> = [Vec3::ZERO, Vec3::X, Vec3::NEG_Y, Vec3::ONE]
            .map(|p| [p * scale, (p * 0.5 + Vec3::Z * 0.25) * scale, p * 0.1 * scale])
            .to_vec();
        let clusters = Clusters::build(&[&triangles], 4).unwrap();
        for i in 0..clusters.boxes().len() {
            assert!(clusters.boxes()[i].min.is_finite() && clusters.boxes()[i].max.is_finite());
            assert!(clusters.cones()[i].axis.is_finite());
        }
    }
}

#[test]
fn ground_lit_from_below_faces_away_from_the_light() {
    let ground = [[Vec3::new(-9.0, 0.0, -9.0), Vec3::new(0.0, 0.0, 9.0), Vec3::new(9.0, 0.0, -9.0)]];
    let clusters = Clusters::build(&[&ground], 1).unwrap();
    let (bounds, cone) = (clusters.boxes()[0], clusters.cones()[0]);
    let (above, below) = (Vec3::new(3.0, 0.1, 3.0), Vec3::new(3.0, -0.1, 3.0));
    let (up, down) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(0.1, -0.2, 0.3));
    assert!(cone.faces_away(&bounds, above, down) && cone.faces_away(&bounds, below, up));
    assert!(!cone.faces_away(&bounds, above, up) && !cone.faces_away(&bounds, below, down));
    assert!(!cone.faces_away(&bounds, Vec3::ZERO, up), "an eye in the ground sees both sides");
    assert!(!NormalCone::ALL.faces_away(&bounds, above, down));
    for bad in [f32::NAN, f32::INFINITY] {
        let far = Vec3::splat(bad);
        assert!(!cone.faces_away(&bounds, far, down) && !cone.faces_away(&bounds, above, far));
        assert!(!NormalCone { axis: far, ..cone }.faces_away(&bounds, above, down));
        assert!(!NormalCone { cos_half_angle: -bad, ..cone }.faces_away(&bounds, above, down));
    }
    assert!(!cone.faces_away(&Aabb::EMPTY, above, down));
}

#[test]
fn bad_positions_limits_and_counts_are_refused() {
    let good = [[Vec3::ZERO, Vec3::X, Vec3::Y]];
    let mut clusters = Clusters::build(&[&good, &good], 8).unwrap();
    let before = clusters.clone();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2e18, f32::MIN] {
        for corner in 0..3 {
            let mut bad = good;
            bad[0][corner].y = value;
            let error = Clusters::build(&[&good, &bad], 8).unwrap_err();
            assert!(matches!(error, FitError::NotFinite { .. } | FitError::OutOfRange { .. }), "{value}: {error}");
            assert!(clusters.refit(&[&good, &bad]).is_err());
        }
    }
    assert!(matches!(Clusters::build(&[&good], 0), Err(FitError::OutOfRange { value: 0.0, .. })));
    let error = clusters.refit(&[&good]).unwrap_err();
    assert!(matches!(error, FitError::CountMismatch { given: 1, expected: 2, .. }));
    let error = clusters.refit(&[&good, &[]]).unwrap_err();
    assert!(matches!(error, FitError::CountMismatch { given: 0, expected: 1, .. }), "{error}");
    assert_eq!(clusters, before);
}

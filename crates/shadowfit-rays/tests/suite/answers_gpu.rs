//! Tests of rays on the GPU. Results equal brute force, except for rays within rounding of an edge.

use std::f32::consts::FRAC_PI_2;

use shadowfit_rays::glam::{Affine3A, DVec3, Vec3, Vec3Swizzles};
use shadowfit_rays::{RayInstance, RayMesh, RayScene, RayWgslOptions, Sides};

use super::brute_force::{Blocker, Random, assert_answers};
use super::device::gpu;

fn mesh(triangles: &[[Vec3; 3]]) -> RayMesh {
    RayMesh::from_triangles(triangles.iter().copied()).expect("a mesh")
}

/// Instances of two meshes, with the triangles of the meshes.
struct World {
    triangles: [Vec<[Vec3; 3]>; 2],
    instances: Vec<RayInstance>,
    /// Index of each instance's mesh.
    kinds: Vec<usize>,
}

impl World {
    fn new(scene: &mut RayScene, random: &mut Random, count: usize, half: f32) -> Self {
        let triangles = [random.triangles(40, 1.0), random.triangles(7, 1.0)];
        let meshes = triangles.each_ref().map(|triangles| scene.add_mesh(&mesh(triangles)).expect("room"));
        let kinds: Vec<_> = (0..count).map(|index| index % 2).collect();
        let sides = [Sides::Both, Sides::Front, Sides::Back];
        let instance = |(index, kind): (usize, &usize)| RayInstance {
            sides: sides[index / 2 % 3],
            ..RayInstance::new(meshes[*kind], random.transform(half))
        };
        let instances = kinds.iter().enumerate().map(instance).collect();
        Self { triangles, instances, kinds }
    }

    fn blockers(&self) -> Vec<Blocker> {
        let blockers = |(instance, kind): (&RayInstance, &usize)| {
            Blocker::all(&self.triangles[*kind], &instance.world_from_mesh, instance.sides)
        };
        self.instances.iter().zip(&self.kinds).flat_map(blockers).collect()
    }
}

#[test]
fn rays_through_one_mesh_are_blocked_where_brute_force_says_so() {
    let gpu = gpu();
    let mut random = Random(1);
    let triangles = random.triangles(300, 3.0);
    let mut scene = gpu.scene();
    let id = scene.add_mesh(&mesh(&triangles)).expect("room");
    scene.set_instances(DVec3::ZERO, &[RayInstance::new(id, Affine3A::IDENTITY)]).expect("room");
    let rays = random.rays(2000, 6.0);
    assert_answers(&Blocker::all(&triangles, &Affine3A::IDENTITY, Sides::Both), &rays, &gpu.blocked(&scene, &rays));
}

#[test]
fn turned_stretched_and_mirrored_instances_block_on_their_sides() {
    let gpu = gpu();
    let mut random = Random(2);
    let mut scene = gpu.scene();
    let world = World::new(&mut scene, &mut random, 60, 6.0);
    scene.set_instances(DVec3::ZERO, &world.instances).expect("room");
    let rays = random.rays(2000, 6.0);
    assert_answers(&world.blockers(), &rays, &gpu.blocked(&scene, &rays));
}

#[test]
fn instances_that_moved_a_little_or_far_block_where_they_are() {
    let gpu = gpu();
    let mut random = Random(3);
    let mut scene = gpu.scene();
    let mut world = World::new(&mut scene, &mut random, 600, 12.0);
    scene.set_instances(DVec3::ZERO, &world.instances).expect("room");
    let rays = random.rays(1000, 12.0);
    for instance in world.instances.iter_mut().step_by(150) {
        instance.world_from_mesh.translation += Vec3::new(0.3, -0.2, 0.1).to_vec3a();
    }
    scene.set_instances(DVec3::ZERO, &world.instances).expect("room");
    let fitted = scene.uploaded();
    assert_answers(&world.blockers(), &rays, &gpu.blocked(&scene, &rays));
    for instance in &mut world.instances {
        instance.world_from_mesh = random.transform(12.0);
    }
    scene.set_instances(DVec3::ZERO, &world.instances).expect("room");
    assert!(fitted > 0 && scene.uploaded() > fitted, "fitted: {fitted}, built again: {}", scene.uploaded());
    assert_answers(&world.blockers(), &rays, &gpu.blocked(&scene, &rays));
}

#[test]
fn a_scene_whose_origin_is_a_hundred_kilometres_away_has_the_same_answers() {
    let gpu = gpu();
    let mut random = Random(4);
    let mut scene = gpu.scene();
    let world = World::new(&mut scene, &mut random, 30, 4.0);
    let rays = random.rays(1000, 6.0);
    scene.set_instances(DVec3::ZERO, &world.instances).expect("room");
    let near = gpu.blocked(&scene, &rays);
    // The place of the origin has no effect, because all positions are relative to it.
    let origin = DVec3::new(100_000.0, 0.0, -70_000.0);
    scene.set_instances(origin, &world.instances).expect("room");
    assert_eq!((scene.origin(), scene.uploaded()), (origin, 0));
    assert_eq!(gpu.blocked(&scene, &rays), near);
}

#[test]
fn rays_aimed_at_the_middle_of_far_stretched_triangles_meet_them_and_no_box_hides_one() {
    let gpu = gpu();
    let mut random = Random(17);
    let mut scene = gpu.scene();
    let triangles = random.triangles(20, 1.0);
    let id = scene.add_mesh(&mesh(&triangles)).expect("room");
    let mut stretched = || {
        let scale = Vec3::from([0; 3].map(|_| 20.0_f32.powf(random.share() * 2.0 - 1.0)));
        let turned = random.transform(1000.0);
        RayInstance::new(id, turned * Affine3A::from_scale(scale))
    };
    let instances: Vec<_> = (0..200).map(|_| stretched()).collect();
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    let mut rays = Vec::new();
    for instance in &instances {
        for triangle in &triangles {
            let middle = instance.world_from_mesh.transform_point3(triangle.iter().sum::<Vec3>() / 3.0);
            let direction = random.direction();
            rays.push([middle - direction * 300.0 * random.share(), direction]);
        }
    }
    let missed = gpu.blocked(&scene, &rays).iter().filter(|answer| !**answer).count();
    // Tolerance for rounding at a kilometre, which moves rays past the edges of triangles seen edge-on.
    assert!(missed * 1000 <= rays.len(), "{missed} of {}", rays.len());
}

#[test]
fn rays_along_axes_meet_walls_without_thickness() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    // A square in the plane z = 0 with a flat box.
    let corner = |x, y| Vec3::new(x, y, 0.0);
    let square = [
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)],
        [corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
    ];
    let id = scene.add_mesh(&mesh(&square)).expect("room");
    let turns = [Affine3A::IDENTITY, Affine3A::from_rotation_x(FRAC_PI_2), Affine3A::from_rotation_y(FRAC_PI_2)];
    for (turn, axis) in turns.into_iter().zip([Vec3::Z, Vec3::Y, Vec3::X]) {
        scene.set_instances(DVec3::ZERO, &[RayInstance::new(id, turn)]).expect("room");
        // The point is not on a diagonal, where the two triangles share an edge.
        let beside = Vec3::new(0.1, 0.3, 0.5) * (Vec3::ONE - axis);
        let rays = [
            [beside - axis * 5.0, axis],
            [beside + axis * 5.0, -axis],
            [beside + axis * 5.0, axis],
            [beside * 20.0 - axis * 5.0, axis],
            // A ray from the middle of the plane along it.
            [beside, axis.zxy()],
        ];
        assert_eq!(gpu.blocked(&scene, &rays), [true, true, false, false, false], "{axis}");
    }
}

#[test]
fn nothing_blocks_in_a_scene_without_instances_that_can_be_met() {
    let gpu = gpu();
    let mut random = Random(5);
    let rays = random.rays(64, 1.0);
    let mut scene = gpu.scene();
    let assert_free = |scene: &RayScene| {
        assert!(!gpu.blocked(scene, &rays).contains(&true));
        assert_eq!(scene.bounds(), None);
    };
    assert_free(&scene);
    let empty = scene.add_mesh(&mesh(&[])).expect("room");
    let full = scene.add_mesh(&mesh(&random.triangles(9, 1.0))).expect("room");
    let at = |mesh, world_from_mesh| RayInstance::new(mesh, world_from_mesh);
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let far = Affine3A::from_translation(Vec3::NAN);
    scene.set_instances(DVec3::ZERO, &[]).expect("room");
    assert_free(&scene);
    let hidden = [at(empty, Affine3A::IDENTITY), at(full, flat), at(full, far)];
    scene.set_instances(DVec3::ZERO, &hidden).expect("room");
    assert_free(&scene);
    // Hidden instances do not affect others, whether they are hidden from the start or later.
    let seen = [hidden[0], at(full, Affine3A::IDENTITY), hidden[2]];
    scene.set_instances(DVec3::ZERO, &seen).expect("room");
    assert!(gpu.blocked(&scene, &rays).contains(&true) && scene.bounds().is_some());
    scene.set_instances(DVec3::ZERO, &hidden).expect("room");
    assert_free(&scene);
}

#[test]
fn triangles_without_area_or_not_finite_block_nothing_and_hide_no_other() {
    let gpu = gpu();
    let mut random = Random(6);
    let mut triangles = random.triangles(60, 3.0);
    let rays = random.rays(1000, 4.0);
    for (index, triangle) in triangles.iter_mut().enumerate() {
        match index % 4 {
            0 => triangle[1] = triangle[0],
            1 => triangle[2].y = [f32::NAN, f32::INFINITY][index / 4 % 2],
            _ => (),
        }
    }
    let mut scene = gpu.scene();
    let id = scene.add_mesh(&mesh(&triangles)).expect("room");
    scene.set_instances(DVec3::ZERO, &[RayInstance::new(id, Affine3A::IDENTITY)]).expect("room");
    triangles.retain(|triangle| triangle.iter().all(|corner| corner.is_finite()));
    assert_answers(&Blocker::all(&triangles, &Affine3A::IDENTITY, Sides::Both), &rays, &gpu.blocked(&scene, &rays));
}

#[test]
fn instances_and_triangles_that_all_coincide_are_not_too_deep() {
    let gpu = gpu();
    let triangle = [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
    let mut scene = gpu.scene();
    let id = scene.add_mesh(&mesh(&vec![triangle; 2000])).expect("room");
    scene.set_instances(DVec3::ZERO, &vec![RayInstance::new(id, Affine3A::IDENTITY); 2000]).expect("room");
    let rays = [[Vec3::new(0.0, -1.0, 0.0), Vec3::Y], [Vec3::new(0.0, 1.0, 0.0), Vec3::Y]];
    assert_eq!(gpu.blocked(&scene, &rays), [true, false]);
}

#[test]
fn the_engines_own_wgsl_decides_which_hits_count() {
    let gpu = gpu();
    let triangle = [Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0)];
    let above = triangle.map(|corner| corner + Vec3::Y);
    let mut scene = gpu.scene();
    let first = scene.add_mesh(&mesh(&[above])).expect("room");
    let second = scene.add_mesh(&mesh(&[above, triangle])).expect("room");
    let at = |mesh, x: f32| RayInstance {
        custom: x as u32 + 40,
        ..RayInstance::new(mesh, Affine3A::from_translation(Vec3::X * x))
    };
    scene.set_instances(DVec3::ZERO, &[at(first, 0.0), at(second, 10.0)]).expect("room");
    let slots = scene.slots(second).expect("in the scene");
    let below = |x: f32| [Vec3::new(x, -1.0, -0.5), Vec3::Y];
    let rays = [below(0.0), below(10.0), below(20.0)];
    let answers = |condition: &str| {
        let counts = format!("fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {{ return {condition}; }}");
        gpu.blocked_where(&scene, &rays, &RayWgslOptions::group(0).with_counts(&counts))
    };
    let in_slots = format!("hit.slot >= {}u && hit.slot < {}u", slots.start, slots.end);
    let cases = [
        ("hit.instance == 0u", [true, false, false]),
        ("hit.custom == 50u", [false, true, false]),
        ("hit.triangle == 1u", [false, true, false]),
        (in_slots.as_str(), [false, true, false]),
        ("abs(hit.distance - 2.0) < 1e-5", [true, true, false]),
        ("abs(hit.distance - 1.0) < 1e-5", [false, true, false]),
        // The weights of the point (0, -0.5): a quarter of the way in z from -1 to 1 gives a quarter for the
        // third corner.
        ("all(abs(hit.weights - vec2<f32>(0.375, 0.25)) < vec2<f32>(1e-5))", [true, true, false]),
        ("false", [false; 3]),
    ];
    for (condition, wanted) in cases {
        assert_eq!(answers(condition), wanted, "{condition}");
    }
}

//! Tests of scenes apart from ray results: reuse of freed room, frames without cost, and limits.

use allocation_counter::measure;
use shadowfit_rays::glam::{Affine3A, DVec3, Vec3};
use shadowfit_rays::{RayError, RayInstance, RayMesh, RayScene};

use super::brute_force::{Blocker, Random, assert_answers};
use super::device::{gpu, with_limits};

fn mesh(random: &mut Random, triangles: usize) -> RayMesh {
    RayMesh::from_triangles(random.triangles(triangles, 1.0)).expect("a mesh")
}

#[test]
fn a_removed_mesh_blocks_nothing_and_its_room_is_used_again() {
    let gpu = gpu();
    let mut random = Random(10);
    let mut scene = gpu.scene();
    let triangles = random.triangles(100, 1.0);
    let kept_mesh = RayMesh::from_triangles(triangles.iter().copied()).expect("a mesh");
    let gone_mesh = mesh(&mut random, 300);
    let gone = scene.add_mesh(&gone_mesh).expect("room");
    let kept = scene.add_mesh(&kept_mesh).expect("room");
    let instances = [gone, kept].map(|mesh| RayInstance::new(mesh, Affine3A::IDENTITY));
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    scene.remove_mesh(gone).expect("in the scene");
    let rays = random.rays(500, 1.0);
    let wanted = Blocker::all(&triangles, &Affine3A::IDENTITY, shadowfit_rays::Sides::Both);
    assert_answers(&wanted, &rays, &gpu.blocked(&scene, &rays));
    assert_eq!(scene.remove_mesh(gone), Err(RayError::NoMesh));
    assert_eq!(scene.set_instances(DVec3::ZERO, &instances), Err(RayError::NoMeshOfInstance(0)));
    let bytes = scene.bytes();
    for _ in 0..5 {
        let again = scene.add_mesh(&gone_mesh).expect("room");
        assert!(again != gone && scene.slots(again) == Some(0..300) && scene.triangles() == 400);
        assert_answers(&wanted, &rays, &gpu.blocked(&scene, &rays));
        scene.remove_mesh(again).expect("in the scene");
    }
    assert_eq!((scene.bytes(), scene.triangles(), scene.instances()), (bytes, 100, 2));
    scene.set_instances(DVec3::ZERO, &instances[1..]).expect("room");
    assert_answers(&wanted, &rays, &gpu.blocked(&scene, &rays));
}

#[test]
fn a_mesh_of_another_shape_has_it_in_all_of_its_instances() {
    let gpu = gpu();
    let mut random = Random(16);
    let mut scene = gpu.scene();
    let id = scene.add_mesh(&mesh(&mut random, 100)).expect("room");
    scene.add_mesh(&mesh(&mut random, 30)).expect("room");
    let instances = [Vec3::ZERO, Vec3::X * 3.0].map(|at| RayInstance::new(id, Affine3A::from_translation(at)));
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    let rays = random.rays(500, 2.0);
    // An equal number of triangles, then more, none, and some again.
    for (count, half) in [(100, 1.5), (150, 1.0), (0, 1.0), (90, 1.0)] {
        let triangles = random.triangles(count, half);
        let shape = RayMesh::from_triangles(triangles.iter().copied()).expect("a mesh");
        scene.update_mesh(id, &shape).expect("room");
        scene.set_instances(DVec3::ZERO, &instances).expect("room");
        assert_eq!((scene.uploaded(), scene.triangles()), (0, 30 + count as u64));
        let blockers = |instance: &RayInstance| Blocker::all(&triangles, &instance.world_from_mesh, instance.sides);
        let blockers: Vec<_> = instances.iter().flat_map(blockers).collect();
        let answers = gpu.blocked(&scene, &rays);
        if count > 0 {
            assert_answers(&blockers, &rays, &answers);
        } else {
            assert!(!answers.contains(&true));
        }
    }
    scene.remove_mesh(id).expect("in the scene");
    assert_eq!(scene.update_mesh(id, &RayMesh::default()), Err(RayError::NoMesh));
}

/// Returns instances on a square grid, a few metres apart.
fn grid(scene: &mut RayScene, random: &mut Random, side: u32) -> Vec<RayInstance> {
    let mesh = scene.add_mesh(&mesh(random, 12)).expect("room");
    let cell = |index: u32| Vec3::new((index % side) as f32, 0.0, (index / side) as f32) * 5.0;
    (0..side * side).map(|index| RayInstance::new(mesh, Affine3A::from_translation(cell(index)))).collect()
}

#[test]
fn frames_in_which_nothing_moved_upload_and_allocate_nothing_and_others_what_moved() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    let mut instances = grid(&mut scene, &mut Random(11), 40);
    // NaN is never equal to itself, but this transform is unchanged.
    instances[700].world_from_mesh.translation.x = f32::NAN;
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    let all = scene.uploaded();
    // Records of 64 bytes and nodes of 32 bytes: one for each instance, and at least one more per three instances.
    let nodes = (all - 1600 * 64) / 32;
    assert!((1600 + 533..=1600 * 8 / 3 + 4).contains(&nodes), "{nodes}");
    let mut still = Ok(());
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    let counted = measure(|| still = scene.set_instances(DVec3::ONE, &instances));
    assert_eq!((still, scene.uploaded(), counted.count_total), (Ok(()), 0, 0));
    instances[1000].world_from_mesh.translation.y += 0.5;
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    assert!(scene.uploaded() > 0 && scene.uploaded() < all / 2, "{} of {all}", scene.uploaded());
}

#[test]
fn bounds_hold_all_instances_and_little_more() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    let mesh = RayMesh::from_triangles([[Vec3::ZERO, Vec3::new(1.0, 2.0, 0.0), Vec3::new(0.0, 1.0, 3.0)]]);
    let mesh = scene.add_mesh(&mesh.expect("a mesh")).expect("room");
    let at = |x| RayInstance::new(mesh, Affine3A::from_translation(Vec3::X * x));
    scene.set_instances(DVec3::ZERO, &[at(10.0), at(-5.0)]).expect("room");
    let [least, most] = scene.bounds().expect("two instances");
    let (wanted_least, wanted_most) = (Vec3::new(-5.0, 0.0, 0.0), Vec3::new(11.0, 2.0, 3.0));
    assert!(least.cmple(wanted_least).all() && most.cmpge(wanted_most).all());
    // The tolerance is a few units in the last place of 11 m, for the rounding of rays.
    assert!(least.distance(wanted_least) < 1e-4 && most.distance(wanted_most) < 1e-4, "{least} {most}");
}

#[test]
fn what_is_larger_than_the_device_allows_is_refused_with_its_bytes_and_changes_nothing() {
    let limits = wgpu::Limits {
        max_storage_buffer_binding_size: 1 << 16,
        max_buffer_size: 1 << 16,
        ..wgpu::Limits::downlevel_defaults()
    };
    let needed = wgpu::Limits { max_storage_buffers_per_shader_stage: 8, ..limits };
    let gpu = with_limits(needed);
    let mut random = Random(12);
    let mut scene = gpu.scene();
    let bytes = scene.bytes();
    let refused = scene.add_mesh(&mesh(&mut random, 2000));
    // 1365 records of 48 bytes fit.
    let wanted = RayError::TooLarge { what: "triangles", bytes: 96_000, limit: 65_520 };
    assert!(matches!(refused, Err(RayError::TooLarge { what: "nodes", .. })) || refused == Err(wanted.clone()));
    assert!(wanted.to_string().contains("96000") && wanted.to_string().contains("65520"));
    let small = scene.add_mesh(&mesh(&mut random, 50)).expect("room for a few");
    assert_eq!(scene.slots(small), Some(0..50));
    let instances = vec![RayInstance::new(small, Affine3A::IDENTITY); 2000];
    // There are at least eight nodes of 32 bytes per three instances.
    let refused = scene.set_instances(DVec3::ZERO, &instances);
    let is_refused = |bytes: u64| (2000 * 8 / 3 * 32..2000 * 3 * 32).contains(&bytes);
    let refused_nodes = matches!(refused, Err(RayError::TooLarge { what: "nodes", bytes, .. }) if is_refused(bytes));
    assert!(refused_nodes, "{refused:?}");
    assert_eq!(scene.instances(), 0);
    scene.set_instances(DVec3::ZERO, &instances[..700]).expect("room for a third of them");
    assert!(scene.bytes() > bytes);
}

#[test]
fn devices_without_storage_buffers_are_refused_with_what_they_lack() {
    let gpu = with_limits(wgpu::Limits::downlevel_webgl2_defaults());
    let refused = RayScene::new(&gpu.device, &gpu.queue).expect_err("no storage buffers");
    let wanted = RayError::Unsupported { buffers: 0, threads: 0, needed_buffers: 5, needed_threads: 256 };
    assert_eq!(refused, wanted);
}

/// Run it by hand, optimised and with `--nocapture`. Tests must not assert on time.
#[test]
#[ignore = "measures the time of frames"]
fn the_time_of_frames_with_a_thousand_movers_of_ten_thousand() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    let mut instances = grid(&mut scene, &mut Random(13), 100);
    let start = std::time::Instant::now();
    scene.set_instances(DVec3::ZERO, &instances).expect("room");
    println!("first frame: {:?}", start.elapsed());
    let mut times = [Vec::new(), Vec::new()];
    for frame in 0..200 {
        for instance in instances.iter_mut().step_by(10) {
            instance.world_from_mesh.translation.y = (frame as f32 * 0.1).sin();
        }
        for times in &mut times {
            let start = std::time::Instant::now();
            scene.set_instances(DVec3::ZERO, &instances).expect("room");
            times.push(start.elapsed());
        }
        gpu.queue.submit([]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("a device that answers");
    }
    for (what, times) in ["moving", "still"].iter().zip(&mut times) {
        times.sort();
        println!("{what}: median {:?}, least {:?}, most {:?}", times[100], times[0], times[199]);
    }
}

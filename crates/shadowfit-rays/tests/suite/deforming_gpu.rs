//! Tests of meshes whose vertices move on the GPU, against meshes built in the same pose.

use shadowfit_rays::glam::{Affine3A, DVec3, Vec3, Vec3Swizzles};
use shadowfit_rays::{RayError, RayInstance, RayMesh, RayScene, Sides, VertexBuffer, VertexBufferLack};

use super::brute_force::{Blocker, Random, assert_answers};
use super::device::{Gpu, gpu};

/// Stride of an engine's vertices, which have other data before the position.
const STRIDE: u32 = 20;
/// An offset that is not a multiple of the binding alignment.
const OFFSET: u64 = 260 + 8;

/// A vertex buffer with positions.
fn vertices(gpu: &Gpu, positions: &[Vec3]) -> wgpu::Buffer {
    let mut bytes = vec![0xff; OFFSET as usize + positions.len() * STRIDE as usize];
    for (index, position) in positions.iter().enumerate() {
        let at = OFFSET as usize + index * STRIDE as usize;
        bytes[at..at + 12].copy_from_slice(bytemuck::bytes_of(&position.to_array()));
    }
    gpu.buffer(&bytes, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX)
}

fn refit(gpu: &Gpu, scene: &mut RayScene, instance: &RayInstance, buffer: &wgpu::Buffer) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    scene
        .refit(&mut encoder, instance.mesh, &VertexBuffer { buffer, offset: OFFSET, stride: STRIDE })
        .expect("a vertex buffer that fits");
    gpu.queue.submit([encoder.finish()]);
}

#[test]
fn a_deformed_mesh_blocks_as_one_that_was_built_in_its_pose() {
    let gpu = gpu();
    let mut random = Random(8);
    let positions: Vec<_> = (0..200).map(|_| random.in_cube(2.0)).collect();
    let indices: Vec<u32> = (0..900).map(|_| (random.share() * 200.0) as u32).collect();
    let mesh = RayMesh::new(&positions, &indices).expect("indices of vertices");
    let mut scene = gpu.scene();
    // Another mesh precedes it in all buffers.
    scene.add_mesh(&RayMesh::from_triangles(random.triangles(50, 1.0)).expect("a mesh")).expect("room");
    let bounds = [Vec3::splat(-6.0), Vec3::splat(6.0)];
    let id = scene.add_deforming_mesh(&mesh, bounds).expect("room");
    let transform = random.transform(1.0);
    let instance = RayInstance::new(id, transform);
    scene.set_instances(DVec3::ZERO, &[instance]).expect("room");
    let rays = random.rays(600, 5.0);
    for pose in 0..4 {
        // From pose 1 on every vertex moves. In pose 3 one vertex is NaN.
        let mut moved: Vec<_> = positions.iter().map(|at| *at + at.zxy() * 0.5 * pose as f32).collect();
        let nowhere = 17;
        if pose == 3 {
            moved[nowhere].z = f32::NAN;
        }
        refit(&gpu, &mut scene, &instance, &vertices(&gpu, &moved));
        if pose == 2 {
            // This replaces the buffers. The new ones must contain the results of the refit.
            scene.add_mesh(&RayMesh::from_triangles(random.triangles(900, 1.0)).expect("a mesh")).expect("room");
        }
        let triangles = indices.chunks_exact(3).filter(|triangle| pose < 3 || !triangle.contains(&(nowhere as u32)));
        let triangles: Vec<_> =
            triangles.map(|triangle| [0, 1, 2].map(|corner| moved[triangle[corner] as usize])).collect();
        let answers = gpu.blocked(&scene, &rays);
        assert_answers(&Blocker::all(&triangles, &transform, Sides::Both), &rays, &answers);
        // A mesh built in this pose gives the same result for every ray.
        let mut built = gpu.scene();
        let id = built.add_mesh(&RayMesh::from_triangles(triangles).expect("a mesh")).expect("room");
        built.set_instances(DVec3::ZERO, &[RayInstance::new(id, transform)]).expect("room");
        assert_eq!(gpu.blocked(&built, &rays), answers, "pose {pose}");
    }
}

#[test]
fn a_mesh_of_a_million_words_is_refitted_in_all_of_its_levels() {
    let gpu = gpu();
    let mut random = Random(9);
    let triangles = random.triangles(20_000, 50.0);
    let mesh = RayMesh::from_triangles(triangles.iter().copied()).expect("a mesh");
    let mut scene = gpu.scene();
    let bounds = [Vec3::splat(-200.0), Vec3::splat(200.0)];
    let instance = RayInstance::new(scene.add_deforming_mesh(&mesh, bounds).expect("room"), Affine3A::IDENTITY);
    scene.set_instances(DVec3::ZERO, &[instance]).expect("room");
    let moved: Vec<_> = triangles.iter().map(|triangle| triangle.map(|at| at.yzx() + Vec3::X * 90.0)).collect();
    refit(&gpu, &mut scene, &instance, &vertices(&gpu, &moved.concat()));
    let rays: Vec<_> = random.rays(100, 50.0).iter().map(|ray| [ray[0] + Vec3::X * 90.0, ray[1]]).collect();
    let mut built = gpu.scene();
    let id = built.add_mesh(&RayMesh::from_triangles(moved).expect("a mesh")).expect("room");
    built.set_instances(DVec3::ZERO, &[RayInstance::new(id, Affine3A::IDENTITY)]).expect("room");
    assert_eq!(gpu.blocked(&scene, &rays), gpu.blocked(&built, &rays));
}

#[test]
fn vertex_buffers_and_meshes_that_cannot_be_refitted_are_refused() {
    let gpu = gpu();
    let mut scene = gpu.scene();
    let mesh = RayMesh::new(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[0, 1, 2]).expect("a mesh");
    let rigid = scene.add_mesh(&mesh).expect("room");
    let soft = scene.add_deforming_mesh(&mesh, [Vec3::ZERO, Vec3::ONE]).expect("room");
    let storage = gpu.buffer(&[0; 64], wgpu::BufferUsages::STORAGE);
    let vertex = gpu.buffer(&[0; 64], wgpu::BufferUsages::VERTEX);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut refit =
        |mesh, buffer, offset, stride| scene.refit(&mut encoder, mesh, &VertexBuffer { buffer, offset, stride }).err();
    let lacks = |lack| Some(RayError::Vertices(lack));
    assert_eq!(refit(rigid, &storage, 0, 12), Some(RayError::NotDeforming));
    assert_eq!(refit(soft, &vertex, 0, 12), lacks(VertexBufferLack::Usage(vertex.usage())));
    for (offset, stride) in [(2, 12), (0, 14), (0, 8)] {
        assert_eq!(refit(soft, &storage, offset, stride), lacks(VertexBufferLack::Alignment { offset, stride }));
    }
    assert_eq!(refit(soft, &storage, 32, 12), lacks(VertexBufferLack::Size { size: 64, needed: 68 }));
    assert_eq!(refit(soft, &storage, 28, 12), None);
    for bounds in [[Vec3::NAN, Vec3::ONE], [Vec3::ONE, Vec3::ZERO]] {
        assert!(matches!(scene.add_deforming_mesh(&mesh, bounds), Err(RayError::Bounds { .. })), "{bounds:?}");
    }
}

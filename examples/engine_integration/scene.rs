//! The engine's scene: boxes, columns and balls, placed in f64, 50 km from the world's origin.

use core::f32::consts::{PI, TAU};
use core::ops::Range;

use ultraviolet::{DVec3, Vec3, Vec4};

use crate::gpu::Gpu;

/// Centre of the scene in world space, in metres.
pub(crate) const PLACE: DVec3 = DVec3 { x: 50_000.0, y: 0.0, z: -20_000.0 };

/// Number of segments around columns and balls.
const SEGMENTS: u32 = 48;

/// A mesh with coordinates from -1 to 1.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Mesh {
    Cube,
    Column,
    Ball,
}

/// An instance of a mesh.
pub(crate) struct Object {
    mesh: Mesh,
    /// World space, in metres.
    center: DVec3,
    /// Half of its size along each axis, in metres.
    half_size: Vec3,
    /// Linear colour. The fourth component is the contrast of its tile pattern.
    color: Vec4,
}

/// Returns a world-space position relative to a world-space origin, in metres.
pub(crate) fn relative(position: DVec3, origin: DVec3) -> Vec3 {
    let difference = position - origin;
    Vec3::new(difference.x as f32, difference.y as f32, difference.z as f32)
}

/// All objects and their buffers.
pub(crate) struct Scene {
    pub(crate) objects: Vec<Object>,
    /// Whether each object moves.
    pub(crate) moves: Vec<bool>,
    vertices: wgpu::Buffer,
    instances: wgpu::Buffer,
    /// Vertex range of each mesh.
    ranges: [Range<u32>; 3],
}

impl Scene {
    /// Layout of the two vertex buffers: vertices and instances.
    pub(crate) const LAYOUT: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
        Some(wgpu::VertexBufferLayout {
            array_stride: 24,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
        }),
        Some(wgpu::VertexBufferLayout {
            array_stride: 40,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![2 => Float32x3, 3 => Float32x3, 4 => Float32x4],
        }),
    ];

    pub(crate) fn new(gpu: &Gpu) -> Self {
        let (mut vertices, mut ranges) = (Vec::new(), [const { 0..0 }; 3]);
        for (range, mesh) in ranges.iter_mut().zip(meshes()) {
            *range = vertices.len() as u32..(vertices.len() + mesh.len()) as u32;
            vertices.extend(mesh);
        }
        let objects = objects();
        let moves = (1..=objects.len()).map(|number| number == objects.len()).collect();
        let instances = vec![0; objects.len() * size_of::<[f32; 10]>()];
        Self {
            vertices: gpu.buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            instances: gpu.buffer(&instances, wgpu::BufferUsages::VERTEX),
            objects,
            moves,
            ranges,
        }
    }

    /// Returns the triangles of each mesh as corner positions.
    pub(crate) fn triangles() -> [Vec<[[f32; 3]; 3]>; 3] {
        let corners = |triangle: &[Vertex; 3]| triangle.map(|[position, _]| position);
        meshes().map(|mesh| mesh.as_chunks().0.iter().map(corners).collect())
    }

    /// Rolls the ball, and uploads the positions of all objects relative to `origin`.
    pub(crate) fn update(&mut self, queue: &wgpu::Queue, origin: DVec3, frame: u32) {
        if let Some(ball) = self.objects.last_mut() {
            ball.center.x = PLACE.x - 0.6 + 0.1 * f64::from(frame);
        }
        let instance = |object: &Object| -> [f32; 10] {
            let [center, half, color] = [relative(object.center, origin), object.half_size, object.color.xyz()];
            let w = object.color.w;
            [center.x, center.y, center.z, half.x, half.y, half.z, color.x, color.y, color.z, w]
        };
        let instances: Vec<[f32; 10]> = self.objects.iter().map(instance).collect();
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
    }

    /// Returns the minimum and maximum corner of each object's box, relative to a world-space origin, in
    /// metres.
    pub(crate) fn bounds(&self, origin: DVec3) -> impl Iterator<Item = [Vec3; 2]> {
        self.placed(origin).map(|(_, center, half_size)| [center - half_size, center + half_size])
    }

    /// Returns mesh, centre and half size of each object, in metres. The centre is relative to a world-space
    /// origin. The subtraction is done in f64.
    pub(crate) fn placed(&self, origin: DVec3) -> impl Iterator<Item = (Mesh, Vec3, Vec3)> {
        self.objects.iter().map(move |object| (object.mesh, relative(object.center, origin), object.half_size))
    }

    /// Draws the objects with these numbers and returns their count.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, numbers: impl IntoIterator<Item = u32>) -> usize {
        let mut count = 0;
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        for number in numbers {
            let mesh = self.objects[number as usize].mesh;
            pass.draw(self.ranges[mesh as usize].clone(), number..number + 1);
            count += 1;
        }
        count
    }
}

/// Returns a square with a colonnade, trees around it, a tower outside the picture that casts a shadow into
/// it, and the rolling ball.
fn objects() -> Vec<Object> {
    let (stone, red, wood) = ([0.62, 0.56, 0.46], [0.62, 0.09, 0.06], [0.30, 0.17, 0.08]);
    let mut objects = Vec::new();
    let mut add = |mesh, center: [f64; 3], size: [f32; 3], color: [f32; 3], tiles| {
        let (center, half_size) = (PLACE + DVec3::from(center), Vec3::from(size) * 0.5);
        let color = Vec4::new(color[0], color[1], color[2], tiles);
        objects.push(Object { mesh, center, half_size, color });
    };
    add(Mesh::Cube, [0.0, -0.5, -60.0], [260.0, 1.0, 260.0], [0.40, 0.37, 0.30], 0.16);
    add(Mesh::Cube, [0.0, 0.15, -11.0], [10.4, 0.3, 30.4], stone, 0.05);
    for row in 0..7 {
        for x in [-3.6, 3.6] {
            let z = 1.0 - 4.0 * f64::from(row);
            add(Mesh::Cube, [x, 0.5, z], [1.3, 0.4, 1.3], stone, 0.0);
            add(Mesh::Column, [x, 2.9, z], [0.9, 4.6, 0.9], stone, 0.0);
            add(Mesh::Cube, [x, 5.3, z], [1.2, 0.3, 1.2], stone, 0.0);
        }
    }
    for x in [-3.6, 3.6] {
        add(Mesh::Cube, [x, 5.8, -11.0], [1.0, 0.7, 26.0], [0.58, 0.50, 0.40], 0.0);
    }
    for row in 0..13 {
        add(Mesh::Cube, [0.0, 6.3, 1.0 - 2.0 * f64::from(row)], [9.6, 0.3, 0.35], wood, 0.0);
    }
    for (x, z, side) in [(7.4, 0.5, 1.4), (8.6, -0.6, 1.0), (7.5, 0.4, 0.8)] {
        let y = if side == 0.8 { 1.8 } else { side / 2.0 };
        add(Mesh::Cube, [x, y, z], [side as f32; 3], [0.10, 0.20, 0.33], 0.0);
    }
    for tree in 0..26 {
        let angle = f64::from(tree) * 2.4;
        let (x, z) = (angle.cos() * (16.0 + 1.6 * f64::from(tree)), -26.0 + angle.sin() * (17.0 + f64::from(tree)));
        // No tree between the camera and the colonnade.
        if z > 0.0 && x > -14.0 && x < 20.0 {
            continue;
        }
        add(Mesh::Column, [x, 1.2, z], [0.35, 2.4, 0.35], wood, 0.0);
        add(Mesh::Ball, [x, 3.6, z], [2.6, 3.6, 2.6], [0.10, 0.20, 0.06], 0.0);
    }
    add(Mesh::Cube, [-22.0, 8.0, 9.0], [4.0, 16.0, 4.0], stone, 0.0);
    add(Mesh::Ball, [-1.6, 0.9, 5.6], [1.8; 3], red, 0.0);
    objects
}

/// Returns all meshes, in the order of [`Mesh`].
fn meshes() -> [Vec<Vertex>; 3] {
    [cube(), column(), ball()]
}

/// Position and normal.
type Vertex = [[f32; 3]; 2];

/// Returns the two triangles of a quadrilateral, counter-clockwise seen from outside.
fn quad(corners: [Vertex; 4]) -> [Vertex; 6] {
    [0, 1, 2, 0, 2, 3].map(|corner| corners[corner])
}

fn cube() -> Vec<Vertex> {
    let axes = [Vec3::unit_x(), Vec3::unit_y(), Vec3::unit_z()];
    let normals = axes.into_iter().flat_map(|axis| [axis, -axis]);
    let face = |normal: Vec3| {
        let right = Vec3::new(normal.y, normal.z, normal.x);
        let up = normal.cross(right);
        let corner = |u: f32, v: f32| [(normal + right * u + up * v).into(), normal.into()];
        quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
    };
    normals.flat_map(face).collect()
}

fn column() -> Vec<Vertex> {
    around(|angle| {
        let normal = [angle.sin(), 0.0, angle.cos()];
        let corner = |y: f32| [[normal[0], y, normal[2]], normal];
        vec![corner(-1.0), corner(1.0)]
    })
}

fn ball() -> Vec<Vertex> {
    around(|angle| {
        let corner = |step: u32| {
            let (radius, y) = (PI * (1.0 - step as f32 / (SEGMENTS / 2) as f32)).sin_cos();
            let normal = [angle.sin() * radius, y, angle.cos() * radius];
            [normal, normal]
        };
        (0..=SEGMENTS / 2).map(corner).collect()
    })
}

/// Returns a surface of revolution around the vertical axis. `line` returns its profile at an angle, from
/// bottom to top.
fn around(line: impl Fn(f32) -> Vec<Vertex>) -> Vec<Vertex> {
    let angle = |segment: u32| TAU * segment as f32 / SEGMENTS as f32;
    let strip = |segment: u32| {
        let (left, right) = (line(angle(segment)), line(angle(segment + 1)));
        let quads = left.windows(2).zip(right.windows(2)).map(|(l, r)| quad([l[0], r[0], r[1], l[1]]));
        quads.flatten().collect::<Vec<_>>()
    };
    (0..SEGMENTS).flat_map(strip).collect()
}

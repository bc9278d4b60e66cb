//! Closed triangle meshes with shared vertices, and their conversion to drawable primitives.
//!
//! Generators only place vertices. This module computes the normals from the faces, split where two faces
//! meet at more than a crease angle, so shading and winding cannot disagree.

use std::f32::consts::TAU;

use glam::{Affine3A, Quat, Vec2, Vec3};

use crate::Primitive;

/// A closed surface. Every edge belongs to two triangles, which are counter-clockwise from outside.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Vertices, shared between adjacent faces.
    pub positions: Vec<Vec3>,
    /// Vertex indices.
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// Applies a transform. A mirroring transform also reverses the winding.
    #[must_use]
    pub fn transformed(mut self, transform: Affine3A) -> Self {
        for position in &mut self.positions {
            *position = transform.transform_point3(*position);
        }
        if transform.matrix3.determinant() < 0.0 {
            for triangle in &mut self.triangles {
                triangle.swap(1, 2);
            }
        }
        self
    }

    /// Moves the solid by `offset`.
    #[must_use]
    pub fn moved(self, offset: impl Into<Vec3>) -> Self {
        self.transformed(Affine3A::from_translation(offset.into()))
    }

    /// Rotates the solid about the origin, then moves it by `offset`.
    #[must_use]
    pub fn posed(self, turn: Quat, offset: impl Into<Vec3>) -> Self {
        self.transformed(Affine3A::from_rotation_translation(turn, offset.into()))
    }

    /// Returns `count` copies together, turned evenly about the y axis.
    #[must_use]
    pub fn around(&self, count: usize) -> Self {
        let turn = |index: usize| Affine3A::from_rotation_y(index as f32 / count as f32 * TAU);
        (0..count).map(|index| self.clone().transformed(turn(index))).collect()
    }

    /// Mirrors the solid in the plane x = 0.
    #[must_use]
    pub fn mirrored(self) -> Self {
        self.transformed(Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0)))
    }

    /// Adds another solid. The two may overlap and keep their own surfaces.
    #[must_use]
    pub fn with(mut self, other: Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|index| index + first)));
        self
    }

    /// Adds the solid's mirror image in x = 0.
    #[must_use]
    pub fn and_mirrored(self) -> Self {
        let mirror = self.clone().mirrored();
        self.with(mirror)
    }

    /// Converts to a primitive. Faces that meet at less than `crease` radians (below π/2) share a smooth
    /// normal. Texture coordinates are in metres, projected along the normal's greatest axis.
    pub fn primitive(&self, material: usize, crease: f32) -> Primitive {
        self.primitive_with(material, crease, |vertex, normal| projected(self.positions[vertex], normal))
    }

    /// Converts like [`Self::primitive`], with texture coordinates computed from the vertex's index and its
    /// normal.
    pub fn primitive_with(&self, material: usize, crease: f32, uv: impl Fn(usize, Vec3) -> Vec2) -> Primitive {
        let corners = Corners::new(self);
        let threshold = crease.cos();
        let mut primitive = Primitive { material, ..Primitive::default() };
        primitive.indices = vec![0; self.triangles.len() * 3];
        for vertex in 0..self.positions.len() {
            let mut groups: Vec<(u64, u32)> = Vec::with_capacity(2);
            for &corner in corners.around(vertex) {
                let mask = corners.smooth_mask(vertex, corner as usize / 3, threshold);
                let known = groups.iter().find(|group| group.0 == mask).map(|group| group.1);
                let index = known.unwrap_or_else(|| {
                    let normal = corners.normal(vertex, mask);
                    primitive.positions.push(self.positions[vertex]);
                    primitive.normals.push(normal);
                    primitive.uvs.push(uv(vertex, normal));
                    primitive.positions.len() as u32 - 1
                });
                if known.is_none() {
                    groups.push((mask, index));
                }
                primitive.indices[corner as usize] = index;
            }
        }
        primitive
    }
}

/// Combines all solids, like [`Solid::with`].
impl FromIterator<Solid> for Solid {
    fn from_iter<I: IntoIterator<Item = Self>>(solids: I) -> Self {
        solids.into_iter().reduce(Self::with).unwrap_or_default()
    }
}

/// Returns the texture coordinates of a position, in metres, projected along the normal's greatest axis.
fn projected(position: Vec3, normal: Vec3) -> Vec2 {
    let size = normal.abs();
    if size.y >= size.x && size.y >= size.z {
        Vec2::new(position.x, position.z)
    } else if size.x >= size.z {
        Vec2::new(position.z, -position.y)
    } else {
        Vec2::new(position.x, -position.y)
    }
}

/// The triangle corners at each vertex, and the area vectors of the faces.
struct Corners {
    /// For each face, twice its area along its outward normal.
    areas: Vec<Vec3>,
    /// Unit face normals.
    normals: Vec<Vec3>,
    /// Corner numbers (3 · face + corner), grouped by vertex.
    by_vertex: Vec<u32>,
    /// Start of each vertex's group in `by_vertex`, and the end of the last.
    starts: Vec<usize>,
}

impl Corners {
    /// Sorts the corners of a solid by vertex.
    fn new(solid: &Solid) -> Self {
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|index| solid.positions[index as usize]);
            (b - a).cross(c - a)
        };
        let areas: Vec<Vec3> = solid.triangles.iter().map(area).collect();
        let normals = areas.iter().map(|area| area.normalize_or_zero()).collect();
        let mut starts = vec![0; solid.positions.len() + 1];
        for &index in solid.triangles.iter().flatten() {
            starts[index as usize + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut next = starts.clone();
        let mut corners = vec![0; solid.triangles.len() * 3];
        for (corner, &index) in solid.triangles.iter().flatten().enumerate() {
            corners[next[index as usize]] = corner as u32;
            next[index as usize] += 1;
        }
        Self { areas, normals, by_vertex: corners, starts }
    }

    /// Returns the corners at a vertex.
    fn around(&self, vertex: usize) -> &[u32] {
        &self.by_vertex[self.starts[vertex]..self.starts[vertex + 1]]
    }

    /// Returns a bit mask of the faces around a vertex that are smooth with `face`. Poles with more faces
    /// than bits are smooth all around.
    fn smooth_mask(&self, vertex: usize, face: usize, threshold: f32) -> u64 {
        let around = self.around(vertex);
        if around.len() > 64 {
            return u64::MAX;
        }
        around.iter().enumerate().fold(0, |mask, (bit, &corner)| {
            let smooth = self.normals[corner as usize / 3].dot(self.normals[face]) >= threshold;
            mask | (u64::from(smooth) << bit)
        })
    }

    /// Returns the area-weighted mean normal of the masked faces around a vertex.
    fn normal(&self, vertex: usize, mask: u64) -> Vec3 {
        let around = self.around(vertex);
        let chosen = |bit: usize| around.len() > 64 || mask >> bit & 1 == 1;
        let sum: Vec3 =
            (0..around.len()).filter(|&bit| chosen(bit)).map(|bit| self.areas[around[bit] as usize / 3]).sum();
        sum.normalize_or(Vec3::Y)
    }
}

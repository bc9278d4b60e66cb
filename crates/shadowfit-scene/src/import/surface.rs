//! Repairs and completes the surface of a geometry: triangles without area, normals, tangents.
//!
//! Areas and face normals are computed in f64, where products of f32 coordinates neither overflow nor
//! underflow.

use glam::{DVec3, Vec2, Vec3, Vec4};

use crate::Geometry;

/// Drops triangles without area and returns their number. Only valid for rigid geometry: morphs and joints
/// may open a triangle that is closed at rest.
pub(crate) fn drop_zero_area(geometry: &mut Geometry) -> usize {
    let before = geometry.indices.len() / 3;
    let positions = &geometry.positions;
    let mut kept = Vec::with_capacity(geometry.indices.len());
    for corners in geometry.indices.chunks_exact(3) {
        if face(positions, corners) != DVec3::ZERO {
            kept.extend_from_slice(corners);
        }
    }
    geometry.indices = kept;
    before - geometry.indices.len() / 3
}

/// Gives every triangle its own vertices with its face's normal. Gives every morph target the change of that
/// normal, which is exact at weights 0 and 1.
pub(crate) fn flatten(geometry: &mut Geometry) {
    unweld(geometry);
    geometry.normals = face_normals(&geometry.positions);
    geometry.tangents.clear();
    for target in &mut geometry.morphs {
        let moved = geometry.positions.iter().zip(&target.positions);
        let moved: Vec<Vec3> = moved.map(|(&position, &offset)| position + offset).collect();
        let normals = face_normals(&moved).into_iter();
        target.normals = normals.zip(&geometry.normals).map(|(to, &from)| to - from).collect();
    }
}

/// Normalises the normals and returns the number of unusable ones, which it computes from the surrounding
/// faces.
pub(crate) fn repair_normals(geometry: &mut Geometry) -> usize {
    let usable = |normal: &Vec3| normal.is_finite() && normal.length_squared() > f32::MIN_POSITIVE;
    let broken = geometry.normals.iter().filter(|&normal| !usable(normal)).count();
    if broken > 0 {
        let faces = smooth_normals(geometry);
        for (normal, face) in geometry.normals.iter_mut().zip(faces) {
            if !usable(normal) {
                *normal = face;
            }
        }
    }
    for normal in &mut geometry.normals {
        // Scaled first, so that the length of huge normals stays finite.
        *normal = (*normal / normal.abs().max_element()).normalize_or(Vec3::Y);
    }
    broken
}

/// Computes tangents for texture coordinates `uvs`, weighted by area.
///
/// After Eric Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001. As glTF requires,
/// w is instead the sign for a bitangent that points up in the image, against v.
pub(crate) fn compute_tangents(geometry: &mut Geometry, uvs: &[Vec2]) {
    let count = geometry.positions.len();
    let (mut tangents, mut bitangents) = (vec![DVec3::ZERO; count], vec![DVec3::ZERO; count]);
    for corners in geometry.indices.chunks_exact(3) {
        let [a, b, c] = [corners[0] as usize, corners[1] as usize, corners[2] as usize];
        let position = |i: usize| geometry.positions[i].as_dvec3();
        let (e1, e2) = (position(b) - position(a), position(c) - position(a));
        let (d1, d2) = ((uvs[b] - uvs[a]).as_dvec2(), (uvs[c] - uvs[a]).as_dvec2());
        // Not divided by the determinant: its magnitude is twice the area in texture space, and the edges
        // already contain the area in space.
        let sign = d1.perp_dot(d2).signum();
        let tangent = (e1 * d2.y - e2 * d1.y) * sign;
        let bitangent = (e2 * d1.x - e1 * d2.x) * sign;
        for i in [a, b, c] {
            tangents[i] += tangent;
            bitangents[i] += bitangent;
        }
    }
    let sums = geometry.normals.iter().zip(tangents.into_iter().zip(bitangents));
    geometry.tangents = sums.map(|(&normal, (t, b))| orthogonal(normal, t, b)).collect();
}

fn orthogonal(normal: Vec3, tangent: DVec3, bitangent: DVec3) -> Vec4 {
    let n = normal.as_dvec3();
    let tangent = (tangent - n * n.dot(tangent)).normalize_or(n.any_orthonormal_vector());
    let up = if n.cross(tangent).dot(-bitangent) < 0.0 { -1.0 } else { 1.0 };
    tangent.as_vec3().extend(up)
}

/// Returns the normal of a face. Its length is twice the area.
fn face(positions: &[Vec3], corners: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| positions[corners[i] as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// Returns unit normals of unwelded faces, each three times.
fn face_normals(positions: &[Vec3]) -> Vec<Vec3> {
    let mut normals = Vec::with_capacity(positions.len());
    for corners in positions.chunks_exact(3) {
        let normal = face(corners, &[0, 1, 2]).normalize_or(DVec3::Y).as_vec3();
        normals.extend([normal; 3]);
    }
    normals
}

/// Returns the area-weighted normals of the faces around each vertex.
fn smooth_normals(geometry: &Geometry) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; geometry.positions.len()];
    for corners in geometry.indices.chunks_exact(3) {
        let normal = face(&geometry.positions, corners);
        for &corner in corners {
            sums[corner as usize] += normal;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect()
}

/// Copies shared vertices, so that every index is used once and in order.
fn unweld(geometry: &mut Geometry) {
    let indices = std::mem::take(&mut geometry.indices);
    spread(&mut geometry.positions, &indices);
    spread(&mut geometry.uvs, &indices);
    spread(&mut geometry.colors, &indices);
    spread(&mut geometry.joints, &indices);
    spread(&mut geometry.weights, &indices);
    for target in &mut geometry.morphs {
        spread(&mut target.positions, &indices);
    }
    geometry.indices = (0..indices.len() as u32).collect();
}

fn spread<T: Copy>(values: &mut Vec<T>, indices: &[u32]) {
    if !values.is_empty() {
        *values = indices.iter().map(|&index| values[index as usize]).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a quad in the xy plane that faces +z, with the image upright on it.
    fn quad() -> Geometry {
        Geometry {
            positions: [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| Vec3::new(x as f32, y as f32, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 4],
            uvs: [[0, 1], [1, 1], [1, 0], [0, 0]].map(|[u, v]| Vec2::new(u as f32, v as f32)).to_vec(),
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Geometry::default()
        }
    }

    #[test]
    fn tangents_of_an_upright_image_point_along_u_with_a_positive_sign() {
        let mut geometry = quad();
        let uvs = geometry.uvs.clone();
        compute_tangents(&mut geometry, &uvs);
        assert_eq!(geometry.tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
        let mirrored: Vec<_> = uvs.iter().map(|uv| Vec2::new(1.0 - uv.x, uv.y)).collect();
        compute_tangents(&mut geometry, &mirrored);
        assert_eq!(geometry.tangents, [Vec4::new(-1.0, 0.0, 0.0, -1.0); 4]);
    }

    #[test]
    fn tangents_without_usable_texture_coordinates_are_still_unit_and_orthogonal() {
        let mut geometry = quad();
        compute_tangents(&mut geometry, &[Vec2::ZERO; 4]);
        for tangent in &geometry.tangents {
            let t = tangent.truncate();
            assert!((t.length() - 1.0).abs() < 1e-6 && t.dot(Vec3::Z).abs() < 1e-6);
        }
    }

    #[test]
    fn unusable_normals_are_computed_from_the_faces_around() {
        let mut geometry = quad();
        geometry.normals = vec![Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::MAX), Vec3::X * 4.0];
        assert_eq!(repair_normals(&mut geometry), 2);
        assert_eq!(geometry.normals[..2], [Vec3::Z, Vec3::Z]);
        assert!(geometry.normals[2].is_normalized());
        assert_eq!(geometry.normals[3], Vec3::X);
    }

    #[test]
    fn tiny_triangles_keep_their_normals_and_only_those_without_area_are_dropped() {
        let mut geometry = quad();
        for position in &mut geometry.positions {
            *position *= 1e-30;
        }
        geometry.indices.extend([0, 0, 1]);
        assert_eq!(drop_zero_area(&mut geometry), 1);
        flatten(&mut geometry);
        assert_eq!(geometry.normals, [Vec3::Z; 6]);
    }
}

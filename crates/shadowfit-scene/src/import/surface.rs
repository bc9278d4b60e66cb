//! Repairs and completes the surface of a primitive: triangles without area, normals, tangents.
//!
//! Areas and face normals are computed in f64: products of f32 coordinates neither overflow nor
//! vanish there.

use glam::{DVec3, Vec2, Vec3, Vec4};

use crate::Primitive;

/// Drops triangles without area and says how many. Only for rigid primitives: morphs and joints may
/// open what is closed at rest.
pub(crate) fn drop_zero_area(primitive: &mut Primitive) -> usize {
    let before = primitive.indices.len() / 3;
    let positions = &primitive.positions;
    let mut kept = Vec::with_capacity(primitive.indices.len());
    for corners in primitive.indices.chunks_exact(3) {
        if face(positions, corners) != DVec3::ZERO {
            kept.extend_from_slice(corners);
        }
    }
    primitive.indices = kept;
    before - primitive.indices.len() / 3
}

/// Gives every triangle vertices of its own and its face's normal, and every morph target the change
/// of that normal, exact at weights 0 and 1.
pub(crate) fn flatten(primitive: &mut Primitive) {
    unweld(primitive);
    primitive.normals = face_normals(&primitive.positions);
    primitive.tangents.clear();
    for target in &mut primitive.morphs {
        let moved = primitive.positions.iter().zip(&target.positions);
        let moved: Vec<Vec3> = moved.map(|(&position, &offset)| position + offset).collect();
        let normals = face_normals(&moved).into_iter();
        target.normals = normals.zip(&primitive.normals).map(|(to, &from)| to - from).collect();
    }
}

/// Normalises the normals, computes unusable ones from the faces around, and says how many.
pub(crate) fn repair_normals(primitive: &mut Primitive) -> usize {
    let usable = |normal: &Vec3| normal.is_finite() && normal.length_squared() > f32::MIN_POSITIVE;
    let broken = primitive.normals.iter().filter(|&normal| !usable(normal)).count();
    if broken > 0 {
        let faces = smooth_normals(primitive);
        for (normal, face) in primitive.normals.iter_mut().zip(faces) {
            if !usable(normal) {
                *normal = face;
            }
        }
    }
    for normal in &mut primitive.normals {
        // Scaled first, so that the length of huge normals stays finite.
        *normal = (*normal / normal.abs().max_element()).normalize_or(Vec3::Y);
    }
    broken
}

/// Computes tangents for texture coordinates `uvs`, weighted by area.
///
/// After Eric Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001; but w is
/// the sign for a bitangent that points up in the image, against v, as glTF has it.
pub(crate) fn compute_tangents(primitive: &mut Primitive, uvs: &[Vec2]) {
    let count = primitive.positions.len();
    let (mut tangents, mut bitangents) = (vec![DVec3::ZERO; count], vec![DVec3::ZERO; count]);
    for corners in primitive.indices.chunks_exact(3) {
        let [a, b, c] = [corners[0] as usize, corners[1] as usize, corners[2] as usize];
        let position = |i: usize| primitive.positions[i].as_dvec3();
        let (e1, e2) = (position(b) - position(a), position(c) - position(a));
        let (d1, d2) = ((uvs[b] - uvs[a]).as_dvec2(), (uvs[c] - uvs[a]).as_dvec2());
        // Not divided by the determinant: its magnitude is twice the area in texture space, and
        // the edges carry the area in space.
        let sign = d1.perp_dot(d2).signum();
        let tangent = (e1 * d2.y - e2 * d1.y) * sign;
        let bitangent = (e2 * d1.x - e1 * d2.x) * sign;
        for i in [a, b, c] {
            tangents[i] += tangent;
            bitangents[i] += bitangent;
        }
    }
    let sums = primitive.normals.iter().zip(tangents.into_iter().zip(bitangents));
    primitive.tangents = sums.map(|(&normal, (t, b))| orthogonal(normal, t, b)).collect();
}

fn orthogonal(normal: Vec3, tangent: DVec3, bitangent: DVec3) -> Vec4 {
    let n = normal.as_dvec3();
    let tangent = (tangent - n * n.dot(tangent)).normalize_or(n.any_orthonormal_vector());
    let up = if n.cross(tangent).dot(-bitangent) < 0.0 { -1.0 } else { 1.0 };
    tangent.as_vec3().extend(up)
}

/// Normal of a face, as long as twice its area.
fn face(positions: &[Vec3], corners: &[u32]) -> DVec3 {
    let [a, b, c] = [0, 1, 2].map(|i| positions[corners[i] as usize].as_dvec3());
    (b - a).cross(c - a)
}

/// Unit normals of unwelded faces, each three times.
fn face_normals(positions: &[Vec3]) -> Vec<Vec3> {
    let mut normals = Vec::with_capacity(positions.len());
    for corners in positions.chunks_exact(3) {
        let normal = face(corners, &[0, 1, 2]).normalize_or(DVec3::Y).as_vec3();
        normals.extend([normal; 3]);
    }
    normals
}

/// Area-weighted normals of the faces around each vertex.
fn smooth_normals(primitive: &Primitive) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; primitive.positions.len()];
    for corners in primitive.indices.chunks_exact(3) {
        let normal = face(&primitive.positions, corners);
        for &corner in corners {
            sums[corner as usize] += normal;
        }
    }
    sums.into_iter().map(|sum| sum.normalize_or(DVec3::Y).as_vec3()).collect()
}

/// Copies shared vertices, so that every index is used once and in order.
fn unweld(primitive: &mut Primitive) {
    let indices = std::mem::take(&mut primitive.indices);
    spread(&mut primitive.positions, &indices);
    spread(&mut primitive.uvs, &indices);
    spread(&mut primitive.colors, &indices);
    spread(&mut primitive.joints, &indices);
    spread(&mut primitive.weights, &indices);
    for target in &mut primitive.morphs {
        spread(&mut target.positions, &indices);
    }
    primitive.indices = (0..indices.len() as u32).collect();
}

fn spread<T: Copy>(values: &mut Vec<T>, indices: &[u32]) {
    if !values.is_empty() {
        *values = indices.iter().map(|&index| values[index as usize]).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quad in the xy plane that faces +z, with the image upright on it.
    fn quad() -> Primitive {
        Primitive {
            positions: [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| Vec3::new(x as f32, y as f32, 0.0)).to_vec(),
            normals: vec![Vec3::Z; 4],
            uvs: [[0, 1], [1, 1], [1, 0], [0, 0]].map(|[u, v]| Vec2::new(u as f32, v as f32)).to_vec(),
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Primitive::default()
        }
    }

    #[test]
    fn tangents_of_an_upright_image_point_along_u_with_a_positive_sign() {
        let mut primitive = quad();
        let uvs = primitive.uvs.clone();
        compute_tangents(&mut primitive, &uvs);
        assert_eq!(primitive.tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
        let mirrored: Vec<_> = uvs.iter().map(|uv| Vec2::new(1.0 - uv.x, uv.y)).collect();
        compute_tangents(&mut primitive, &mirrored);
        assert_eq!(primitive.tangents, [Vec4::new(-1.0, 0.0, 0.0, -1.0); 4]);
    }

    #[test]
    fn tangents_without_usable_texture_coordinates_are_still_unit_and_orthogonal() {
        let mut primitive = quad();
        compute_tangents(&mut primitive, &[Vec2::ZERO; 4]);
        for tangent in &primitive.tangents {
            let t = tangent.truncate();
            assert!((t.length() - 1.0).abs() < 1e-6 && t.dot(Vec3::Z).abs() < 1e-6);
        }
    }

    #[test]
    fn unusable_normals_are_computed_from_the_faces_around() {
        let mut primitive = quad();
        primitive.normals = vec![Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::MAX), Vec3::X * 4.0];
        assert_eq!(repair_normals(&mut primitive), 2);
        assert_eq!(primitive.normals[..2], [Vec3::Z, Vec3::Z]);
        assert!(primitive.normals[2].is_normalized());
        assert_eq!(primitive.normals[3], Vec3::X);
    }

    #[test]
    fn tiny_triangles_keep_their_normals_and_only_those_without_area_are_dropped() {
        let mut primitive = quad();
        for position in &mut primitive.positions {
            *position *= 1e-30;
        }
        primitive.indices.extend([0, 0, 1]);
        assert_eq!(drop_zero_area(&mut primitive), 1);
        flatten(&mut primitive);
        assert_eq!(primitive.normals, [Vec3::Z; 6]);
    }
}

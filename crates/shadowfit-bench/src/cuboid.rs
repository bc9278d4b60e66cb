//! The triangles of boxes.

use glam::Vec3;
use shadowfit::Aabb;

/// Corners around each face, as indices into [`Aabb::corners`].
const FACES: [[usize; 4]; 6] = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [2, 3, 7, 6], [0, 3, 7, 4], [1, 2, 6, 5]];

/// Returns the twelve triangles of a box.
pub(crate) fn triangles(aabb: &Aabb) -> impl Iterator<Item = [Vec3; 3]> + use<> {
    let corners = aabb.corners();
    FACES.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).map(move |face| face.map(|i| corners[i]))
}

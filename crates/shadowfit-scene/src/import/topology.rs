//! Triangles from the primitive modes of glTF 2.0 (section 3.7.2.1).

use gltf::json::mesh::Mode;

/// Returns the vertex indices of a triangle list, three per triangle. Empty for points and lines. Leftover
/// vertices at the end are ignored.
pub(crate) fn triangle_list(mode: Mode, corners: &[u32]) -> Vec<u32> {
    match mode {
        Mode::Triangles => corners[..corners.len() / 3 * 3].to_vec(),
        Mode::TriangleStrip => {
            corners.windows(3).enumerate().flat_map(|(number, corners)| strip_triangle(number, corners)).collect()
        }
        Mode::TriangleFan => {
            let rim = corners.get(1..).unwrap_or_default();
            rim.windows(2).flat_map(|edge| [edge[0], edge[1], corners[0]]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}

/// Returns a triangle of a strip. Every second one has reversed winding: (i, i + 1 + i % 2, i + 2 - i % 2).
fn strip_triangle(number: usize, corners: &[u32]) -> [u32; 3] {
    let odd = number % 2;
    [corners[0], corners[1 + odd], corners[2 - odd]]
}

/// Returns the usual name of a mode without triangles, or `None` for the other modes.
pub(crate) fn without_triangles(mode: Mode) -> Option<&'static str> {
    match mode {
        Mode::Points => Some("points"),
        Mode::Lines | Mode::LineLoop | Mode::LineStrip => Some("lines"),
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => None,
    }
}

/// Finds the vertices that triangles use. Reused from one primitive to the next, so that primitives which
/// share a large accessor only take time for their own triangles.
#[derive(Default)]
pub(crate) struct UsedVertices {
    /// For each vertex, its index in the list of used vertices. All are [`UNUSED`] between two calls.
    places: Vec<u32>,
}

const UNUSED: u32 = u32::MAX;

impl UsedVertices {
    /// Lists the vertices that indices use, in the order of their first use, and renumbers the indices by
    /// this list. If all of `count` vertices are used, leaves the indices unchanged and returns `None`.
    /// Indices must be below `count`.
    pub(crate) fn compact(&mut self, indices: &mut [u32], count: usize) -> Option<Vec<u32>> {
        if self.places.len() < count {
            self.places.resize(count, UNUSED);
        }
        let mut used = Vec::new();
        for &vertex in indices.iter() {
            let place = &mut self.places[vertex as usize];
            if *place == UNUSED {
                *place = used.len() as u32;
                used.push(vertex);
            }
        }
        let some = used.len() < count;
        if some {
            for vertex in indices.iter_mut() {
                *vertex = self.places[*vertex as usize];
            }
        }
        for &vertex in &used {
            self.places[vertex as usize] = UNUSED;
        }
        some.then_some(used)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unused_vertices_are_left_out_and_nothing_of_a_primitive_is_left_for_the_next() {
        let mut used = UsedVertices::default();
        for _ in 0..2 {
            let mut indices = [7, 2, 7, 9, 2, 7];
            assert_eq!(used.compact(&mut indices, 10), Some(vec![7, 2, 9]));
            assert_eq!(indices, [0, 1, 0, 2, 1, 0]);
        }
        let mut all = [2, 0, 1];
        assert_eq!((used.compact(&mut all, 3), all), (None, [2, 0, 1]));
        assert_eq!(used.compact(&mut [], 10), Some(Vec::new()));
    }

    #[test]
    fn strips_and_fans_keep_the_winding_of_their_first_triangle() {
        assert_eq!(triangle_list(Mode::TriangleStrip, &[0, 1, 2, 3]), [0, 1, 2, 1, 3, 2]);
        assert_eq!(triangle_list(Mode::TriangleFan, &[0, 1, 2, 3]), [1, 2, 0, 2, 3, 0]);
    }

    #[test]
    fn incomplete_triangles_are_left_out() {
        assert_eq!(triangle_list(Mode::Triangles, &[0, 1, 2, 3]), [0, 1, 2]);
        for mode in [Mode::Triangles, Mode::TriangleStrip, Mode::TriangleFan] {
            for count in 0..3 {
                assert!(triangle_list(mode, &[7; 3][..count]).is_empty());
            }
        }
    }
}

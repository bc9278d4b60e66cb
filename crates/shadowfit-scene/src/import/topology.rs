//! Triangles from the primitive modes of glTF 2.0 (section 3.7.2.1).

use gltf::json::mesh::Mode;

/// Vertex indices, three a triangle, with the winding of a triangle list. Empty for points and lines.
/// Vertices left over at the end make no triangle.
pub(crate) fn triangle_list(mode: Mode, corners: &[u32]) -> Vec<u32> {
    match mode {
        Mode::Triangles => corners[..corners.len() / 3 * 3].to_vec(),
        Mode::TriangleStrip => corners.windows(3).enumerate().flat_map(strip_triangle).collect(),
        Mode::TriangleFan => {
            let rim = corners.get(1..).unwrap_or_default();
            rim.windows(2).flat_map(|edge| [edge[0], edge[1], corners[0]]).collect()
        }
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    }
}

/// Every second triangle of a strip is turned round: (i, i + 1 + i % 2, i + 2 - i % 2).
fn strip_triangle((number, corners): (usize, &[u32])) -> [u32; 3] {
    let odd = number % 2;
    [corners[0], corners[1 + odd], corners[2 - odd]]
}

/// The usual name of a mode that has no triangles; `None` for the others.
pub(crate) fn without_triangles(mode: Mode) -> Option<&'static str> {
    match mode {
        Mode::Points => Some("points"),
        Mode::Lines | Mode::LineLoop | Mode::LineStrip => Some("lines"),
        Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

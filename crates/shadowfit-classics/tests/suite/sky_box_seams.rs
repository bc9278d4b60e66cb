//! The picture of the sky box.

use std::collections::BTreeMap;

use glam::{IVec2, UVec2, Vec3};
use shadowfit_classics::sky_box::{SkyPicture, direction_of, face_of};

#[test]
fn faces_join_without_a_seam_at_all_twelve_edges() {
    let size = 128;
    let picture = SkyPicture::new(Vec3::Y, size);
    let texel = |face: usize, at: UVec2| {
        let [r, g, b, _] = picture.faces[face][(at.y * size + at.x) as usize].map(f32::from);
        Vec3::new(r, g, b)
    };
    // For each edge: the sum of differences across it, the sum of differences to the next texels inside the
    // face, and their number.
    let mut edges: BTreeMap<[usize; 2], [f32; 3]> = BTreeMap::new();
    let apart = |a: Vec3, b: Vec3| (a - b).abs().max_element();
    for (face, index) in (0..6).flat_map(|face| (0..size).map(move |index| (face, index))) {
        for (at, out) in [
            (UVec2::new(0, index), IVec2::NEG_X),
            (UVec2::new(size - 1, index), IVec2::X),
            (UVec2::new(index, 0), IVec2::NEG_Y),
            (UVec2::new(index, size - 1), IVec2::Y),
        ] {
            // Half a texel to the edge and slightly beyond.
            let beyond = direction_of(face, (at.as_vec2() + 0.5 + out.as_vec2() * 0.51) / size as f32);
            let (other, uv) = face_of(beyond);
            assert_ne!(other, face);
            let across = (uv * size as f32).as_uvec2().min(UVec2::splat(size - 1));
            let inside = (at.as_ivec2() - out).as_uvec2();
            let sums = edges.entry([face.min(other), face.max(other)]).or_default();
            sums[0] += apart(texel(face, at), texel(other, across));
            sums[1] += apart(texel(face, at), texel(face, inside));
            sums[2] += 1.0;
        }
    }
    assert_eq!(edges.len(), 12);
    for (edge, [across, inside, count]) in edges {
        println!("{edge:?}: {} levels across, {} within", across / count, inside / count);
        // A seam of one level would be visible.
        assert!(across <= inside + count, "{edge:?}");
    }
}

//! Generated scenes for the tests of found paths. World space, metres. Front faces point out of solids.

use glam::Vec3;
use shadowfit::Aabb;

pub(super) type Corners = [Vec3; 3];

/// Returns a closed box with outward front faces.
pub(super) fn cuboid(low: Vec3, high: Vec3) -> Vec<Corners> {
    let corner = |index: usize| {
        let pick = |bit: usize, low: f32, high: f32| if index >> bit & 1 == 1 { high } else { low };
        Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
    };
    // Counter-clockwise seen from outside; bits of an index are x, y and z.
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|triangle| triangle.map(corner)).collect()
}

/// Returns a room of 8 × 3 × 6 m seen from inside, with a table, a cupboard that reaches the ceiling, and a
/// pillar.
pub(super) fn room() -> Vec<Corners> {
    let walls = cuboid(Vec3::new(-4.0, 0.0, -3.0), Vec3::new(4.0, 3.0, 3.0));
    let mut triangles: Vec<Corners> = walls.into_iter().map(|[a, b, c]| [a, c, b]).collect();
    triangles.extend(cuboid(Vec3::new(-1.0, 0.7, -0.5), Vec3::new(0.6, 0.75, 0.5)));
    triangles.extend(cuboid(Vec3::new(3.0, 0.0, -1.0), Vec3::new(3.9, 3.0, 1.0)));
    triangles.extend(cuboid(Vec3::new(-2.1, 0.0, 1.2), Vec3::new(-1.8, 3.0, 1.5)));
    triangles
}

/// Returns a square kilometre of hills, a sheet that faces upward.
pub(super) fn hills() -> Vec<Corners> {
    const CELLS: usize = 64;
    let point = |x: usize, z: usize| {
        let [x, z] = [x, z].map(|place| (place as f32 / CELLS as f32 - 0.5) * 1000.0);
        Vec3::new(x, 40.0 * (x * 0.013).sin() * (z * 0.017).cos() + 15.0 * (x * 0.05 + z * 0.03).sin(), z)
    };
    let cells = (0..CELLS * CELLS).map(|cell| (cell % CELLS, cell / CELLS));
    cells
        .flat_map(|(x, z)| {
            let [a, b, c, d] = [point(x, z), point(x, z + 1), point(x + 1, z + 1), point(x + 1, z)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Returns a small solid on a floor of 10 m.
pub(super) fn object_on_floor() -> Vec<Corners> {
    let mut triangles = cuboid(Vec3::new(-5.0, -0.1, -5.0), Vec3::new(5.0, 0.0, 5.0));
    triangles.extend(cuboid(Vec3::new(-0.3, 0.0, -0.3), Vec3::new(0.3, 1.0, 0.3)));
    triangles
}

/// Returns the box around triangles.
pub(super) fn bounds(triangles: &[Corners]) -> Aabb {
    Aabb::from_points(triangles.iter().flatten().copied()).expect("triangles")
}

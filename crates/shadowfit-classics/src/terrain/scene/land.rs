//! The land: a vertex for each texel of the height map, under grass with some earth.

use glam::{Vec2, Vec3, Vec4};
use shadowfit_scene::parts::{Builder, draw_noisy, hash};
use shadowfit_scene::{Image, Primitive, Transform};

use super::heights::{HeightMap, TEXELS, ease, noise};
use super::palette::Paint;

/// Pixels along a side of the texture.
const SIZE: u32 = 512;

/// Adds the land.
pub(super) fn build(builder: &mut Builder) {
    let land = builder.mesh("land", vec![sheet(&HeightMap::new())]);
    builder.node("land", None, Transform::default(), Some(land));
}

/// Builds the surface of a height map: texel (x, z) of red value r is the vertex (x, r/5, z).
fn sheet(map: &HeightMap) -> Primitive {
    let mut sheet = Primitive { material: Paint::Land.into(), ..Primitive::default() };
    for z in 0..TEXELS {
        for x in 0..TEXELS {
            let [along_x, along_z] = map.slope(x, z);
            let normal = Vec3::new(-along_x, 1.0, -along_z).normalize();
            sheet.positions.push(Vec3::new(x as f32, map.height(x, z), z as f32));
            sheet.normals.push(normal);
            sheet.uvs.push(Vec2::new(x as f32, z as f32));
            sheet.colors.push(tint(x as f32, z as f32, normal.y));
        }
    }
    let row = TEXELS as u32;
    for z in 0..row - 1 {
        for x in 0..row - 1 {
            let a = z * row + x;
            let [b, c, d] = [a + row, a + row + 1, a + 1];
            sheet.indices.extend([a, b, c, a, c, d]);
        }
    }
    sheet
}

/// Returns the colour at a place. Patches of drier and greener land, larger than the texture's tiles, hide
/// its repetition. Steep slopes are bare.
fn tint(x: f32, z: f32, up: f32) -> Vec4 {
    let patch = 0.5 + 0.3 * noise(x / 33.0, z / 33.0, 64, 604) + 0.2 * noise(x / 14.0, z / 14.0, 64, 705);
    let meadow = Vec3::new(0.86, 0.96, 0.80).lerp(Vec3::new(1.08, 1.0, 0.86), patch);
    meadow.lerp(Vec3::new(1.06, 0.95, 0.84), ease(0.9 - up, 0.0, 0.22)).extend(1.0)
}

/// Draws grass of short strokes in several greens, worn to earth in patches.
pub(super) fn image() -> Image {
    let mix = |a: [f32; 3], b: [f32; 3], t: f32| std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t);
    let unit = 1.0 / SIZE as f32;
    draw_noisy("grass and earth", SIZE, [1.0, 2.0, 4.0], |x, y, [clump, tuft, grain]| {
        let (u, v) = (x as f32 * unit, y as f32 * unit);
        let fields = noise(u * 9.0, v * 9.0, 9, 806);
        let patches = noise(u * 23.0, v * 23.0, 23, 907);
        let stroke = hash(x, 1000 + y / 4 + 3 * (x % 3)) - 0.5;
        let green =
            mix([78.0, 98.0, 54.0], [112.0, 122.0, 70.0], (0.5 + 0.3 * fields + 0.25 * patches).clamp(0.0, 1.0));
        let worn = 0.62 * patches + 0.26 * fields + 0.34 * clump + 0.24 * tuft;
        let earth = ((worn - 0.44) * 2.8).clamp(0.0, 0.85);
        let light = 10.0 * clump + 9.0 * tuft + 8.0 * grain + 16.0 * stroke;
        let color: [f32; 3] = mix(green, [124.0, 108.0, 84.0], earth);
        [color[0] + light, color[1] + light, color[2] + 0.7 * light, 255.0]
    })
}

//! Conversion of a fitted map to Bevy's cascade.

use bevy::light::cascade::Cascade;
use bevy::math::{DMat4, DVec2, DVec3, DVec4};
use shadowfit::FittedMap;

/// Box of a map along the light's axes, relative to the world's origin, in metres.
struct LightBox {
    /// Axes of the light in the world: x right, y up in the map, z toward the light.
    axes: [DVec3; 3],
    /// Width and height.
    size: DVec2,
    /// Clip x and y of the world's origin.
    origin: DVec2,
    /// Near plane and far plane along z.
    near: f64,
    far: f64,
}

impl LightBox {
    fn new(map: &FittedMap) -> Self {
        let map_box = &map.projection;
        // Uses arrays, because shadowfit's glam may be newer than Bevy's.
        let light_from_world = DMat4::from_cols_array(&map_box.light_from_world.to_cols_array().map(f64::from));
        let axes = [0, 1, 2].map(|row| light_from_world.row(row).truncate());
        let resolution = DVec2::from_array(map_box.resolution.to_array().map(f64::from));
        if let Some(grid) = &map.grid_position {
            // These numbers are the same in each frame, moved by whole texels, which f32 represents exactly.
            let first = DVec2::from_array(grid.first.map(|line| line as f64));
            let size = DVec2::from_array(grid.texel.to_array()) * resolution;
            return Self {
                axes,
                size,
                origin: -(2.0 * first / resolution + 1.0),
                near: grid.depth[1],
                far: grid.depth[0],
            };
        }
        let size = DVec2::from_array((map_box.box_max - map_box.box_min).truncate().to_array().map(f64::from));
        let eye = DVec3::from_array(map_box.origin.to_array());
        // The world's origin in light space.
        let world = light_from_world.w_axis.truncate() - DVec3::from_array(axes.map(|axis| axis.dot(eye)));
        let near = f64::from(map_box.box_max.z) - world.z;
        Self { axes, size, origin: 2.0 * world.truncate() / size, near, far: near - f64::from(map_box.depth_range) }
    }
}

/// Returns the cascade of a map, whose near plane is moved toward the light by `room` metres, for receivers
/// that a bias moves toward it. Bevy's shader treats points in front of the near plane as lit.
///
/// It uses Bevy's spaces: right-handed, in metres, with the origin at the centre of the near plane and the
/// light along -z. In clip space the near plane is at depth 1 and the far plane at 0.
pub(crate) fn cascade(map: &FittedMap, room: f32) -> Cascade {
    let LightBox { axes: [x, y, z], size, origin, near, far } = LightBox::new(map);
    let near = near + f64::from(room);
    let (scale, depth) = (2.0 / size, 1.0 / (near - far));
    let centre = -origin / scale;
    let position = x * centre.x + y * centre.y + z * near;
    let world_from_cascade = DMat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), position.extend(1.0));
    let clip_from_cascade = DMat4::from_cols(
        DVec4::new(scale.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, scale.y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, depth, 0.0),
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );
    let clip_from_world = DMat4::from_cols(
        DVec4::new(x.x * scale.x, y.x * scale.y, z.x * depth, 0.0),
        DVec4::new(x.y * scale.x, y.y * scale.y, z.y * depth, 0.0),
        DVec4::new(x.z * scale.x, y.z * scale.y, z.z * depth, 0.0),
        DVec4::new(origin.x, origin.y, -far * depth, 1.0),
    );
    Cascade {
        world_from_cascade: world_from_cascade.as_mat4(),
        clip_from_cascade: clip_from_cascade.as_mat4(),
        clip_from_world: clip_from_world.as_mat4(),
        texel_size: map.projection.texel_size.max_element(),
    }
}

//! All maps side by side over the whole picture, with kept parts, redrawn parts, and moving casters.

use glam::Vec4;
use shadowfit::{Aabb, FittedMap};
use shadowfit_egui::MAP_UPDATE_COLORS;
use shadowfit_params::figures::linear_color;
use shadowfit_render::{Inset, Quad, UpdateKind, UpdatedRect};

use super::inset::{depths, tint};

/// Gap between maps and around them, as a share of the picture's height.
const GAP: f32 = 0.03;
/// Free height at the picture's upper edge for text, as a share of the picture's height.
const HEAD: f32 = 0.06;
/// Strength of the colour over a kept map.
const KEPT: f32 = 0.12;
/// Strength of the colour over a part of a map.
const FILL: f32 = 0.35;

/// The maps in their places.
pub(super) struct Boards {
    pub(super) insets: Vec<Inset>,
    /// Texels across and down of each map.
    sizes: Vec<[f32; 2]>,
    /// Size of the picture, in pixels.
    size: [f32; 2],
}

/// Colour around the maps, linear.
const GROUND: Vec4 = Vec4::new(0.006, 0.007, 0.009, 1.0);

impl Boards {
    /// Places maps as large as the picture of `size` pixels allows.
    pub(super) fn new(maps: &[FittedMap], bounds: &Aabb, depth_range: Option<[f32; 2]>, size: [u32; 2]) -> Self {
        let [width, height] = size.map(|side| side as f32);
        let gap = (GAP * height).round();
        let free = [width, height - HEAD * height];
        let count = maps.len().max(1);
        // The number of columns that leaves each map the largest square.
        let side = |columns: usize| {
            let rows = count.div_ceil(columns);
            let [w, h] = [columns, rows];
            ((free[0] - gap) / w as f32).min((free[1] - gap) / h as f32) - gap
        };
        // Of two equal choices, the one with fewer columns is taken.
        let columns = (1..=count).rev().max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(1);
        let side = side(columns).max(1.0).floor();
        let rows = count.div_ceil(columns);
        let left = (free[0] - columns as f32 * (side + gap) + gap) * 0.5;
        let top = HEAD * height + (free[1] - rows as f32 * (side + gap) + gap) * 0.5;
        let insets = maps.iter().enumerate().map(|(index, map)| {
            let (column, row) = (index % columns, index / columns);
            let corner = [left + column as f32 * (side + gap), top + row as f32 * (side + gap)].map(f32::round);
            let depth_range = depth_range.or_else(|| depths(&map.projection, bounds)).unwrap_or([0.0, 1.0]);
            let resolution = map.projection.resolution.as_vec2();
            let [w, h] = (resolution / resolution.max_element() * side).to_array();
            Inset { rectangle: [corner[0], corner[1], w, h], depth_range, map: index as u32, border: tint(index) }
        });
        let sizes = maps.iter().map(|map| map.projection.resolution.as_vec2().to_array()).collect();
        Self { insets: insets.collect(), sizes, size: [width, height] }
    }

    /// Covers the picture around the maps: a band above each row and below the last, and the areas beside them.
    fn ground(&self) -> Vec<Quad> {
        let [width, height] = self.size;
        let mut quads = Vec::new();
        let mut below = 0.0;
        for row in self.insets.chunk_by(|a, b| a.rectangle[1] == b.rectangle[1]) {
            let top = row[0].rectangle[1];
            let bottom = row.iter().map(|inset| top + inset.rectangle[3]).fold(top, f32::max);
            quads.push([0.0, below, width, top - below]);
            let mut right = 0.0;
            for inset in row {
                let [x, y, w, h] = inset.rectangle;
                quads.push([right, top, x - right, bottom - top]);
                quads.push([x, y + h, w, bottom - y - h]);
                right = x + w;
            }
            quads.push([right, top, width - right, bottom - top]);
            below = bottom;
        }
        quads.push([0.0, below, width, height - below]);
        quads.into_iter().map(|rectangle| Quad::rectangle(rectangle, GROUND)).collect()
    }

    /// Returns a quad over each map in the colour of kept parts, and quads over it for the redrawn
    /// rectangles.
    pub(super) fn quads(&self, updates: &[UpdatedRect]) -> Vec<Quad> {
        let color = |color: [u8; 3]| linear_color(color).extend(FILL);
        let [kept, drawn, moving] = MAP_UPDATE_COLORS.map(color);
        let mut quads = self.ground();
        quads.extend(self.insets.iter().map(|inset| Quad::rectangle(inset.rectangle, kept.truncate().extend(KEPT))));
        for update in updates {
            let (Some(inset), Some(size)) = (self.insets.get(update.map), self.sizes.get(update.map)) else { continue };
            let [x, y, w, h] = inset.rectangle;
            let scale = [w / size[0], h / size[1]];
            let (min, extent) = (update.rect.min.as_vec2(), update.rect.size.as_vec2());
            let place = [x + min.x * scale[0], y + min.y * scale[1], extent.x * scale[0], extent.y * scale[1]];
            let color = if update.content == UpdateKind::Moving { moving } else { drawn };
            quads.push(Quad::rectangle(place, color));
            quads.extend(Quad::outline(place, 1.5, color.truncate().extend(1.0)));
        }
        quads
    }
}

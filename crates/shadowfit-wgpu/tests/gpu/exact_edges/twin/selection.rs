//! Maps that a pixel reads: the arithmetic of the look-up's `shadowfit_select`.

use shadowfit::glam::{Vec2, Vec3};
use shadowfit::settings::MapSelection;
use shadowfit_wgpu::uniforms::MapUniform;

use super::{Twin, texture_place};

pub(super) struct Selection {
    pub(super) first: i32,
    pub(super) second: i32,
    pub(super) weight: f32,
    pub(super) clamped: i32,
    pub(super) far: f32,
}

impl Twin {
    pub(super) fn free(&self, entry: u32, map: &MapUniform, position: Vec3) -> f32 {
        let uv = texture_place(map, position.extend(1.0));
        let size = Vec2::from(map.size);
        let free = uv.truncate().min(Vec2::ONE - uv.truncate()) * size;
        let is_held = uv.cmpge(Vec3::ZERO).all() && uv.cmple(Vec3::ONE).all();
        if entry < self.receiver.map_count && is_held { free.min_element() } else { -1.0 }
    }

    fn is_open(&self, selection: &Selection, entry: i32, view_depth: f32, map: &MapUniform) -> bool {
        match self.descriptor.selection {
            MapSelection::Coverage { .. } => selection.first < 0 || (selection.second < 0 && selection.weight < 1.0),
            MapSelection::ViewDepth { .. } if selection.first < 0 => view_depth < map.far,
            MapSelection::ViewDepth { .. } => {
                selection.first + 1 == entry && view_depth > map.blend_near && map.blend_near < selection.far
            }
        }
    }

    pub(super) fn choose(&self, position: Vec3) -> Selection {
        let view_depth = self.view_depth(position) + self.slack * 0.01;
        let reach = self.descriptor.softness.filter_radius(self.descriptor.filter);
        let blend = self.descriptor.selection.blend();
        let mut selection = Selection { first: -1, second: -1, weight: 1.0, clamped: -1, far: 0.0 };
        for entry in 0..self.descriptor.maps {
            let map = &self.receiver.maps[entry as usize];
            let number = entry.cast_signed();
            if !self.is_open(&selection, number, view_depth, map) {
                continue;
            }
            let free = self.free(entry, map, position) + self.slack;
            if self.descriptor.selection.is_by_coverage() {
                if free >= reach {
                    if selection.first < 0 {
                        let beyond = free - reach;
                        selection = Selection {
                            first: number,
                            weight: if beyond < blend { beyond / blend } else { 1.0 },
                            ..selection
                        };
                    } else {
                        selection.second = number;
                    }
                } else if free >= 0.0 && selection.clamped < 0 {
                    selection.clamped = number;
                }
            } else if free >= 0.0 {
                if selection.first < 0 {
                    selection = Selection { first: number, far: map.far, ..selection };
                } else {
                    selection.second = number;
                }
            }
        }
        if selection.first < 0 {
            selection.first = selection.clamped;
        }
        selection
    }
}

//! Which maps a pixel reads: the arithmetic of the look-up's `shadowfit_choose`.

use shadowfit::glam::{Vec2, Vec3};
use shadowfit::settings::MapSelection;
use shadowfit_wgpu::MapUniform;

use super::{Twin, texture_place};

pub(super) struct Choice {
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

    fn is_open(&self, choice: &Choice, entry: i32, view_depth: f32, map: &MapUniform) -> bool {
        match self.descriptor.selection {
            MapSelection::Coverage { .. } => choice.first < 0 || (choice.second < 0 && choice.weight < 1.0),
            MapSelection::ViewDepth { .. } if choice.first < 0 => view_depth < map.far,
            MapSelection::ViewDepth { .. } => {
                choice.first + 1 == entry && view_depth > map.blend_near && map.blend_near < choice.far
            }
        }
    }

    pub(super) fn choose(&self, position: Vec3) -> Choice {
        let view_depth = self.view_depth(position) + self.slack * 0.01;
        let reach = self.descriptor.softness.reach(self.descriptor.filter);
        let blend = self.descriptor.selection.blend();
        let mut choice = Choice { first: -1, second: -1, weight: 1.0, clamped: -1, far: 0.0 };
        for entry in 0..self.descriptor.maps {
            let map = &self.receiver.maps[entry as usize];
            let number = entry.cast_signed();
            if !self.is_open(&choice, number, view_depth, map) {
                continue;
            }
            let free = self.free(entry, map, position) + self.slack;
            if self.descriptor.selection.is_by_coverage() {
                if free >= reach {
                    if choice.first < 0 {
                        let beyond = free - reach;
                        choice = Choice {
                            first: number,
                            weight: if beyond < blend { beyond / blend } else { 1.0 },
                            ..choice
                        };
                    } else {
                        choice.second = number;
                    }
                } else if free >= 0.0 && choice.clamped < 0 {
                    choice.clamped = number;
                }
            } else if free >= 0.0 {
                if choice.first < 0 {
                    choice = Choice { first: number, far: map.far, ..choice };
                } else {
                    choice.second = number;
                }
            }
        }
        if choice.first < 0 {
            choice.first = choice.clamped;
        }
        choice
    }
}

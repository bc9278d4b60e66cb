//! The body of a house: walls with recessed openings, plinth, roof, gable, and the windows of side walls.

use glam::Affine3A;

use super::dress;
use super::front::{Finish, Openings, WALL, far_window, flat_window, pierced};
use super::house::{Detail, FOOT, House, Top};
use super::kit::{Kit, across};
use super::palette::Paint;
use super::plan::DEPTH;
use super::roof::{Saddle, chimney, dormer, gutter, sideways};
use super::timber::{beams, gable_beams};
use crate::parts::prism;

impl House {
    /// Returns the openings of the front, upwards.
    fn openings(&self) -> Vec<Openings> {
        let ground = Openings { heights: [0.0, 2.6], gaps: dress::ground_gaps(self) };
        let upper =
            (1..self.floors).map(|floor| Openings { heights: self.window_heights(floor), gaps: self.columns() });
        std::iter::once(ground).chain(upper).collect()
    }

    /// Builds the house.
    pub(super) fn kit(&self) -> Kit {
        let mut kit = Kit::default();
        self.walls(&mut kit);
        self.roof(&mut kit);
        dress::dress(&mut kit, self);
        if self.finish == Finish::Timbers {
            beams(&mut kit, self);
        }
        for (side, is_in_sight) in [-1.0, 1.0].into_iter().zip(self.flanks) {
            if is_in_sight {
                self.flank(&mut kit, side);
            }
        }
        kit
    }

    /// Adds the body, the front wall and the plinth.
    fn walls(&self, kit: &mut Kit) {
        let roof = self.saddle();
        let half = self.width / 2.0;
        let front = if self.detail == Detail::Near { -WALL } else { 0.0 };
        if self.top == Top::Eaves {
            let lift = front.abs() * roof.rise();
            let outline = [
                (-DEPTH, FOOT),
                (front, FOOT),
                (front, roof.eaves + lift),
                (-DEPTH / 2.0, roof.ridge),
                (-DEPTH, roof.eaves),
            ];
            kit.add(self.wall, across(&outline, self.width));
        } else {
            let outline = [(-half, FOOT), (half, FOOT), (half, roof.eaves), (0.0, roof.ridge), (-half, roof.eaves)];
            kit.add(self.wall, prism(&outline, DEPTH + front).moved([0.0, 0.0, (front - DEPTH) / 2.0]));
        }
        if self.detail == Detail::Near {
            kit.add(self.wall, pierced(half, [FOOT, roof.eaves], &self.openings()));
        }
        let plinth = if self.finish == Finish::Timbers { Paint::Granite } else { Paint::Stone };
        for [left, right] in dress::plinth_parts(self) {
            kit.plank(plinth, [left, FOOT, -0.1], [right, 0.5, 0.06]);
        }
    }

    /// Adds slopes, ridge, gable, chimney and dormers.
    fn roof(&self, kit: &mut Kit) {
        let roof = self.saddle();
        let half = self.width / 2.0;
        let brick = if self.wall == Paint::Brick { Paint::Trim } else { Paint::Brick };
        if self.top == Top::Eaves {
            kit.add(self.tiles, sideways(roof.slopes(self.width + 0.12), DEPTH / 2.0));
            kit.add(self.tiles, sideways(roof.ridge_tiles(self.width + 0.2), DEPTH / 2.0));
            chimney(kit, [self.shift * half * 0.7, -DEPTH / 2.0 - 0.9], [roof.ridge - 1.6, roof.ridge + 1.0], brick);
            if self.detail == Detail::Near {
                kit.add(Paint::Granite, gutter(half, roof.over, roof.low() + 0.1));
            }
            for x in dress::dormer_places(self) {
                dormer(kit, x, roof, [self.wall, self.tiles]);
            }
            return;
        }
        self.gable(kit, roof);
        let over = if self.top == Top::Gable { 0.36 } else { -0.3 };
        let (length, middle) = (DEPTH + over, (over - DEPTH) / 2.0);
        kit.add(self.tiles, roof.slopes(length).moved([0.0, 0.0, middle]));
        kit.add(self.tiles, roof.ridge_tiles(length + 0.05).moved([0.0, 0.0, middle]));
        let x = self.shift.signum() * half * 0.4;
        let foot = roof.ridge - 0.4 * half * roof.rise();
        chimney(kit, [x, -DEPTH * 0.62], [foot - 0.6, roof.ridge + 0.8], brick);
    }

    /// Adds the front's gable and its window.
    fn gable(&self, kit: &mut Kit, roof: Saddle) {
        let (half, rise) = (self.width / 2.0, roof.ridge - roof.eaves);
        if self.top == Top::Steps {
            let steps = 5;
            let share = |step: usize| step as f32 / steps as f32;
            for step in 0..steps {
                let reach = half * (1.0 - share(step)) + if step == 0 { 0.0 } else { 0.12 };
                let foot = roof.eaves + rise * share(step) + if step == 0 { 0.0 } else { 0.35 };
                let head = roof.eaves + rise * share(step + 1) + 0.35;
                kit.plank(self.wall, [-reach, foot, -0.34], [reach, head, 0.012]);
                kit.plank(Paint::Trim, [-reach - 0.06, head - 0.02, -0.4], [reach + 0.06, head + 0.1, 0.07]);
            }
        } else if self.detail == Detail::Near {
            let outline = [(-half, roof.eaves), (half, roof.eaves), (0.0, roof.ridge)];
            kit.add(self.wall, prism(&outline, WALL).moved([0.0, 0.0, -WALL / 2.0]));
        }
        flat_window(kit, [-0.42, 0.42], [roof.eaves + 0.7, roof.eaves + 1.95]);
        if self.finish == Finish::Timbers && self.top == Top::Gable {
            gable_beams(kit, roof);
        }
    }

    /// Adds windows to a side wall: -1 is the left, 1 the right.
    fn flank(&self, kit: &mut Kit, side: f32) {
        let mut wall = Kit::default();
        for floor in 0..self.floors {
            let heights = self.window_heights(floor);
            for z in [-0.27, 0.02, 0.3] {
                let middle = z * DEPTH;
                far_window(&mut wall, [middle - 0.45, middle + 0.45], heights, true);
            }
        }
        if self.top == Top::Eaves {
            let foot = self.eaves() + 0.6;
            far_window(&mut wall, [-0.42, 0.42], [foot, foot + 1.2], true);
        }
        wall.plank(Paint::Granite, [-DEPTH / 2.0 + 0.11, FOOT, -0.1], [DEPTH / 2.0 - 0.02, 0.49, 0.05]);
        let turn = Affine3A::from_rotation_y(side * std::f32::consts::FRAC_PI_2);
        let place = Affine3A::from_translation(glam::Vec3::new(side * self.width / 2.0, 0.0, -DEPTH / 2.0));
        kit.add_all(wall, place * turn);
    }
}

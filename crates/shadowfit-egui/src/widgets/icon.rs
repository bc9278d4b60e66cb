//! Icons of lines. They are painted because egui's default fonts have no such glyphs.

use std::f32::consts::TAU;

use egui::{Painter, Pos2, Rect, Shape, Stroke, Vec2};

/// What a button without text shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    /// An arrow back.
    Undo,
    /// An arrow forward.
    Redo,
    /// An arrow in a circle.
    Reset,
    /// Two sheets.
    Copy,
    /// A camera.
    Screenshot,
    /// A disc, half of it filled.
    Theme,
    /// A question mark.
    Help,
    /// A cross.
    Close,
    /// A floppy disk.
    Save,
    /// A bin.
    Delete,
    /// Arrows in both directions.
    Swap,
    /// A magnifying glass.
    Search,
    /// A triangle that points to the right.
    Play,
    /// Two bars.
    Pause,
}

impl Icon {
    /// Paints the icon in the middle of `rect`, 14 points wide.
    pub(crate) fn paint(self, painter: &Painter, rect: Rect, stroke: Stroke) {
        /// Half the width of an icon, in points.
        const RADIUS: f32 = 7.0;
        let at = |x: f32, y: f32| rect.center() + RADIUS * Vec2::new(x, y);
        let line = |points: &[(f32, f32)]| {
            painter.line(points.iter().map(|(x, y)| at(*x, *y)).collect(), stroke);
        };
        match self {
            Self::Undo => arrow_back(painter, at, 1.0, stroke),
            Self::Redo => arrow_back(painter, at, -1.0, stroke),
            Self::Reset => reset(painter, rect.center(), 0.8 * RADIUS, stroke),
            Self::Copy => {
                line(&[(-0.35, -0.85), (0.85, -0.85), (0.85, 0.35), (-0.35, 0.35), (-0.35, -0.85)]);
                line(&[(-0.35, -0.35), (-0.85, -0.35), (-0.85, 0.85), (0.35, 0.85), (0.35, 0.35)]);
            }
            Self::Screenshot => {
                line(&[(-0.95, -0.45), (-0.45, -0.45), (-0.25, -0.8), (0.25, -0.8), (0.45, -0.45), (0.95, -0.45)]);
                line(&[(0.95, -0.45), (0.95, 0.75), (-0.95, 0.75), (-0.95, -0.45)]);
                painter.circle_stroke(at(0.0, 0.12), 0.34 * RADIUS, stroke);
            }
            Self::Theme => theme(painter, rect.center(), 0.8 * RADIUS, stroke),
            Self::Help => {
                let hook = (0..=10)
                    .map(|step| at(0.0, -0.35) + 0.42 * RADIUS * Vec2::angled(TAU * (0.5 + step as f32 * 0.065)));
                painter.line(hook.chain([at(0.0, 0.3)]).collect(), stroke);
                painter.circle_filled(at(0.0, 0.75), 0.75 * stroke.width, stroke.color);
            }
            Self::Close => {
                line(&[(-0.6, -0.6), (0.6, 0.6)]);
                line(&[(0.6, -0.6), (-0.6, 0.6)]);
            }
            Self::Save => {
                line(&[(-0.8, -0.8), (0.45, -0.8), (0.8, -0.45), (0.8, 0.8), (-0.8, 0.8), (-0.8, -0.8)]);
                line(&[(-0.4, -0.8), (-0.4, -0.35), (0.25, -0.35), (0.25, -0.8)]);
                line(&[(-0.45, 0.8), (-0.45, 0.15), (0.45, 0.15), (0.45, 0.8)]);
            }
            Self::Delete => {
                line(&[(-0.8, -0.55), (0.8, -0.55)]);
                line(&[(-0.3, -0.6), (-0.3, -0.9), (0.3, -0.9), (0.3, -0.6)]);
                line(&[(-0.6, -0.5), (-0.5, 0.85), (0.5, 0.85), (0.6, -0.5)]);
            }
            Self::Swap => {
                line(&[(0.9, -0.4), (-0.9, -0.4), (-0.5, -0.8)]);
                line(&[(-0.9, 0.4), (0.9, 0.4), (0.5, 0.8)]);
            }
            Self::Play => {
                let corners = vec![at(-0.45, -0.7), at(0.75, 0.0), at(-0.45, 0.7)];
                painter.add(Shape::convex_polygon(corners, stroke.color, Stroke::NONE));
            }
            Self::Pause => {
                for x in [-0.55, 0.15] {
                    painter.rect_filled(Rect::from_min_max(at(x, -0.7), at(x + 0.4, 0.7)), 0.0, stroke.color);
                }
            }
            Self::Search => {
                painter.circle_stroke(at(-0.15, -0.15), 0.55 * RADIUS, stroke);
                line(&[(0.25, 0.25), (0.8, 0.8)]);
            }
        }
    }
}

/// A circle, half of it filled.
fn theme(painter: &Painter, center: Pos2, radius: f32, stroke: Stroke) {
    painter.circle_stroke(center, radius, stroke);
    let half = (0..=12).map(|step| center + radius * Vec2::angled(TAU * (step as f32 / 24.0 - 0.25)));
    painter.add(Shape::convex_polygon(half.collect(), stroke.color, Stroke::NONE));
}

/// An arrow that bends back to the left, or with a side of -1 to the right.
fn arrow_back(painter: &Painter, at: impl Fn(f32, f32) -> Pos2, side: f32, stroke: Stroke) {
    let bend = (0..=10).map(|step| {
        let turn = Vec2::angled(TAU * (step as f32 / 20.0 - 0.25));
        at(side * (0.3 + 0.55 * turn.x), 0.2 + 0.55 * turn.y)
    });
    let start = [at(-0.85 * side, -0.35)];
    painter.line(start.into_iter().chain(bend).chain([at(-0.25 * side, 0.75)]).collect(), stroke);
    painter.line(vec![at(-0.45 * side, -0.8), at(-0.9 * side, -0.35), at(-0.45 * side, 0.1)], stroke);
}

/// An arrow that turns back anticlockwise.
fn reset(painter: &Painter, center: Pos2, radius: f32, stroke: Stroke) {
    const SEGMENTS: u8 = 16;
    // From the arrow's head at the upper left, clockwise over the top, most of the way round; y points down.
    let at = |turn: f32, radius: f32| center + radius * Vec2::angled(TAU * turn);
    let arc = (0..=SEGMENTS).map(|step| at(-0.4 + 0.75 * f32::from(step) / f32::from(SEGMENTS), radius)).collect();
    painter.line(arc, stroke);
    let head = [at(-0.4, radius + 3.0), at(-0.4, radius - 3.0), at(-0.5, radius + 0.5)];
    painter.add(Shape::convex_polygon(head.into(), stroke.color, Stroke::NONE));
}

//! The car: a saloon on y = 0 that faces +z. Its unit is four of the street's units.

use glam::{Vec2, Vec3};
use shadowfit_scene::Primitive;
use shadowfit_scene::parts::{CRISP, SMOOTH, Solid, Stop, block, ellipsoid, rounded_box, superellipse, sweep};

use super::body::{HALF_LENGTH, HALF_WIDTH, flank};
use super::palette::Paint;
use super::panel::Panel;
use super::{body, cabin, wheel};

/// Crease angle of pressed metal, in radians. Only wheel arches are sharp.
const PRESSED: f32 = 0.85;

/// Returns the parts of the car, one for each material.
pub(super) fn primitives() -> Vec<Primitive> {
    let painted = body::solid().with(cabin::solid()).with(mirrors());
    let dark = wheel::tyres().with(underbody()).with(bumper(1.0)).with(bumper(-1.0)).with(seams()).with(grille());
    vec![
        painted.primitive(Paint::Body.into(), PRESSED),
        cabin::windows().primitive(Paint::Glass.into(), CRISP),
        dark.primitive(Paint::Rubber.into(), CRISP),
        wheel::hubs().with(headlights()).with(handles()).with(plates()).primitive(Paint::Chrome.into(), CRISP),
        tail_lights().primitive(Paint::TailLight.into(), SMOOTH),
    ]
}

/// Builds the block between the wheels, so that nobody looks through the wheel arches.
fn underbody() -> Solid {
    block([-0.46, 0.14, -1.38], [0.46, 0.52, 1.38], 0.03)
}

/// Builds a bumper around the nose (`end` 1) or the tail (-1).
fn bumper(end: f32) -> Solid {
    const STEPS: usize = 28;
    let point = |step: usize, out: f32| {
        let turn = (step as f32 / STEPS as f32 * 2.0 - 1.0) * 1.13;
        let (x, z) = superellipse(turn, 4.0);
        Vec3::new(x * (HALF_WIDTH + out), 0.335, end * (HALF_LENGTH - 0.5 + z * (0.5 + out)))
    };
    let stops = (0..=STEPS).map(|step| {
        let end = step.min(STEPS - step) as f32;
        Stop { at: point(step, 0.012), half: [0.065, 0.045].map(|half| half * (0.4 + 0.3 * end).min(1.0)) }
    });
    sweep(&stops.collect::<Vec<_>>(), Vec3::Y, 14)
}

/// Builds the mirrors at the front of the side windows.
fn mirrors() -> Solid {
    let shell = rounded_box([0.07, 0.047, 0.034], 0.03, 4).moved([0.73, 0.83, 0.47]);
    let arm = block([0.56, 0.785, 0.45], [0.70, 0.815, 0.485], 0.01);
    shell.with(arm).and_mirrored()
}

/// Builds the gaps around the doors and a strip of rubber along the flanks.
fn seams() -> Solid {
    // The first parameter points up and the second toward the nose, so the outer side is +x.
    let surface = |at: Vec2| flank(at.x, at.y);
    let gap = |z: f32| {
        let (low, high) = (Vec2::new(0.20, z - 0.006), Vec2::new(0.665, z + 0.006));
        Panel::between(low, high, 0.0, 0.002).solid(surface, [8, 1])
    };
    let strip = Panel::between(Vec2::new(0.40, -0.64), Vec2::new(0.435, 0.68), 0.2, 0.006).solid(surface, [2, 16]);
    gap(0.60).with(gap(-0.10)).with(gap(-0.66)).with(strip).and_mirrored()
}

/// Builds the air openings between the headlights and below the bumper.
fn grille() -> Solid {
    rounded_box([0.27, 0.045, 0.05], 0.02, 2).moved([0.0, 0.475, HALF_LENGTH - 0.035])
}

/// Builds two round headlights.
fn headlights() -> Solid {
    ellipsoid([0.115, 0.075, 0.075], 26, 16).moved([0.45, 0.485, HALF_LENGTH - 0.06]).and_mirrored()
}

/// Builds two wide tail lights.
fn tail_lights() -> Solid {
    rounded_box([0.13, 0.06, 0.06], 0.03, 3).moved([0.44, 0.53, -HALF_LENGTH + 0.045]).and_mirrored()
}

/// Builds the handles of four doors.
fn handles() -> Solid {
    let handle = |z: f32| {
        let at = flank(0.60, z);
        block(at + Vec3::new(-0.02, -0.013, -0.06), at + Vec3::new(0.014, 0.013, 0.06), 0.008)
    };
    handle(0.0).with(handle(-0.56)).and_mirrored()
}

/// Builds number plates on both bumpers.
fn plates() -> Solid {
    let plate = |end: f32| {
        let half = Vec3::new(0.16, 0.045, 0.02);
        rounded_box(half, 0.006, 1).moved(Vec3::new(0.0, 0.335, end * (HALF_LENGTH + 0.04)))
    };
    plate(1.0).with(plate(-1.0))
}

//! Cached maps: prints how few texels are redrawn while the camera walks and the sun moves.
//!
//! `LightStepState` moves the sun in steps, and `Scroll` returns the texels of a map that the previous frame
//! already drew. The walk lasts one minute at 10 frames per second, and each output line covers one second.
//! No GPU, no window.
//!
//! ```sh
//! cargo run --example still_maps
//! ```

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::scroll::Scroll;
use shadowfit::{Aabb, Boxes, FitError, FitInput, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::tool::LightSettings;

const SECONDS: u32 = 60;
const FRAMES_PER_SECOND: u32 = 10;
/// Walking speed of a person, in metres per second.
const WALKING_SPEED: f64 = 1.4;
/// Angular speed of the sun, in radians per second: one turn per day.
const SUN_SPEED: f32 = std::f32::consts::TAU / 86_400.0;

fn main() -> Result<(), FitError> {
    let objects = street();
    let boxes = Boxes::world(&objects);
    let (mut fitter, mut light_steps) = (ShadowFitter::new(&Technique::default()), LightStepState::default());
    let mut before = FittedMaps::default();
    let mut total = Redrawn::default();
    println!("second     texels redrawn  whole maps  sun");
    for second in 0..SECONDS {
        let (mut redrawn, mut steps) = (Redrawn::default(), 0);
        for frame in 0..FRAMES_PER_SECOND {
            let seconds = f64::from(second) + f64::from(frame) / f64::from(FRAMES_PER_SECOND);
            let held = light_steps.held;
            let light = light_steps.update(sun(seconds), &LightSteps::default(), 1.0 / FRAMES_PER_SECOND as f32)?;
            steps += u32::from(held.is_some_and(|held| held != light.direction));
            let views = [camera(seconds).frustum()?];
            let input =
                FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, light.direction) };
            let maps = fitter.fit(&input)?;
            redrawn.add(&before, maps);
            before = *maps;
        }
        let note = if steps > 0 { "steps" } else { "does not move" };
        println!("{second:>6}  {:>16.2}%  {:>10}  {note}", redrawn.percent(), redrawn.whole);
        total = Redrawn {
            texels: total.texels + redrawn.texels,
            all: total.all + redrawn.all,
            whole: total.whole + redrawn.whole,
        };
    }
    println!(
        "In one minute, {:.2}% of all texels were redrawn, and {} maps were redrawn completely.",
        total.percent(),
        total.whole
    );
    Ok(())
}

/// Number of redrawn texels and maps, summed over several maps.
#[derive(Default)]
struct Redrawn {
    texels: u64,
    /// Number of texels of all maps.
    all: u64,
    /// Number of maps that had to be redrawn completely.
    whole: u32,
}

impl Redrawn {
    fn add(&mut self, before: &FittedMaps, now: &FittedMaps) {
        for (index, map) in now.iter().enumerate() {
            let texels = u64::from(map.projection.resolution.element_product());
            self.all += texels;
            let scroll = before.get(index).map(|before| Scroll::between(before, map));
            if let Some(scroll) = scroll.filter(|scroll| !scroll.is_redraw()) {
                self.texels += scroll.exposed().map(|rect| u64::from(rect.size.element_product())).sum::<u64>();
            } else {
                self.texels += texels;
                self.whole += 1;
            }
        }
    }

    fn percent(&self) -> f64 {
        100.0 * self.texels as f64 / self.all as f64
    }
}

/// Returns the camera at a time of the walk along the street. It looks around while it walks.
fn camera(seconds: f64) -> PerspectiveCamera {
    let turn = 0.3 * (seconds * 0.2).sin() as f32;
    PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 50.0 - WALKING_SPEED * seconds),
        forward: Vec3::new(turn.sin(), -0.05, -turn.cos()).normalize(),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 200.0,
    }
}

/// Returns the direction of travel of the sunlight.
fn sun(seconds: f64) -> Vec3 {
    LightSettings { azimuth: 0.6 + SUN_SPEED * seconds as f32, ..LightSettings::default() }.direction()
}

/// Returns the boxes of the ground and of two rows of houses, in metres.
fn street() -> Vec<Aabb> {
    let mut objects = vec![Aabb::new(Vec3::new(-60.0, -0.1, -120.0), Vec3::new(60.0, 0.0, 80.0))];
    for house in 0..8_u8 {
        let (front, height) = (60.0 - 22.0 * f32::from(house), 6.0 + f32::from(house % 3) * 2.0);
        for left in [-18.0, 8.0] {
            objects.push(Aabb::new(Vec3::new(left, 0.0, front - 15.0), Vec3::new(left + 10.0, height, front)));
        }
    }
    objects
}

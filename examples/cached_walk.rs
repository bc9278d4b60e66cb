//! Caching without a graphics API: the decisions of `MapCache` while a camera walks past houses and people.
//!
//! For each frame and map it prints the reuse of the map, the redrawn share, the number of rectangles, static
//! casters and moving casters, and the texel offset of the layer. In the frame after a new map, its static
//! casters are drawn once more, into a separate layer. No GPU, no window.
//!
//! ```sh
//! cargo run --example cached_walk
//! ```

use shadowfit::cache::{CacheFrame, CacheSettings, Casters, FramePlan, MapCache, MapReuse, PassKind};
use shadowfit::glam::{DVec3, IVec2, Vec3};
use shadowfit::{Aabb, Boxes, FitError, FitInput, PerspectiveCamera, ShadowFitter, Technique};

const FRAMES: u16 = 24;
/// Distance walked per frame, in metres. It is much longer than in a game, so that a short table shows every
/// decision.
const STEP: f32 = 1.0;
/// Direction of travel of the sunlight.
const SUN: Vec3 = Vec3::new(0.3, -0.8, 0.2);

fn main() -> Result<(), FitError> {
    let technique = Technique::default();
    let mut fitter = ShadowFitter::new(&technique);
    let mut cache = MapCache::new(CacheSettings::of(&technique));
    let (mut redrawn, mut all) = (0, 0);
    println!("frame  map  reuse               redrawn  rectangles  static  moving  texel offset");
    for frame in 0..FRAMES {
        let (views, objects) = ([camera(frame).frustum()?], street(frame));
        let boxes = Boxes::world(&objects);
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, SUN) };
        let maps = fitter.fit(&input)?;
        let casters = Casters { moves: &[true; PEOPLE as usize], ..Casters::fixed(boxes) };

        let plan = cache.update(&CacheFrame::new(maps, casters, &views, SUN))?;
        // An engine draws `plan.passes` here, and gives `plan.maps` to its shaders.
        for (map, read) in plan.maps.iter().enumerate() {
            let (work, texels) = (Work::of(plan, map), u64::from(read.projection.resolution.element_product()));
            println!(
                "{frame:>5}  {map:>3}  {:<18}  {:>6.2}%  {:>10}  {:>6}  {:>6}  {}",
                reuse(plan.reuse[map]),
                100.0 * work.texels as f64 / texels as f64,
                work.rectangles,
                work.fixed,
                work.moving,
                read.texel_offset,
            );
            redrawn += work.texels;
            all += texels;
        }
    }
    println!("Static casters were drawn into {:.2}% of all texels.", 100.0 * redrawn as f64 / all as f64);
    Ok(())
}

fn reuse(reuse: MapReuse) -> String {
    match reuse {
        MapReuse::Kept { shift: IVec2::ZERO } => "kept".to_owned(),
        MapReuse::Kept { shift } => format!("moved by {}, {}", shift.x, shift.y),
        other => format!("{other:?}").to_lowercase(),
    }
}

/// The work of one frame for one map.
#[derive(Default)]
struct Work {
    /// Texels into which static casters are drawn.
    texels: u64,
    rectangles: usize,
    fixed: usize,
    moving: usize,
}

impl Work {
    fn of(plan: &FramePlan, map: usize) -> Self {
        let mut work = Self::default();
        for pass in plan.passes.iter().filter(|pass| pass.map == map) {
            for region in plan.regions_of(pass) {
                let moving = plan.casters_of(region).iter().filter(|number| **number < PEOPLE.into()).count();
                work.moving += moving;
                work.fixed += plan.casters_of(region).len() - moving;
                if pass.content != PassKind::Moving {
                    work.texels += region.part.stored.area();
                    work.rectangles += 1;
                }
            }
        }
        work
    }
}

fn camera(frame: u16) -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 30.0 - f64::from(STEP * f32::from(frame))),
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 200.0,
    }
}

/// Number of people that walk along the street and back. Houses and ground follow them in the list of boxes.
const PEOPLE: u8 = 12;

fn street(frame: u16) -> Vec<Aabb> {
    let person = |number: u8| {
        let walked = 0.05 * f32::from(frame) * if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        let feet = Vec3::new(f32::from(number % 3) * 3.0 - 3.0, 0.0, 20.0 - 6.0 * f32::from(number) + walked);
        Aabb::new(feet - Vec3::new(0.3, 0.0, 0.3), feet + Vec3::new(0.3, 1.8, 0.3))
    };
    let house = |number: u8| {
        let (left, front) = (if number.is_multiple_of(2) { -18.0 } else { 8.0 }, 40.0 - 9.0 * f32::from(number));
        Aabb::new(Vec3::new(left, 0.0, front - 15.0), Vec3::new(left + 10.0, 5.0 + f32::from(number % 5), front))
    };
    let ground = Aabb::new(Vec3::new(-60.0, -0.1, -200.0), Vec3::new(60.0, 0.0, 60.0));
    (0..PEOPLE).map(person).chain((0..16).map(house)).chain([ground]).collect()
}

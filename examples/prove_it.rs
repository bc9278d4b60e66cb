//! Proofs instead of pictures: every map of every frame of a camera flight is proven to have no holes. Of maps that are
//! cascades, the depths that the last frame showed make splits sharper without putting that at risk, and fewer
//! are taken where they are as good. No GPU, no window.
//!
//! ```sh
//! cargo run --example prove_it
//! ```

use shadowfit::demand::DepthBounds;
use shadowfit::fewest_maps;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::proof::{CoverageProof, CoverageQuery, Margins, prove};
use shadowfit::settings::SplitScheme;
use shadowfit::{
    Aabb, Boxes, Cascades, FitError, FitInput, FittedMaps, PerspectiveCamera, Scratch, ShadowFitter, Technique,
    ViewFrustum,
};

const FRAMES: u32 = 120;
/// The way the sun's light travels.
const SUN: Vec3 = Vec3::new(0.55, -0.6, -0.4);

fn main() -> Result<(), FitError> {
    let objects = columns();
    let boxes = Boxes::world(&objects);
    let mut storage = vec![DVec2::ZERO; Scratch::required(objects.len(), 1)];
    let mut scratch = Scratch::new(&mut storage);

    let technique = Technique::default();
    let mut fitter = ShadowFitter::new(&technique);
    let mut least = Margins { planes: [f32::INFINITY; 6], casters: f32::INFINITY };
    for frame in 0..FRAMES {
        let views = [camera(frame).frustum()?];
        let input = input(&views, boxes);
        let maps = fitter.fit(&input)?;
        for (index, proof) in proofs(&input, &technique, maps, &mut scratch)?.into_iter().enumerate() {
            match proof {
                CoverageProof::Proven(margins) => least = least_of(least, margins),
                hole => println!("frame {frame}, map {index}: {hole:?}"),
            }
        }
    }
    println!(
        "{FRAMES} frames of {} maps: least free texels at the sides {:?}",
        technique.maps.count(),
        &least.planes[..4]
    );
    println!("least metres free at the far plane {}, before the first caster {}", least.planes[4], least.casters);

    let views = [camera(0).frustum()?];
    let input = input(&views, boxes);
    let cascades = Cascades::default();
    let count = fewest_maps(&input, &technique.with_maps(cascades), 1.5, &mut scratch)?;
    println!("{count} cascades instead of {} make texels at most 1.5 times as coarse", cascades.count);

    // Where no boxes say what is visible: without bounds, with those that a reduction of the last depth buffer gives,
    // and with wrong ones, as after a camera cut.
    let logarithmic = technique.with_maps(cascades.with_splits(SplitScheme::Logarithmic));
    for depth_bounds in [None, Some((9.0, 60.0)), Some((1.0, 2.0))] {
        let depth_bounds = depth_bounds.map(|(near, far)| DepthBounds { near, far });
        let input = FitInput { receivers: None, depth_bounds, ..input };
        let mut fitter = ShadowFitter::new(&logarithmic);
        let maps = fitter.fit(&input)?;
        let ends: Vec<f64> = maps.iter().filter_map(|map| map.depths?.far).collect();
        let is_proven = proofs(&input, &logarithmic, maps, &mut scratch)?.iter().all(CoverageProof::is_proven);
        println!("{depth_bounds:?}: cascades end at {ends:?} m, no holes: {is_proven}");
    }
    Ok(())
}

/// What is proven of each map: all receivers that it serves are in it with all that the filter reads, and no caster is
/// lost.
fn proofs(
    input: &FitInput,
    technique: &Technique,
    maps: &FittedMaps,
    scratch: &mut Scratch,
) -> Result<Vec<CoverageProof>, FitError> {
    let mut proofs = Vec::new();
    for map in maps.iter() {
        let query = CoverageQuery::of_map(map, technique, technique.filter_radius_in(&map.projection))
            .with_normal_offset(map.bias.normal_offset);
        proofs.push(prove(input, &map.projection, &query, scratch)?);
    }
    Ok(proofs)
}

fn least_of(a: Margins, b: Margins) -> Margins {
    let mut planes = a.planes;
    for (plane, other) in planes.iter_mut().zip(b.planes) {
        *plane = plane.min(other);
    }
    Margins { planes, casters: a.casters.min(b.casters) }
}

fn input<'a>(views: &'a [ViewFrustum], boxes: Boxes<'a>) -> FitInput<'a> {
    FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(views, SUN) }
}

/// A flight around the scene.
fn camera(frame: u32) -> PerspectiveCamera {
    let angle = f64::from(frame) * 0.03;
    let eye = DVec3::new(30.0 * angle.sin(), 4.0 + angle, 30.0 * angle.cos());
    let forward = (DVec3::new(0.0, 2.0, 0.0) - eye).normalize().as_vec3();
    PerspectiveCamera { eye, forward, up: Vec3::Y, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 }
}

/// A floor with columns on it, in metres.
fn columns() -> Vec<Aabb> {
    let mut objects = vec![Aabb::new(Vec3::new(-40.0, -0.5, -40.0), Vec3::new(40.0, 0.0, 40.0))];
    for column in 0..25_u8 {
        let (x, z) = (f32::from(column % 5) * 6.0 - 12.0, f32::from(column / 5) * 6.0 - 12.0);
        objects.push(Aabb::new(Vec3::new(x - 0.5, 0.0, z - 0.5), Vec3::new(x + 0.5, 5.0, z + 0.5)));
    }
    objects
}

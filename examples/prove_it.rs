//! Proves that no map of any frame of a camera flight has holes. Then it fits cascades without boxes, from
//! the depth range of the last frame, and proves these too: the range makes the splits sharper and causes no
//! holes. It also finds the smallest number of cascades that is sharp enough. No GPU, no window.
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
/// Direction of travel of the sunlight.
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
        "{FRAMES} frames of {} maps: smallest margins at the sides, in texels: {:?}",
        technique.maps.count(),
        &least.planes[..4]
    );
    println!("smallest margin at the far plane: {} m, before the first caster: {} m", least.planes[4], least.casters);

    let views = [camera(0).frustum()?];
    let input = input(&views, boxes);
    let cascades = Cascades::default();
    let count = fewest_maps(&input, &technique.with_maps(cascades), 1.5, &mut scratch)?;
    println!("with {count} cascades instead of {}, texels are at most 1.5 times coarser", cascades.count);

    // Without receiver boxes: first without depth bounds, then with the bounds that a reduction of the last
    // depth buffer gives, then with wrong bounds, as after a camera cut.
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

/// Returns a proof for each map: the map and the filter's footprint cover all receivers that the map serves,
/// and no caster is missing.
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

/// Returns the camera at a frame of its flight around the scene.
fn camera(frame: u32) -> PerspectiveCamera {
    let angle = f64::from(frame) * 0.03;
    let eye = DVec3::new(30.0 * angle.sin(), 4.0 + angle, 30.0 * angle.cos());
    let forward = (DVec3::new(0.0, 2.0, 0.0) - eye).normalize().as_vec3();
    PerspectiveCamera { eye, forward, up: Vec3::Y, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 }
}

/// Returns the boxes of a floor and the columns on it, in metres.
fn columns() -> Vec<Aabb> {
    let mut objects = vec![Aabb::new(Vec3::new(-40.0, -0.5, -40.0), Vec3::new(40.0, 0.0, 40.0))];
    for column in 0..25_u8 {
        let (x, z) = (f32::from(column % 5) * 6.0 - 12.0, f32::from(column / 5) * 6.0 - 12.0);
        objects.push(Aabb::new(Vec3::new(x - 0.5, 0.0, z - 0.5), Vec3::new(x + 0.5, 5.0, z + 0.5)));
    }
    objects
}

//! The comparison sampler: its lit region, and its bias with the wrong sign.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera};
use shadowfit_classics::{SampleDrawer, SampleDrawing};
use shadowfit_render::RenderTarget;
use shadowfit_truth::PictureFigures;

use super::bench::Bench;

const ID: &str = "comparison-sampler";
/// Half of the original window's size, in each direction.
const SIZE: [u32; 2] = [320, 240];

/// Returns the figures of a variant's view with options.
fn judged(bench: &Bench, view: &str, options: &[(&str, &str)]) -> [PictureFigures; 2] {
    let variant = bench.variant(view);
    let figures = bench.figures(Some(variant), &bench.values(Some(variant), options));
    figures.shadows().expect("shadows were judged")
}

#[test]
fn outside_of_the_lamps_image_everything_is_lit() {
    let mut bench = Bench::new(ID);
    let mut drawer = SampleDrawer::new(&bench.gpu, 1);
    // Looks down on the floor in front of all objects, across the image's lower border.
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.5, 5.0, 7.0),
        forward: Vec3::new(0.0, -1.0, -0.35).normalize(),
        ..bench.sample.lens(SIZE[0] as f32 / SIZE[1] as f32)
    };
    let SampleDrawing::Mapped(frame) = bench.sample.drawing(&bench.values(None, &[]), &camera).expect("a lamp") else {
        panic!("a lamp's sample is drawn by the samples' renderer");
    };
    let [shadowed, lit] = ["source", "off"].map(|shadows| {
        let values = bench.values(None, &[("shadows", shadows)]);
        let target = RenderTarget::new(&bench.gpu.device, SIZE, 1);
        drawer.draw(&bench.gpu, &mut bench.scene, bench.sample, &values, &camera, &target).expect("a picture");
        target.read(&bench.gpu).expect("pixels").as_chunks::<4>().0.to_vec()
    });
    let world_from_clip = camera.clip_from_world(DepthConvention::ZeroToOne).as_dmat4().inverse();
    let (mut outside, mut shadows) = (0, 0);
    for (pixel, (shadowed, lit)) in shadowed.iter().zip(&lit).enumerate() {
        let [x, y] = [(pixel as u32 % SIZE[0], SIZE[0]), (pixel as u32 / SIZE[0], SIZE[1])]
            .map(|(at, side)| (f64::from(at) + 0.5) / f64::from(side) * 2.0 - 1.0);
        let far = world_from_clip.project_point3(DVec3::new(x, -y, 1.0));
        let floor = camera.eye + far * (camera.eye.y / -far.y);
        shadows += u32::from(shadowed != lit);
        let clip = frame.light.clip_from_world * (floor - camera.eye).as_vec3().extend(1.0);
        if (3.9..5.9).contains(&floor.z) && clip.x.abs().max(clip.y.abs()) > 1.01 * clip.w {
            assert_eq!(shadowed, lit, "{floor}");
            outside += 1;
        }
    }
    assert!(outside > 2000 && shadows > 50, "{outside} {shadows}");
}

#[test]
fn at_grazing_light_front_faces_have_acne_and_back_faces_have_none_of_it() {
    let bench = Bench::new(ID);
    let [front, ours] = judged(&bench, "grazing", &[]);
    let [back, _] = judged(&bench, "grazing-back", &[]);
    assert!(front.false_shadow > 1.0, "{front:?}");
    assert!(back.false_shadow < 0.3 * front.false_shadow, "{back:?} {front:?}");
    assert!(ours.false_shadow < 0.1 * front.false_shadow, "{ours:?}");
}

#[test]
fn head_on_back_faces_are_reached_through_and_front_faces_are_not() {
    let bench = Bench::new(ID);
    let [back, ours] = judged(&bench, "head-on", &[]);
    let [front, _] = judged(&bench, "head-on-front", &[]);
    assert!(back.false_shadow > 1.0, "dark patches on vase and ring: {back:?}");
    assert!(front.false_shadow < 0.5 * back.false_shadow, "{front:?}");
    assert!(ours.false_shadow < 0.1 * back.false_shadow, "{ours:?}");
}

#[test]
fn straight_below_the_lamp_front_faces_leak_light() {
    let bench = Bench::new(ID);
    let [front, ours] = judged(&bench, "leak", &[]);
    assert!(front.false_light > 3.0 * ours.false_light, "{front:?} {ours:?}");
}

#[test]
fn modern_maps_are_wrong_at_fewer_pixels() {
    let bench = Bench::new(ID);
    for variant in ["literal", "front"] {
        for filter in ["point", "linear"] {
            let values = bench.values(None, &[("variant", variant), ("filter", filter)]);
            let [source, modern] = bench.figures(None, &values).shadows().expect("shadows were judged");
            assert!(modern.wrong < 0.7 * source.wrong, "{variant} {filter}: {source:?} {modern:?}");
        }
    }
}

#[test]
fn linear_filtering_gives_fractions() {
    let mut bench = Bench::new(ID);
    let [lit, ambient, filtered] = [("shadows", "off"), ("filter", "point"), ("filter", "linear")].map(|option| {
        let values = bench.values(None, &[option]);
        bench.picture(None, &values, SIZE)
    });
    let fraction = |pixel: usize| filtered[pixel] != lit[pixel] && filtered[pixel] != ambient[pixel];
    let between = (0..lit.len()).filter(|&pixel| fraction(pixel)).count();
    assert!(between > 300, "{between}");
}

//! Ambient occlusion: the error of each method compared with rays, and the surfaces that it darkens.

use shadowfit_classics::SampleFigures;

use super::bench::Bench;

const ID: &str = "ambient-occlusion";
const SIZE: [u32; 2] = [240, 180];

fn errors(bench: &Bench) -> Vec<(&'static str, f64)> {
    match bench.figures(None, &bench.values(None, &[])) {
        SampleFigures::Occlusion(errors) => errors,
        SampleFigures::Shadows { .. } => panic!("occlusion has no shadows"),
    }
}

#[test]
fn normals_are_much_closer_to_rays_than_depth_alone() {
    let bench = Bench::new(ID);
    let errors = errors(&bench);
    let of = |name: &str| errors.iter().find(|(method, _)| *method == name).expect("a method").1;
    assert!(of("front faces") < 0.06, "{errors:?}");
    assert!(of("front and back faces") < 0.06, "{errors:?}");
    assert!(of("front faces, level of detail") < 0.06, "{errors:?}");
    assert!(of("depth alone") > 3.0 * of("front faces"), "{errors:?}");
}

#[test]
fn occlusion_darkens_and_never_brightens_and_the_open_floor_hardly_at_all() {
    let mut bench = Bench::new(ID);
    let [front, off, grey] = [("front", "scene"), ("off", "scene"), ("front", "occlusion")].map(|(method, show)| {
        let values = bench.values(None, &[("method", method), ("show", show)]);
        bench.picture(None, &values, SIZE)
    });
    let changed = front.iter().zip(&off).filter(|(front, off)| front != off).count();
    assert!(changed > front.len() / 4, "{changed}");
    // Full light is 0.55 of ambient and up to 0.45 of diffuse light. Occlusion darkens only the ambient part,
    // which is the whole light where the sun does not shine, and at least 0.55 of it elsewhere. One or two
    // levels are rounding.
    for (pixel, ((front, off), grey)) in front.iter().zip(&off).zip(&grey).enumerate() {
        let hidden = 1.0 - f32::from(grey[0]) / 255.0;
        for channel in 0..3 {
            let [front, off] = [front, off].map(|color| f32::from(color[channel]));
            let possible = off * (1.0 - hidden) - 2.0..=off * (1.0 - 0.55 * hidden) + 2.0;
            assert!(front <= off && possible.contains(&front), "{pixel}: {front} of {off}, {hidden} hidden");
        }
    }
    // The middle of the floor before the camera is open.
    let open = |pixel: usize| (SIZE[0] as usize / 3..SIZE[0] as usize * 2 / 3).contains(&(pixel % SIZE[0] as usize));
    let floor = SIZE[0] as usize * (SIZE[1] as usize - 10)..front.len();
    for pixel in floor.filter(|pixel| open(*pixel)) {
        assert!(grey[pixel][0] >= 250, "{pixel}: {:?}", grey[pixel]);
    }
}

#[test]
fn what_is_traced_is_shown_as_it_was_traced() {
    let mut bench = Bench::new(ID);
    let [traced, off] = ["traced", "off"].map(|method| {
        let values = bench.values(None, &[("method", method), ("show", "occlusion")]);
        bench.picture(None, &values, SIZE)
    });
    // Without occlusion everything is white. Rays are blocked in a considerable part of the picture.
    assert!(off.iter().all(|pixel| pixel[..3] == [255; 3]));
    let hidden = traced.iter().filter(|pixel| pixel[0] < 200).count();
    assert!((traced.len() / 50..traced.len() / 2).contains(&hidden), "{hidden}");
    assert!(traced.iter().all(|pixel| pixel[0] == pixel[1] && pixel[1] == pixel[2]));
}

#[test]
fn back_faces_hide_something_besides() {
    let mut bench = Bench::new(ID);
    let [front, back] = ["front", "back"].map(|method| {
        let values = bench.values(None, &[("method", method), ("show", "occlusion"), ("blur", "off")]);
        bench.picture(None, &values, SIZE)
    });
    assert!(back.iter().zip(&front).all(|(back, front)| back[0] <= front[0]));
    let more = back.iter().zip(&front).filter(|(back, front)| back[0] < front[0]).count();
    assert!(more > front.len() / 100, "{more}");
}

//! Parallel splits: finer near the camera than far away, and better than one map.

use shadowfit::ShadowFitter;
use shadowfit_params::Inputs;
use shadowfit_study::View;

use super::bench::Bench;

const ID: &str = "parallel-split";

#[test]
fn each_split_has_coarser_texels_than_the_one_before() {
    let bench = Bench::new(ID);
    for splits in ["practical", "uniform", "logarithmic"] {
        let technique = bench.sample.technique(&bench.values(None, &[("splits", splits)]));
        let camera = bench.sample.seen_by(None, 16.0 / 9.0);
        let view = View { camera: camera.into(), direction: bench.sample.direction.normalize(), is_first: true };
        let maps = bench.scene.fit_alone(&mut ShadowFitter::new(&technique), Inputs::default(), &view).expect("maps");
        assert_eq!(maps.len(), 4);
        let texels: Vec<f32> = maps.iter().map(|map| map.projection.texel_size.max_element()).collect();
        assert!(texels.is_sorted(), "{splits}: {texels:?}");
        assert!(texels[3] > 1.5 * texels[0], "{splits}: {texels:?}");
    }
}

#[test]
fn four_maps_have_fewer_wrong_pixels_than_one_and_modern_maps_fewer_still() {
    let bench = Bench::new(ID);
    let wrong = |maps: &str| {
        let values = bench.values(None, &[("maps", maps)]);
        bench.figures(None, &values).shadows().expect("shadows").map(|figures| figures.wrong)
    };
    let ([four, modern], [one, _]) = (wrong("4"), wrong("1"));
    assert!(four < one && modern < four, "one {one}, four {four}, modern {modern}");
}

#[test]
fn the_tint_is_a_view_of_the_technique() {
    let bench = Bench::new(ID);
    assert!(!bench.sample.is_tinted(&bench.values(None, &[])));
    assert!(bench.sample.is_tinted(&bench.values(None, &[("tint", "on")])));
    assert!(bench.sample.is_technique(&bench.values(None, &[])));
}

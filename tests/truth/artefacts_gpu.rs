//! Each artefact alone, made on purpose: it is classified correctly, and its cure brings the count to zero.

use shadowfit::Technique;
use shadowfit::glam::{Affine3A, Quat, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, MapFormat, Softness};
use shadowfit_testing::subpixel_step;
use shadowfit_truth::PictureTally;

use super::shapes::{Arrangement, NO_BIAS, floor, single, solid};
use crate::support::test_gpu;

/// Returns a box on a floor, from above and from the side.
fn box_on_a_floor() -> Arrangement {
    let objects = vec![floor(8.0), solid(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0))];
    Arrangement::new(objects, Vec3::new(4.0, 4.5, 6.0), Vec3::new(-0.5, 0.5, 0.0), Vec3::new(-0.5, -0.7, -0.3))
}

/// Returns a thin wall on a floor, from its dark side. At a point at its foot, the occluder is no farther
/// away than the point is from the wall.
fn wall_on_a_floor() -> Arrangement {
    let objects = vec![floor(8.0), solid(Vec3::new(-2.0, 0.0, -0.01), Vec3::new(2.0, 2.0, 0.01))];
    Arrangement::new(objects, Vec3::new(-1.0, 4.0, -6.0), Vec3::new(-0.5, 0.5, -1.0), Vec3::new(-0.2, -0.7, -0.5))
}

/// Returns a map in a format, with texels so fine that depth steps dominate the error.
fn in_format(format: MapFormat, filter: FilterKind, bias: BiasSettings) -> Technique {
    single(FitKind::Focused, filter, bias).with_resolution(2048, 2048).with_format(format)
}

fn shares(tally: &PictureTally) -> [f64; 4] {
    [tally.all.false_shadow, tally.all.false_light, tally.all.hole, tally.all.edge].map(|count| tally.share(count))
}

#[test]
fn acne_without_a_bias_is_false_shadow_and_the_automatic_bias_leaves_none() {
    for filter in FilterKind::ALL {
        let bare = box_on_a_floor().judged(&single(FitKind::Focused, filter, NO_BIAS));
        let [acne, ..] = shares(&bare);
        let cured = box_on_a_floor().judged(&single(FitKind::Focused, filter, BiasSettings::automatic(filter)));
        println!("{filter:?}: {:?} without a bias, {:?} with the automatic one", shares(&bare), shares(&cured));
        assert!(acne > 0.1, "{filter:?}: {acne}");
        assert_eq!((cured.all.false_shadow, cured.all.false_light, cured.all.hole), (0, 0, 0), "{filter:?}");
        // The normal offset alone is also a cure, except where it moves a point near an edge to the other
        // side of it.
        let offset = BiasSettings::automatic_normal_offset(filter, &Softness::default());
        let offset = box_on_a_floor().judged(&single(FitKind::Focused, filter, offset));
        assert!(shares(&offset)[0] < 0.001, "{filter:?}: {:?}", shares(&offset));
    }
}

#[test]
fn the_automatic_bias_leaves_no_false_shadow_in_any_format() {
    for format in MapFormat::ALL {
        // One filter of each kind: a texel, a tent, and a disc with a search for casters.
        for filter in [FilterKind::Point, FilterKind::Pcf5x5, FilterKind::Pcss] {
            let tally = box_on_a_floor().judged(&in_format(format, filter, BiasSettings::automatic(filter)));
            println!("{format:?} {filter:?}: {:?}", shares(&tally));
            assert_eq!((tally.all.false_shadow, tally.all.hole), (0, 0), "{format:?} {filter:?}");
        }
    }
}

#[test]
fn eight_bits_of_depth_have_acne_without_their_steps_in_the_bias() {
    let filter = FilterKind::Hardware2x2;
    let without = BiasSettings { depth_steps: 0.0, ..BiasSettings::automatic(filter) };
    let [fine, grey] = [MapFormat::Depth32Float, MapFormat::R8Grey].map(|format| {
        let tally = box_on_a_floor().judged(&in_format(format, filter, without));
        println!("{format:?}: {:?}", shares(&tally));
        shares(&tally)[0]
    });
    // The bias has a margin for 1/256 texel. Corners may be misplaced by half a step of the rasteriser, which
    // changes the depths of a plane as if the look-ups reached farther by this step. They exceed the bias
    // only at points whose look-ups are in the last part of a texel.
    let step = f64::from(subpixel_step(&test_gpu().adapter.get_info()));
    let beyond = (step * 0.5 - 1.0 / 256.0).max(0.0);
    assert!(fine <= beyond && grey > beyond + 0.01, "{fine} {grey}, {beyond} beyond the bias");
}

#[test]
fn a_bias_ten_times_too_large_is_false_light() {
    for filter in FilterKind::ALL {
        let BiasSettings { constant, receiver_plane, .. } = BiasSettings::automatic(filter);
        let bias = BiasSettings { constant: constant * 10.0, receiver_plane: receiver_plane * 10.0, ..NO_BIAS };
        let tally = wall_on_a_floor().judged(&single(FitKind::Focused, filter, bias));
        let cured = wall_on_a_floor().judged(&single(FitKind::Focused, filter, BiasSettings::automatic(filter)));
        println!("{filter:?}: {:?}, {:?} with a tenth of it", shares(&tally), shares(&cured));
        assert!(shares(&cured)[1] < 0.0002, "{filter:?}: {:?}", shares(&cured));
        assert!(shares(&tally)[1] > 0.001, "{filter:?}: {:?}", shares(&tally));
        assert_eq!((tally.all.false_shadow, tally.all.hole), (0, 0), "{filter:?}");
    }
}

#[test]
fn the_hole_of_the_xna_sample_is_a_hole_and_nothing_else() {
    // The tower is behind the camera. The sample's box contains only the view, so it cuts the tower off.
    let objects = vec![floor(40.0), solid(Vec3::new(-1.0, 0.0, 8.0), Vec3::new(1.0, 12.0, 10.0))];
    let view =
        Arrangement::new(objects, Vec3::new(0.0, 2.0, 4.0), Vec3::new(0.0, 0.0, -3.0), Vec3::new(0.02, -0.6, -0.8));
    let filter = FilterKind::Hardware2x2;
    let holed = view.judged(&single(FitKind::XnaSample, filter, BiasSettings::automatic(filter)));
    println!("{:?} of {} pixels", shares(&holed), holed.all.facing);
    assert!(holed.share(holed.all.hole) > 0.05, "{:?}", shares(&holed));
    assert_eq!(
        (holed.all.wrong, holed.all.false_shadow, holed.all.false_light, holed.all.edge),
        (holed.all.hole, 0, 0, 0)
    );
    let cured = view.judged(&single(FitKind::Focused, filter, BiasSettings::automatic(filter)));
    assert_eq!((cured.all.hole, cured.all.false_shadow, cured.all.false_light), (0, 0, 0), "{:?}", shares(&cured));
}

#[test]
fn the_figures_are_those_of_the_same_scene_turned_moved_and_in_another_unit() {
    let filter = FilterKind::Pcf3x3;
    // By right angles: at other angles the objects' boxes would change.
    let technique = || single(FitKind::Focused, filter, BiasSettings::automatic(filter));
    let plain = box_on_a_floor().judged(&technique()).columns();
    let turn = Affine3A::from_rotation_translation(
        Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
        Vec3::new(30.0, -4.0, 12.0),
    );
    let roll = Affine3A::from_quat(Quat::from_rotation_x(std::f32::consts::FRAC_PI_2));
    for (what, motion, scale) in [
        ("turned", turn, 1.0),
        ("rolled", roll, 1.0),
        ("in centimetres", Affine3A::IDENTITY, 100.0),
        ("both", turn, 0.01),
    ] {
        let moved = box_on_a_floor().moved(&motion, scale).judged(&technique()).columns();
        for ((name, plain), (_, moved)) in plain.iter().zip(&moved) {
            // The map's rectangle is found again up to rounding, so that texels at edges may differ.
            let allowed = if name.ends_with('%') { 0.1 } else { 0.03 * plain.abs().max(0.1) };
            let is_same = (plain.is_nan() && moved.is_nan()) || (plain - moved).abs() <= allowed;
            assert!(is_same, "{what}: {name} {plain} became {moved}");
        }
    }
}

#[test]
fn a_scene_a_hundred_kilometres_from_the_origin_is_judged_as_at_home() {
    let filter = FilterKind::Pcf3x3;
    let technique = || single(FitKind::Focused, filter, BiasSettings::automatic(filter));
    let home = box_on_a_floor().judged(&technique());
    // Whole metres, which f32 represents exactly there.
    let away = box_on_a_floor().judged_away(&technique(), Vec3::new(100_000.0, 500.0, -75_000.0));
    let [home_shares, away_shares] = [&home, &away].map(shares);
    println!("{home_shares:?} at home, {away_shares:?} away");
    assert!(
        home.all.facing.abs_diff(away.all.facing) * 1000 <= home.all.facing,
        "{} and {}",
        home.all.facing,
        away.all.facing
    );
    for (home, away) in home_shares.iter().zip(away_shares) {
        assert!((home - away).abs() < 0.001, "{home_shares:?} at home, {away_shares:?} away");
    }
}

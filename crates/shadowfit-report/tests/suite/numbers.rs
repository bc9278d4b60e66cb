//! Published measures of other code's fits, reproduced from the same maps and scenes.

use shadowfit_report::geometry::Source;
use shadowfit_report::peers::{FitFile, Ranking, Row, Scenarios};
use shadowfit_truth::Tracer;

use crate::scratch::shared;

/// Rows of scene zdm2 in the README next to the fit files, in the order of [`Row::columns`] without
/// [`UNPUBLISHED`].
const ROWS: [(&str, [f64; 15]); 5] = [
    ("xna", [1.0, 0.0, 45.9, 45.9, 5.09, 8.52, 8.95, 100.0, 751_561.0, 406_844.0, 1.29, 0.353, 0.0, 0.561, 14.4]),
    ("three-csm", [4.0, 0.0, 0.0, 0.0, 2.91, 5.94, 6.36, 100.0, 125_855.0, 63_728.0, 2.41, 0.0003, 100.0, 0.0, 119.0]),
    (
        "babylon-csm-stable",
        [4.0, 0.0, 0.0, 1.17, 3.03, 6.06, 6.47, 100.0, 136_505.0, 69_245.0, 2.16, 0.0002, 100.0, 0.0, 2.37],
    ),
    (
        "babylon-csm-tight",
        [4.0, 0.0, 0.0, 65.0, 2.54, 5.56, 5.99, 99.4, 96_524.0, 52_157.0, 5.14, 0.376, 0.0, 0.637, 1.11],
    ),
    ("bevy", [4.0, 0.0, 0.0, 61.9, 2.69, 5.61, 6.02, 100.0, 99_711.0, 50_672.0, 2.85, 0.0003, 100.0, 0.0, 0.994]),
];

/// The column that is published only for all scenes together.
const UNPUBLISHED: &str = "kept %";

/// Critical resolutions of the same fits at light elevations of 15, 45 and 80 degrees.
const CRITICAL: [[f64; 3]; 5] = [
    [243_664.0, 288_202.0, 958_948.0],
    [36_417.0, 44_738.0, 158_854.0],
    [39_714.0, 48_524.0, 172_296.0],
    [31_294.0, 37_014.0, 122_493.0],
    [29_009.0, 35_637.0, 125_855.0],
];

#[test]
fn the_published_numbers_of_five_peers_are_found_again_to_the_last_digit() {
    let (Some(assets), Some(peers)) = (shared("assets"), shared("peers")) else { return };
    let mut ranking = Ranking::new(Scenarios::read(&peers.join("scenarios.json")).expect("scenarios"));
    for (peer, _) in ROWS {
        let file = peers.join(format!("fits/{peer}.json"));
        ranking.add(&FitFile::read(&file).expect("a fit"), &file).expect("all frames");
    }
    let source = Source { assets: Some(assets), triangles: None };
    let scene = ranking.scenarios().scenes.iter().position(|scene| scene.name == "zdm2").expect("the scene");
    let objects = source.read(&ranking.scenarios().scenes[scene]).expect("triangles");
    ranking.measure_scene(scene, &Tracer::new(objects.into_iter().flatten()), 1, &|| ());
    for ((table, (peer, numbers)), critical) in ranking.tables().iter().zip(ROWS).zip(CRITICAL) {
        assert_row(peer, &table.overall, numbers);
        let found: Vec<f64> = table.groups.iter().map(|(_, row)| row.critical.round()).collect();
        assert_eq!(found, critical, "{peer}");
    }
}

fn assert_row(peer: &str, row: &Row, published: [f64; 15]) {
    let found = row.columns().into_iter().filter(|(column, _)| *column != UNPUBLISHED);
    for ((column, found), published) in found.zip(published) {
        // Published with three digits, at most four decimals, whole resolutions. Before that, rounded to five
        // decimals.
        let last_digit = if column.starts_with("crit") { 1.0 } else { 10f64.powf(published.log10().floor() - 2.0) };
        let allowed = 0.5 * last_digit.clamp(1e-4, 1.0) + 0.5e-5;
        assert!((found - published).abs() <= allowed, "{peer}, {column}: {found}, not {published}");
    }
}

//! The columns of a fit, pooled over all frames, over each scene, and over each scene under one light.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::iter;

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use shadowfit_truth::PictureTally;

use super::tally::Tally;
use crate::markdown::{markdown_table, readable};

/// Number of depths that a 24-bit map can store.
const DEPTH_STEPS: f64 = (1u64 << 24) as f64;
/// Share of the points that have at most one pixel per texel at the critical resolution.
const CRITICAL_QUANTILE: f64 = 0.95;

/// The measures of a fit over a set of frames. A value that could not be measured is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Maps in a frame.
    pub maps: f64,
    /// Percentage of the facing points that no map covers. All further measures leave these points out.
    pub uncovered: f64,
    /// Percentage of the covered shadowed points whose shadow is lost: no occluder is in the map, nor before
    /// its near plane if the renderer clamps depth.
    pub lost: f64,
    /// Percentage of lost points without depth clamp.
    pub lost_unclamped: f64,
    /// Quantiles 50%, 95% and 99% of log2 of pixels per texel along the worse axis: 0 for one pixel per
    /// texel, 1 for two.
    pub error: [f64; 3],
    /// Percentage of points with more than one pixel per texel.
    pub undersampled: f64,
    /// Critical resolution, in texels: the side of the maps at which 95% of the points have at most one pixel
    /// per texel.
    pub critical: f64,
    /// Geometric mean of the groups' critical resolutions, in texels.
    pub critical_mean: f64,
    /// Percentage of a map's area that visible points need.
    pub used: f64,
    /// Mean movement of points in their map between frames, without whole texels, in texels.
    pub shimmer: f64,
    /// Percentage of points that move by less than 0.02 texels and whose texels keep their size.
    pub still: f64,
    /// Percentage of the points in the previous frame's view that read the same texels in both frames.
    pub kept: f64,
    /// Mean relative change of a texel's side between frames, in per cent.
    pub scale: f64,
    /// Mean depth step of a 24-bit map, in micrometres along the light.
    pub depth: f64,
    /// Titles and values of further columns, of judged pictures. Empty if no pictures were drawn.
    pub pictures: Vec<(&'static str, f64)>,
}

/// The sums of a scene under one light.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupTally {
    /// Name of the scene.
    pub scene: String,
    /// Name of the group, such as `town/45`.
    pub group: String,
    /// Sums of its frames.
    pub tally: Tally,
    /// Sums of its judged pictures.
    pub pictures: PictureTally,
}

/// All rows of a fit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitTable {
    /// Name of the fit.
    pub peer: String,
    /// Time of one frame's fit, in nanoseconds, from the fit file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_fit: Option<f64>,
    /// All frames pooled.
    pub overall: Row,
    /// A row for each scene, in the order measured.
    #[serde(serialize_with = "as_map")]
    pub scenes: Vec<(String, Row)>,
    /// A row for each scene under one light, in the order measured.
    #[serde(serialize_with = "as_map")]
    pub groups: Vec<(String, Row)>,
}

impl Row {
    /// Returns the pooled row of several groups.
    pub fn pooled<'a>(groups: impl Iterator<Item = &'a GroupTally>) -> Self {
        let (mut pool, mut pictures) = (Tally::default(), PictureTally::default());
        let mut log2_criticals = Vec::new();
        for group in groups {
            pool.merge(&group.tally);
            pictures.merge(&group.pictures);
            log2_criticals.push(log2_critical(&group.tally));
        }
        let mean = log2_criticals.iter().sum::<f64>() / log2_criticals.len() as f64;
        Self { critical_mean: mean.exp2(), ..Self::of(&pool, &pictures) }
    }

    /// Returns the row of one group.
    pub fn of(tally: &Tally, pictures: &PictureTally) -> Self {
        let ratio = |part: f64, whole: u64| part / whole as f64;
        let percentage = |part: u64, whole: u64| 100.0 * ratio(part as f64, whole);
        let critical = log2_critical(tally).exp2();
        Self {
            maps: ratio(tally.maps as f64, tally.frames),
            uncovered: percentage(tally.uncovered, tally.facing),
            lost: percentage(tally.lost, tally.shadowed),
            lost_unclamped: percentage(tally.lost_unclamped, tally.shadowed),
            error: [0.5, 0.95, 0.99].map(|q| tally.pixels_per_texel.log2_quantile(q).unwrap_or(f64::NAN)),
            undersampled: percentage(tally.undersampled, tally.pixels_per_texel.total()),
            critical,
            critical_mean: critical,
            used: 100.0 * ratio(tally.used, tally.maps),
            shimmer: ratio(tally.shimmer.moved, tally.shimmer.points),
            still: percentage(tally.shimmer.still, tally.shimmer.points),
            kept: percentage(tally.kept.kept, tally.kept.points),
            scale: 100.0 * ratio(tally.shimmer.scaled, tally.shimmer.points),
            depth: 1e6 * ratio(tally.depth_range, tally.covered()) / DEPTH_STEPS,
            pictures: picture_columns(pictures),
        }
    }

    /// Returns titles and values of the columns.
    pub fn columns(&self) -> Vec<(&'static str, f64)> {
        let mut columns = vec![
            ("maps", self.maps),
            ("uncov %", self.uncovered),
            ("lost %", self.lost),
            ("lost unclamped %", self.lost_unclamped),
            ("err p50", self.error[0]),
            ("p95", self.error[1]),
            ("p99", self.error[2]),
            ("under %", self.undersampled),
            ("crit res", self.critical),
            ("crit gm", self.critical_mean),
            ("used %", self.used),
            ("shimmer tx", self.shimmer),
            ("still %", self.still),
            ("kept %", self.kept),
            ("scale %", self.scale),
            ("depth um", self.depth),
        ];
        columns.extend(&self.pictures);
        columns
    }
}

/// Returns the columns of judged pictures, except uncovered points, which the fit has itself.
fn picture_columns(pictures: &PictureTally) -> Vec<(&'static str, f64)> {
    if pictures.frames == 0 {
        return Vec::new();
    }
    pictures.columns().into_iter().filter(|(name, _)| *name != "uncov %").collect()
}

impl Serialize for Row {
    /// Writes a map from column names to values, with `null` for values that are not finite.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let columns = self.columns();
        let mut map = serializer.serialize_map(Some(columns.len()))?;
        for (name, value) in columns {
            map.serialize_entry(name, &value)?;
        }
        map.end()
    }
}

impl FitTable {
    /// Computes the rows of a fit from the sums of its groups.
    pub fn new(peer: &str, ns_per_fit: Option<f64>, groups: &[GroupTally]) -> Self {
        let mut scenes: Vec<(String, Row)> = Vec::new();
        for GroupTally { scene, .. } in groups {
            if scenes.iter().all(|(known, _)| known != scene) {
                let own = groups.iter().filter(|group| group.scene == *scene);
                scenes.push((scene.clone(), Row::pooled(own)));
            }
        }
        Self {
            peer: peer.to_owned(),
            ns_per_fit,
            overall: Row::pooled(groups.iter()),
            scenes,
            groups: groups.iter().map(|group| (group.group.clone(), Row::of(&group.tally, &group.pictures))).collect(),
        }
    }
}

/// Returns tables of fits as JSON: `{"fits": [{"peer": .., "overall": {column: value}, "scenes": {..},
/// "groups": {..}}]}`.
///
/// # Panics
///
/// Never: numbers and names can always be written.
pub fn to_json(tables: &[FitTable]) -> String {
    let root = BTreeMap::from([("fits", tables)]);
    serde_json::to_string_pretty(&root).expect("numbers and names can be written") + "\n"
}

/// Returns tables of fits as Markdown: all frames, each scene, and critical resolutions of the groups.
pub fn to_markdown(tables: &[FitTable]) -> String {
    let mut text = format!("## Overall\n\n{}", overall_markdown(tables));
    for (scene, _) in tables.iter().flat_map(|table| &table.scenes).take(tables.first().map_or(0, |t| t.scenes.len())) {
        let rows = tables.iter().filter_map(|table| Some((table.peer.clone(), find(&table.scenes, scene)?.clone())));
        let _ = write!(text, "\n## {scene}\n\n{}", rows_markdown(rows.collect()));
    }
    let _ = write!(text, "\n## Critical resolution per scene and light elevation\n\n{}", groups_markdown(tables));
    text
}

/// Returns the rows over all frames as a Markdown table.
pub fn overall_markdown(tables: &[FitTable]) -> String {
    rows_markdown(tables.iter().map(|table| (table.peer.clone(), table.overall.clone())).collect())
}

fn rows_markdown(rows: Vec<(String, Row)>) -> String {
    let Some((_, first)) = rows.first() else { return String::new() };
    let names = first.columns().into_iter().map(|(name, _)| name.to_owned());
    let cells = |row: Row| row.columns().into_iter().map(|(name, value)| cell(name, value)).collect();
    of_peers(names, rows.into_iter().map(|(peer, row)| (peer, cells(row))))
}

fn groups_markdown(tables: &[FitTable]) -> String {
    let Some(first) = tables.first() else { return String::new() };
    let names = first.groups.iter().map(|(name, _)| name.clone());
    let cells = |table: &FitTable| table.groups.iter().map(|(_, row)| cell("crit res", row.critical)).collect();
    of_peers(names, tables.iter().map(|table| (table.peer.clone(), cells(table))))
}

fn of_peers(names: impl Iterator<Item = String>, rows: impl Iterator<Item = (String, Vec<String>)>) -> String {
    let columns: Vec<String> = iter::once("peer".to_owned()).chain(names).collect();
    markdown_table(&columns, rows.map(|(peer, cells)| [vec![peer], cells].concat()))
}

/// Returns a readable number: whole texels, otherwise as [`readable`].
fn cell(column: &str, value: f64) -> String {
    if column.starts_with("crit") && value.is_finite() { format!("{value:.0}") } else { readable(value) }
}

fn find<'a>(rows: &'a [(String, Row)], name: &str) -> Option<&'a Row> {
    rows.iter().find(|(known, _)| known == name).map(|(_, row)| row)
}

fn log2_critical(tally: &Tally) -> f64 {
    tally.critical.log2_quantile(CRITICAL_QUANTILE).unwrap_or(f64::NAN)
}

fn as_map<S: Serializer>(rows: &[(String, Row)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(rows.iter().map(|(name, row)| (name, row)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a group of one point with 2^`octaves` pixels per texel, in a map of one texel.
    fn group(scene: &str, group: &str, octaves: i32) -> GroupTally {
        let mut tally = Tally { frames: 1, maps: 1, facing: 4, uncovered: 1, ..Tally::default() };
        tally.pixels_per_texel.add(f64::from(octaves).exp2());
        tally.critical.add(f64::from(octaves).exp2());
        GroupTally { scene: scene.to_owned(), group: group.to_owned(), tally, pictures: PictureTally::default() }
    }

    #[test]
    fn numbers_have_three_digits_and_at_most_four_decimals() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (-1e-9, "0"),
            (0.00094, "0.0009"),
            (0.0392, "0.0392"),
            (-0.2461, "-0.246"),
            (2.5, "2.5"),
        ];
        let more = [(9.004, "9"), (40.66, "40.7"), (99.96, "100"), (119.2, "119"), (1234.5, "1234")];
        for (value, text) in cases.into_iter().chain(more) {
            assert_eq!(cell("used %", value), text, "{value}");
        }
        assert_eq!(cell("crit gm", 460_308.4), "460308");
        assert_eq!(cell("crit res", f64::INFINITY), "inf");
        assert_eq!(cell("still %", f64::NAN), "-");
    }

    #[test]
    fn rows_pool_points_and_only_the_geometric_mean_is_over_groups() {
        let table = FitTable::new("a", None, &[group("x", "x/1", 2), group("x", "x/2", 4), group("y", "y/1", 9)]);
        let middle = 0.5 / 128.0;
        let log2 = |value: f64| value.log2() - middle;
        assert!(
            (log2(table.overall.critical) - 9.0).abs() < 1e-12
                && (log2(table.overall.critical_mean) - 5.0).abs() < 1e-12
        );
        assert_eq!(table.overall.error, [4.0 + middle, 9.0 + middle, 9.0 + middle]);
        assert_eq!((table.overall.uncovered, table.overall.maps), (25.0, 1.0));
        assert!((log2(table.scenes[0].1.critical_mean) - 3.0).abs() < 1e-12);
        assert_eq!(table.scenes.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["x", "y"]);
    }

    #[test]
    fn json_has_the_names_of_the_columns_and_null_for_what_was_not_there() {
        let json = to_json(&[FitTable::new("a", Some(3.0), &[group("x", "x/1", 2)])]);
        let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        let row = &value["fits"][0]["groups"]["x/1"];
        assert_eq!((row["uncov %"].as_f64(), row["maps"].as_f64()), (Some(25.0), Some(1.0)));
        assert!(row["shimmer tx"].is_null() && row["lost %"].is_null());
        assert_eq!(value["fits"][0]["ns_per_fit"].as_f64(), Some(3.0));
    }

    #[test]
    fn markdown_has_a_table_for_all_for_each_scene_and_for_the_groups() {
        let groups = [group("x", "x/1", 2), group("y", "y/1", 3)];
        let text = to_markdown(&[FitTable::new("a", None, &groups), FitTable::new("b", None, &groups)]);
        let headings: Vec<_> = text.lines().filter(|line| line.starts_with("##")).collect();
        assert_eq!(headings, ["## Overall", "## x", "## y", "## Critical resolution per scene and light elevation"]);
        assert!(text.ends_with("| peer | x/1 | y/1 |\n|---|---:|---:|\n| a | 4 | 8 |\n| b | 4 | 8 |\n"), "{text}");
        assert_eq!(to_markdown(&[]).lines().filter(|line| line.starts_with('|')).count(), 0);
    }
}

//! The changes that a search tries, one at a time, in rounds: those that matter most come first.

use shadowfit::Technique;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitKind, HoldSettings, ReceiverSource, RectangleKind, SplitScheme, Stabilise,
};

use super::TuneScope;

/// A change that may help.
pub(super) struct Change {
    pub(super) what: String,
    pub(super) apply: Box<dyn Fn(&mut Technique)>,
}

impl Change {
    pub(super) fn new(what: impl Into<String>, apply: impl Fn(&mut Technique) + 'static) -> Self {
        Self { what: what.into(), apply: Box::new(apply) }
    }
}

/// The changes that are tried on a technique, round by round.
pub(super) fn rounds(start: &Technique, scope: TuneScope) -> Vec<Vec<Change>> {
    match scope {
        TuneScope::Everything => everything(start.count),
        // A soft filter is chosen for its looks.
        TuneScope::BiasAndFilter if start.filter.is_soft() => vec![biases(), fine_biases()],
        TuneScope::BiasAndFilter => vec![biases(), filters(), fine_biases(), filters()],
    }
}

fn everything(count: u32) -> Vec<Vec<Change>> {
    let mut rounds = vec![fits(), biases(), filters()];
    if count > 1 {
        rounds.push(splits());
        rounds.push(counts(count));
    }
    rounds.extend([stillness(), rectangles(), fine_biases(), filters()]);
    rounds
}

fn fits() -> Vec<Change> {
    let kinds = [
        ("boxes of the frustum's slices", FitKind::FrustumAabb, ReceiverSource::Clusters),
        ("least rectangles of the frustum", FitKind::Oriented, ReceiverSource::Clusters),
        ("spheres around the frustum's slices", FitKind::Sphere, ReceiverSource::Clusters),
        ("least rectangles around the objects in view", FitKind::Focused, ReceiverSource::Objects),
        ("least rectangles around the clusters in view", FitKind::Focused, ReceiverSource::Clusters),
        ("windows where the picture needs them", FitKind::Windows, ReceiverSource::Clusters),
    ];
    let change = |(what, kind, receivers)| {
        Change::new(what, move |technique: &mut Technique| {
            technique.fit.kind = kind;
            technique.receivers = receivers;
        })
    };
    kinds.into_iter().map(change).collect()
}

fn biases() -> Vec<Change> {
    vec![
        Change::new("the automatic bias", |technique| technique.bias = BiasSettings::automatic(technique.filter)),
        Change::new("an offset along the normal", |technique| {
            technique.bias = BiasSettings::automatic_normal_offset(technique.filter, &technique.softness);
        }),
        Change::new("no bias", |technique| {
            technique.bias =
                BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
        }),
    ]
}

/// Filters whose widths are numbers of texels, each with the bias of the present kind that it needs. The truth has a
/// hard sun, so soft filters only add noise.
fn filters() -> Vec<Change> {
    let filters = [
        ("one comparison", FilterKind::Point),
        ("2×2 comparison", FilterKind::Hardware2x2),
        ("a tent of 3×3", FilterKind::Pcf3x3),
        ("a tent of 5×5", FilterKind::Pcf5x5),
        ("a tent of 7×7", FilterKind::Pcf7x7),
    ];
    let change = |(what, filter): (&str, FilterKind)| {
        Change::new(what, move |technique: &mut Technique| {
            let softness = technique.softness;
            let offset = |filter| BiasSettings::automatic_normal_offset(filter, &softness);
            if technique.bias == BiasSettings::automatic(technique.filter) {
                technique.bias = BiasSettings::automatic(filter);
            } else if technique.bias == offset(technique.filter) {
                technique.bias = offset(filter);
            }
            technique.filter = filter;
        })
    };
    filters.into_iter().map(change).collect()
}

fn splits() -> Vec<Change> {
    let schemes = [
        ("uniform splits", SplitScheme::Uniform),
        ("practical splits, 0.8", SplitScheme::Practical(0.8)),
        ("logarithmic splits", SplitScheme::Logarithmic),
        ("splits from the boxes", SplitScheme::FromBoxes),
        ("splits from what the frame before showed", SplitScheme::FromHistogram),
    ];
    let change = |(what, splits)| Change::new(what, move |technique: &mut Technique| technique.splits = splits);
    schemes.into_iter().map(change).collect()
}

/// A number of maps in words.
pub(super) fn maps(count: u32) -> String {
    if count == 1 { "1 map".to_owned() } else { format!("{count} maps") }
}

fn counts(most: u32) -> Vec<Change> {
    let fewer = (1..most).rev().take(2);
    let change =
        |count| Change::new(format!("{} only", maps(count)), move |technique: &mut Technique| technique.count = count);
    fewer.map(change).collect()
}

fn stillness() -> Vec<Change> {
    vec![
        Change::new("maps fitted anew in each frame", |technique| technique.stabilise = Stabilise::Off),
        Change::new("maps on a grid of whole texels", |technique| technique.stabilise = Stabilise::Snap),
        Change::new("maps held from frame to frame", |technique| technique.stabilise = Stabilise::Hysteresis),
        Change::new("maps held longer", |technique| technique.hold = HoldSettings::default().with_waste(3.0)),
        Change::new("maps held for a shorter time", |technique| {
            technique.hold = HoldSettings::default().with_waste(1.3).with_growth(1.2);
        }),
    ]
}

fn rectangles() -> Vec<Change> {
    let kinds = [
        ("rectangles along the light's axes", RectangleKind::AxisAligned),
        ("least squares instead of rectangles", RectangleKind::MinimumSquare),
    ];
    let change = |(what, kind)| Change::new(what, move |technique: &mut Technique| technique.fit.rectangle = kind);
    kinds.into_iter().map(change).collect()
}

/// Small moves away from the bias that is provably enough.
fn fine_biases() -> Vec<Change> {
    let scaled = |what: &str, scale: f32| {
        Change::new(what, move |technique: &mut Technique| {
            technique.bias.receiver_plane *= scale;
            technique.bias.normal_offset *= scale;
        })
    };
    vec![
        scaled("half the bias", 0.5),
        scaled("three quarters of the bias", 0.75),
        scaled("one and a half times the bias", 1.5),
        Change::new("a constant bias of half a texel", |technique| technique.bias.constant = 0.5),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the recommended technique has already.
    const RECOMMENDED: [&str; 5] = [
        "windows where the picture needs them",
        "the automatic bias",
        "a tent of 5×5",
        "splits from what the frame before showed",
        "maps held from frame to frame",
    ];

    #[test]
    fn every_change_but_those_to_what_is_already_so_makes_another_technique() {
        let start = Technique::default();
        let changes: Vec<Change> = rounds(&start, TuneScope::Everything).into_iter().flatten().collect();
        assert!(changes.len() > 20, "{}", changes.len());
        for change in changes {
            let mut changed = start;
            (change.apply)(&mut changed);
            assert_eq!(changed == start, RECOMMENDED.contains(&change.what.as_str()), "{}", change.what);
        }
    }

    #[test]
    fn bias_and_filter_change_nothing_else_and_a_soft_filter_stays() {
        let soft = Technique::default().with_filter(FilterKind::Pcss);
        for (start, filters) in [(Technique::default().with_count(3).with_resolution(512, 256), 5), (soft, 1)] {
            let mut seen = vec![start.filter];
            for change in rounds(&start, TuneScope::BiasAndFilter).into_iter().flatten() {
                let mut changed = start;
                (change.apply)(&mut changed);
                seen.push(changed.filter);
                assert_eq!(changed.with_look_up(start.filter, start.bias), start, "{}", change.what);
            }
            seen.sort_by_key(|filter| *filter as u32);
            seen.dedup();
            assert_eq!(seen.len(), filters);
        }
    }

    #[test]
    fn a_change_of_the_filter_takes_the_bias_along() {
        let mut technique = Technique { bias: BiasSettings::automatic(FilterKind::Pcf3x3), ..Technique::default() };
        (filters()[0].apply)(&mut technique);
        assert_eq!((technique.filter, technique.bias), (FilterKind::Point, BiasSettings::automatic(FilterKind::Point)));
    }
}

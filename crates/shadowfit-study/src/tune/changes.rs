//! The changes that a search tries, one at a time, in rounds. The most effective ones come first.

use shadowfit::settings::{BiasSettings, FilterKind, Hysteresis, RectangleKind, SplitScheme, Stabilise};
use shadowfit::{Maps, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Kind, Value, parameter};

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

    /// Creates a change of the maps only.
    fn to_maps(what: impl Into<String>, change: impl Fn(Maps) -> Maps + 'static) -> Self {
        Self::new(what, move |technique| technique.maps = change(technique.maps))
    }
}

/// Returns the changes to try on a technique, round by round.
pub(super) fn rounds(start: &Technique, scope: TuneScope) -> Vec<Vec<Change>> {
    match scope {
        TuneScope::Everything => everything(start.maps.count()),
        // A soft filter was chosen for its looks, so it stays.
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

/// Returns the options of a choice in the parameter table, each with a function that applies it to a
/// technique.
fn options(id: &str) -> impl DoubleEndedIterator<Item = (String, impl Fn(Technique) -> Technique + Copy + 'static)> {
    let row = parameter(id).expect("a row of the table");
    let Kind::Choice(options) = row.kind else { unreachable!("{id} is a choice") };
    options.iter().enumerate().map(move |(index, option)| {
        let with_option = move |technique| {
            let mut settings = Settings::default().with_technique(technique);
            row.set(&mut settings, Value::Option(index));
            settings.technique
        };
        (format!("{}: {}", row.label, option.label), with_option)
    })
}

/// Returns all fits, the best ones last, except fits that must match their source exactly.
fn fits() -> Vec<Change> {
    let all = options("fit.kind").rev();
    all.filter(|(_, with_fit)| !with_fit(Technique::default()).maps.are_exact())
        .map(|(what, with_fit)| Change::to_maps(what, move |maps| with_fit(Technique::default().with_maps(maps)).maps))
        .collect()
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

/// Returns filters whose widths are in texels, each with the bias that it needs, of the current kind. The
/// truth has a hard sun, so soft filters would only add noise.
fn filters() -> Vec<Change> {
    let all = options("map.filter").map(|(what, with_filter)| (what, with_filter(Technique::default()).filter));
    let change = |(what, filter): (String, FilterKind)| {
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
    all.filter(|(_, filter)| !filter.is_soft()).map(change).collect()
}

fn splits() -> Vec<Change> {
    let schemes = [
        ("uniform splits", SplitScheme::Uniform),
        ("practical splits, 0.8", SplitScheme::Practical(0.8)),
        ("logarithmic splits", SplitScheme::Logarithmic),
        ("splits from the boxes", SplitScheme::FromBoxes),
        ("splits from the visible demand", SplitScheme::FromHistogram),
    ];
    let change = |(what, splits)| {
        Change::to_maps(what, move |maps| match maps {
            Maps::Cascades(cascades) => cascades.with_splits(splits).into(),
            others => others,
        })
    };
    schemes.into_iter().map(change).collect()
}

/// Returns a number of maps in words.
pub(super) fn maps(count: u32) -> String {
    if count == 1 { "1 map".to_owned() } else { format!("{count} maps") }
}

fn counts(most: u32) -> Vec<Change> {
    let fewer = (1..most).rev().take(2);
    let change = |count| Change::to_maps(format!("{} only", maps(count)), move |maps| maps.with_count(count));
    fewer.map(change).collect()
}

fn stillness() -> Vec<Change> {
    let held = Hysteresis::default();
    let modes = [
        ("maps fitted independently in each frame", Stabilise::Off),
        ("maps on a grid of whole texels", Stabilise::Snap { max_oversize: held.max_oversize }),
        ("maps held from frame to frame", Stabilise::Hysteresis(held)),
        ("maps held longer", Stabilise::Hysteresis(held.with_max_oversize(3.0))),
        ("maps held for a shorter time", Stabilise::Hysteresis(held.with_max_oversize(1.3).with_max_growth(1.2))),
    ];
    let change = |(what, stabilise)| {
        Change::to_maps(what, move |maps| match maps {
            Maps::Windows(_) => maps,
            Maps::Cascades(_) | Maps::Single(_) => maps.with_stabilise(stabilise),
        })
    };
    modes.into_iter().map(change).collect()
}

fn rectangles() -> Vec<Change> {
    let kinds = [
        ("rectangles along the light's axes", RectangleKind::AxisAligned),
        ("least squares instead of rectangles", RectangleKind::MinimumSquare),
    ];
    let change = |(what, kind)| {
        Change::to_maps(what, move |maps| match maps.shape() {
            Some(shape) => maps.with_shape(shape.with_rectangle(kind)),
            None => maps,
        })
    };
    kinds.into_iter().map(change).collect()
}

/// Returns small changes from the bias that is provably sufficient.
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
    use shadowfit::Cascades;

    use super::*;

    /// Options that cascades already have.
    const OF_SLICES: [&str; 5] = [
        "Fit: Focused on the scene",
        "the automatic bias",
        "Filter: PCF 5×5",
        "splits from the visible demand",
        "maps held from frame to frame",
    ];

    #[test]
    fn every_change_but_those_to_what_is_already_so_makes_another_technique() {
        let start = Technique::default().with_maps(Cascades::default());
        let changes: Vec<Change> = rounds(&start, TuneScope::Everything).into_iter().flatten().collect();
        assert!(changes.len() > 20, "{}", changes.len());
        for change in changes {
            let mut changed = start;
            (change.apply)(&mut changed);
            assert_eq!(changed == start, OF_SLICES.contains(&change.what.as_str()), "{}", change.what);
        }
    }

    #[test]
    fn splits_rectangles_and_stillness_of_windows_are_not_tried() {
        let start = Technique::default();
        for change in splits().into_iter().chain(stillness()).chain(rectangles()) {
            let mut changed = start;
            (change.apply)(&mut changed);
            assert_eq!(changed, start, "{}", change.what);
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

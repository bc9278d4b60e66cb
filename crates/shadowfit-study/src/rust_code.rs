//! A technique as Rust code, to be pasted into an engine.

use std::fmt::Write;

use shadowfit::settings::BiasSettings;
use shadowfit::{CascadeSettings, FitSettings, HoldSettings, SplitScheme};

use crate::Technique;

impl Technique {
    /// Statements that define `maps`, `bias` and `filter` as this technique has them: what is as by default is left
    /// out. They need `shadowfit::*`, `shadowfit::glam::UVec2` and nothing else.
    pub fn to_rust(&self) -> String {
        let mut code = String::new();
        let fit = fields(&[
            differs("kind", self.maps.fit.kind, default_fit().kind, "FitKind"),
            differs("rectangle", self.maps.fit.rectangle, default_fit().rectangle, "RectangleKind"),
            number("max_distance", self.maps.fit.max_distance, default_fit().max_distance),
            number("margin", self.maps.fit.margin, default_fit().margin),
            number("kernel_margin", self.maps.fit.kernel_margin, default_fit().kernel_margin),
            differs("casters", self.maps.fit.casters, default_fit().casters, "CasterPolicy"),
            number("caster_extension", self.maps.fit.caster_extension, default_fit().caster_extension),
            resolution(&self.maps.fit),
            differs("depth", self.maps.fit.depth, default_fit().depth, "DepthConvention"),
        ]);
        let default = CascadeSettings::default();
        let maps = fields(&[
            Some(format!("fit: {}", literal("FitSettings", &fit))),
            (self.maps.count != default.count).then(|| format!("count: {}", self.maps.count)),
            (self.maps.splits != default.splits).then(|| format!("splits: {}", splits(&self.maps.splits))),
            number("overlap", self.maps.overlap, default.overlap),
            differs("stabilise", self.maps.stabilise, default.stabilise, "Stabilise"),
            hold(&self.maps.hold),
        ]);
        let BiasSettings { constant, slope, normal_offset, receiver_plane } = self.bias;
        let bias = format!(
            "BiasSettings {{ constant: {constant:?}, slope: {slope:?}, normal_offset: {normal_offset:?}, \
             receiver_plane: {receiver_plane:?} }}"
        );
        let _ = writeln!(code, "let maps = {};", literal("CascadeSettings", &maps));
        let _ = writeln!(code, "let bias = {bias};");
        let _ = writeln!(code, "let filter = FilterKind::{:?};", self.filter);
        code
    }
}

fn default_fit() -> FitSettings {
    FitSettings::default()
}

fn fields(all: &[Option<String>]) -> String {
    all.iter().flatten().cloned().collect::<Vec<_>>().join(", ")
}

/// A struct with some fields, and the rest as by default.
fn literal(name: &str, fields: &str) -> String {
    if fields.is_empty() { format!("{name}::default()") } else { format!("{name} {{ {fields}, ..{name}::default() }}") }
}

/// A field that is a plain variant of an enum.
fn differs<T: Copy + PartialEq + std::fmt::Debug>(field: &str, value: T, default: T, ty: &str) -> Option<String> {
    (value != default).then(|| format!("{field}: {ty}::{value:?}"))
}

fn number(field: &str, value: f32, default: f32) -> Option<String> {
    let text = if value == f32::MAX { "f32::MAX".to_owned() } else { format!("{value:?}") };
    (value != default).then(|| format!("{field}: {text}"))
}

fn resolution(fit: &FitSettings) -> Option<String> {
    let [x, y] = fit.resolution.to_array();
    (fit.resolution != default_fit().resolution).then(|| format!("resolution: UVec2::new({x}, {y})"))
}

fn splits(splits: &SplitScheme) -> String {
    format!("SplitScheme::{splits:?}")
}

fn hold(hold: &HoldSettings) -> Option<String> {
    let default = HoldSettings::default();
    let own = fields(&[
        number("margin", hold.margin, default.margin),
        number("growth", hold.growth, default.growth),
        number("waste", hold.waste, default.waste),
        (hold.horizon != default.horizon).then(|| format!("horizon: {}", hold.horizon)),
    ]);
    (*hold != default).then(|| format!("hold: {}", literal("HoldSettings", &own)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec2;
    use shadowfit::{CasterPolicy, DepthConvention, FilterKind, FitKind, RectangleKind, Stabilise};

    fn changed() -> Technique {
        let fit = FitSettings {
            kind: FitKind::Oriented,
            rectangle: RectangleKind::MinimumSquare,
            max_distance: f32::MAX,
            margin: 0.25,
            kernel_margin: 4.0,
            casters: CasterPolicy::List,
            caster_extension: 7.0,
            resolution: UVec2::new(1024, 512),
            depth: DepthConvention::Reversed,
            ..FitSettings::default()
        };
        let maps = CascadeSettings {
            fit,
            count: 3,
            splits: SplitScheme::Practical(0.8),
            overlap: 0.1,
            stabilise: Stabilise::Hysteresis,
            hold: HoldSettings { margin: 0.5, waste: 3.0, horizon: 9, ..HoldSettings::default() },
            ..CascadeSettings::default()
        };
        let bias = BiasSettings { constant: 0.1, slope: 0.2, normal_offset: 0.3, receiver_plane: 1.5 };
        Technique { maps, bias, filter: FilterKind::Pcf3x3, ..Technique::default() }
    }

    #[test]
    fn the_code_of_a_technique_compiles_and_makes_the_same_settings() {
        use shadowfit::*;
        let (maps, bias, filter) = include!("rust_code_sample.txt");
        let changed = changed();
        assert_eq!((maps, bias, filter), (changed.maps, changed.bias, changed.filter));
        let sample = format!("{{\n{}(maps, bias, filter)\n}}\n", changed.to_rust());
        assert_eq!(include_str!("rust_code_sample.txt"), sample);
    }

    #[test]
    fn the_code_of_the_default_settings_is_short() {
        let maps = CascadeSettings::default();
        let fit = FitSettings::default();
        let technique = Technique { maps: CascadeSettings { fit, ..maps }, ..Technique::default() };
        let code = technique.to_rust();
        assert!(
            code.starts_with(
                "let maps = CascadeSettings { fit: FitSettings::default(), ..CascadeSettings::default() };\n"
            ),
            "{code}"
        );
    }
}

//! A technique as Rust code to paste into an engine.

use alloc::borrow::ToOwned as _;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write as _;

use shadowfit::{PRESETS, Technique};

use crate::field::Code;
use crate::technique_parameters;

/// The field for the kind of the maps, which is written as a whole.
const MAPS: &str = "maps";

/// Returns Rust statements that make a technique: the default one or the nearest preset, and a line for each
/// field that differs from it. They need `use shadowfit::{*, glam::UVec2, settings::*};`.
///
/// ```
/// use shadowfit::Technique;
/// use shadowfit::settings::MapFormat;
///
/// let code = "\
/// let mut technique = Technique::default().with_maps(Windows { count: 3, ..Windows::default() });
/// technique.format = MapFormat::R32Float;
/// ";
/// let made = Technique::default().with_count(3).with_format(MapFormat::R32Float);
/// assert_eq!(shadowfit_params::to_rust(&made), code);
/// ```
pub fn to_rust(technique: &Technique) -> String {
    let default = ("Technique::default()".to_owned(), Technique::default());
    let preset = |name| format!("Technique::preset({name:?}).expect(\"a preset of shadowfit\")");
    let presets = PRESETS.iter().map(|made| (preset(made.name), made.technique()));
    // Of several equally near ones, the first one is taken. The default comes first.
    let starts = [default].into_iter().chain(presets);
    let nearest = starts.map(|(code, start)| (code, lines(technique, &start))).min_by_key(|(_, lines)| lines.len());
    let (start, lines) = nearest.unwrap_or_default();
    let (maps, others): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(path, _)| *path == MAPS);
    let maps = maps.first().map_or_else(String::new, |(_, value)| format!(".with_maps({value})"));
    let mutable = if others.is_empty() { "" } else { "mut " };
    let mut code = format!("let {mutable}technique = {start}{maps};\n");
    for (path, value) in others {
        // Writing to a String cannot fail.
        let _ = writeln!(code, "technique.{path} = {value};");
    }
    code
}

/// Returns the paths of the fields that differ between two techniques, with their values in `technique` as
/// code.
fn lines(technique: &Technique, start: &Technique) -> Vec<(&'static str, String)> {
    let mut lines: Vec<(&'static str, String)> = Vec::new();
    for Code { path, expression } in technique_parameters().filter_map(|parameter| parameter.field.code) {
        let value = expression(technique);
        let is_written = lines.iter().any(|(written, _)| *written == path);
        if !is_written && value != expression(start) {
            lines.push((path, value));
        }
    }
    lines
}

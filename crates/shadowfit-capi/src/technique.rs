//! Techniques by name and as text: the TOML of technique files, line by line and without allocations.
//!
//! ```text
//! [splits]
//! count = 3
//! [map]
//! filter = "pcf_3x3"
//! ```

use core::ffi::{CStr, c_char};

use shadowfit::settings::{CasterPolicy, MapSelection};
use shadowfit::{PRESETS, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Group, Kind, PARAMETERS, Value, parameter, set_value};
use toml_parser::decoder::{Encoding, IntegerRadix, ScalarKind, StringBuilder};
use toml_parser::lexer::Token;
use toml_parser::parser::{EventReceiver, parse_document};
use toml_parser::{ErrorSink, ParseError, Source, Span};

use crate::error::{Failure, ShadowfitResult as Code};
use crate::types::ShadowfitTechnique;
use crate::view::depth_number;

/// Returns the preset with a name.
pub(crate) fn preset(name: &str) -> Result<Technique, Failure> {
    PRESETS.iter().find(|preset| preset.name == name).map(shadowfit::Preset::technique).ok_or_else(|| {
        Failure::new(
            Code::ShadowfitUnknownPreset,
            format_args!("there is no preset {name:?}; shadowfit_preset lists them, such as {:?}", PRESETS[0].name),
        )
    })
}

/// Returns the name of a preset by its index, or `None` behind the last one.
pub(crate) fn preset_name(index: usize) -> Option<&'static CStr> {
    const NAMES: [&CStr; 10] = [
        c"xna-1",
        c"aabb-1",
        c"oriented-1",
        c"focused-1",
        c"stable-4",
        c"focused-4",
        c"calm-4",
        c"windows-8",
        c"exact-4",
        c"windows-4",
    ];
    NAMES.get(index).copied()
}

/// Greatest number of parameters that a text may set: all.
const MAX_ENTRIES: usize = 128;

/// Greatest number of tokens in a line. A setting has fewer than ten.
const MAX_TOKENS: usize = 64;

/// A value of the text.
#[derive(Clone, Copy)]
struct Entry {
    value: Word,
    line: usize,
}

/// A key or a value, without quotes. Every key and option is shorter. Longer words are cut off and end with an ellipsis,
/// which no valid word has.
#[derive(Clone, Copy)]
struct Word {
    bytes: [u8; Self::CAPACITY],
    length: usize,
}

impl Word {
    const CAPACITY: usize = 48;
    const EMPTY: Self = Self { bytes: [0; Self::CAPACITY], length: 0 };

    fn as_str(&self) -> &str {
        core::str::from_utf8(&self.bytes[..self.length]).unwrap_or_default()
    }

    fn push(&mut self, text: &str) {
        const ELLIPSIS: &str = "…";
        let most = Self::CAPACITY - ELLIPSIS.len();
        let end = text.floor_char_boundary(most.saturating_sub(self.length));
        for part in [&text[..end], if end < text.len() { ELLIPSIS } else { "" }] {
            if let Some(free) = self.bytes.get_mut(self.length..self.length + part.len()) {
                free.copy_from_slice(part.as_bytes());
                self.length += part.len();
            }
        }
    }
}

impl StringBuilder<'_> for Word {
    fn clear(&mut self) {
        self.length = 0;
    }

    fn push_str(&mut self, text: &str) -> bool {
        self.push(text);
        true
    }

    fn push_char(&mut self, letter: char) -> bool {
        self.push(letter.encode_utf8(&mut [0; 4]));
        true
    }
}

/// Returns a technique with the parameters that a text sets. All others keep their values.
pub(crate) fn with_text(technique: &Technique, text: &str) -> Result<Technique, Failure> {
    let mut file = File { group: None, entries: [None; MAX_ENTRIES] };
    for (line, text) in (1..).zip(text.lines()) {
        file.read(line, text)?;
    }
    let mut settings = Settings::default().with_technique(*technique);
    // In the order of the parameter table, so that a scheme comes before the numbers that only it has.
    for (parameter, entry) in PARAMETERS.iter().zip(&file.entries) {
        let Some(Entry { value, line, .. }) = entry else { continue };
        set_value(&mut settings, parameter, value.as_str()).map_err(|rejected| failure(*line, rejected))?;
    }
    Ok(settings.technique)
}

/// The values of a text, in the order of the parameter table.
struct File {
    group: Option<Group>,
    entries: [Option<Entry>; MAX_ENTRIES],
}

impl File {
    /// Reads a line: a header, a value, or neither.
    fn read(&mut self, number: usize, text: &str) -> Result<(), Failure> {
        let source = Source::new(text);
        let mut lexer = source.lex();
        let Some(first) = lexer.next() else { return Ok(()) };
        let mut tokens: [Token; MAX_TOKENS] = [first; MAX_TOKENS];
        let mut count = 1;
        for token in lexer {
            let free = tokens.get_mut(count).ok_or_else(|| failure(number, "the line is too long"))?;
            (*free, count) = (token, count + 1);
        }
        let mut line = Line { source, path: [Word::EMPTY; 2], depth: 0, is_header: false, value: None };
        let mut error: Option<ParseError> = None;
        parse_document(&tokens[..count], &mut line, &mut error);
        if let Some(error) = error {
            return Err(failure(number, error.description()));
        }
        if line.is_header {
            return self.open(number, &line);
        }
        let Some(value) = line.value else { return Ok(()) };
        self.set(number, &line, value)
    }

    /// Begins a table.
    fn open(&mut self, number: usize, line: &Line) -> Result<(), Failure> {
        if line.depth != 1 {
            return Err(failure(number, "a header has one word, such as [map]"));
        }
        let name = line.path[0].as_str();
        let group = groups().find(|group| group.id() == name);
        let names = |index: usize| groups().nth(index).map(Group::id);
        let group = group
            .ok_or_else(|| failure(number, format_args!("there is no group {name:?}; there are {}", Names(names))))?;
        self.group = Some(group);
        Ok(())
    }

    /// Sets a value.
    fn set(&mut self, number: usize, line: &Line, value: Word) -> Result<(), Failure> {
        let [first, second] = [line.path[0].as_str(), line.path[1].as_str()];
        let [group, key] = match (self.group, line.depth) {
            // Technique files have a name and a summary before their tables.
            (None, 1) if matches!(first, "name" | "summary") => return Ok(()),
            (Some(group), 1) => [group.id(), first],
            (None, 2) => [first, second],
            (None, 1) => ["", first],
            _ => return Err(failure(number, format_args!("the key {first}.{second} has too many words"))),
        };
        let found = PARAMETERS.iter().position(|parameter| parameter.id.split_once('.') == Some((group, key)));
        let index = found
            .filter(|index| groups().any(|group| group == PARAMETERS[*index].group))
            .ok_or_else(|| unknown(number, group, key))?;
        let parameter = &PARAMETERS[index];
        let entry = &mut self.entries[index.min(MAX_ENTRIES - 1)];
        if let Some(earlier) = entry {
            return Err(failure(number, format_args!("{} is already set in line {}", parameter.id, earlier.line)));
        }
        // The boxes of a fit are in its input. Files of the tools also choose between several lists.
        if parameter.group.is_technique() {
            *entry = Some(Entry { value, line: number });
        }
        Ok(())
    }
}

/// Returns the groups of technique files.
fn groups() -> impl Iterator<Item = Group> {
    Group::ALL.into_iter().filter(|group| group.is_technique() || *group == Group::Input)
}

fn failure(line: usize, text: impl core::fmt::Display) -> Failure {
    Failure::new(Code::ShadowfitBadTechnique, format_args!("line {line}: {text}"))
}

/// Returns the error for a key that no group has.
fn unknown(line: usize, group: &str, key: &str) -> Failure {
    let Some(known) = groups().find(|known| known.id() == group) else {
        return failure(line, format_args!("{key:?} is in no group; write it under a header such as [map]"));
    };
    let name = |index: usize| known.parameters().nth(index).and_then(|row| row.id.split_once('.')).map(|(_, key)| key);
    failure(line, format_args!("there is no parameter {group}.{key}; under [{group}] there are {}", Names(name)))
}

/// Names by their index, separated by commas.
struct Names<F>(F);

impl<F: Fn(usize) -> Option<&'static str>> core::fmt::Display for Names<F> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        for index in 0.. {
            let Some(name) = (self.0)(index) else { break };
            f.write_str(if index == 0 { "" } else { ", " })?;
            f.write_str(name)?;
        }
        Ok(())
    }
}

/// The parts of a line.
struct Line<'a> {
    source: Source<'a>,
    /// First two parts of the header or key.
    path: [Word; 2],
    /// Number of parts.
    depth: usize,
    is_header: bool,
    value: Option<Word>,
}

impl Line<'_> {
    fn refuse(span: Span, error: &mut dyn ErrorSink) {
        error.report_error(
            ParseError::new("a value is a number, a text in quotes, true or false").with_unexpected(span),
        );
    }
}

impl EventReceiver for Line<'_> {
    fn std_table_open(&mut self, _: Span, _: &mut dyn ErrorSink) {
        self.is_header = true;
    }

    fn array_table_open(&mut self, span: Span, error: &mut dyn ErrorSink) {
        error.report_error(ParseError::new("a header has single brackets, such as [map]").with_unexpected(span));
    }

    fn inline_table_open(&mut self, span: Span, error: &mut dyn ErrorSink) -> bool {
        Self::refuse(span, error);
        false
    }

    fn array_open(&mut self, span: Span, error: &mut dyn ErrorSink) -> bool {
        Self::refuse(span, error);
        false
    }

    fn simple_key(&mut self, span: Span, encoding: Option<Encoding>, error: &mut dyn ErrorSink) {
        let Some(raw) = self.source.get(span) else { return };
        let mut key = Word::EMPTY;
        toml_parser::Raw::new_unchecked(raw.as_str(), encoding, span).decode_key(&mut key, error);
        if let Some(part) = self.path.get_mut(self.depth) {
            *part = key;
        }
        self.depth += 1;
    }

    fn scalar(&mut self, span: Span, encoding: Option<Encoding>, error: &mut dyn ErrorSink) {
        let Some(raw) = self.source.get(span) else { return };
        let mut value = Word::EMPTY;
        let raw = toml_parser::Raw::new_unchecked(raw.as_str(), encoding, span);
        let kind = raw.decode_scalar(&mut value, error);
        if matches!(kind, ScalarKind::Integer(radix) if radix != IntegerRadix::Dec) {
            error.report_error(ParseError::new("write numbers in decimal").with_unexpected(span));
        }
        self.value = Some(value);
    }
}

/// Returns the parts of a technique that create textures and choose shaders.
pub(crate) fn written(technique: &Technique) -> ShadowfitTechnique {
    let selection = technique.maps.selection();
    let settings = Settings::default().with_technique(*technique);
    ShadowfitTechnique {
        size: size_of::<ShadowfitTechnique>() as u32,
        map_count: technique.maps.count(),
        resolution: technique.fit.resolution.to_array(),
        depth: depth_number(technique.fit.depth),
        clamps_depth: u32::from(crate::casters::policy(technique) == CasterPolicy::DepthClamp),
        by_view_depth: u32::from(matches!(selection, MapSelection::ViewDepth { .. })),
        blend: selection.blend(),
        filter_radius: technique.filter_radius(),
        filter: option(&settings, "map.filter"),
        format: option(&settings, "map.format"),
    }
}

/// Returns the id of a parameter's option, as technique files write it.
fn option(settings: &Settings, id: &str) -> [c_char; NAME] {
    let mut name = [0; NAME];
    let Some(parameter) = parameter(id) else { return name };
    let (Kind::Choice(options), Some(Value::Option(index))) = (&parameter.kind, parameter.get(settings)) else {
        return name;
    };
    let id = options.get(index).map_or("", |option| option.id);
    for (letter, byte) in name.iter_mut().zip(id.bytes()).take(NAME - 1) {
        *letter = byte.cast_signed();
    }
    name
}

/// Length of a name with its zero byte.
const NAME: usize = 24;

#[cfg(test)]
mod tests {
    use shadowfit::settings::FilterKind;

    use super::*;

    fn refused(text: &str) -> String {
        let failure = with_text(&Technique::default(), text).map(|_| ()).expect_err(text);
        failure.text.as_c_str().to_string_lossy().into_owned()
    }

    #[test]
    fn the_names_of_presets_filters_and_formats_are_those_of_the_other_crates() {
        for (index, preset) in PRESETS.iter().enumerate() {
            assert_eq!(preset_name(index).expect("a name").to_str(), Ok(preset.name));
        }
        assert_eq!(preset_name(PRESETS.len()), None);
        for id in ["map.filter", "map.format"] {
            let Kind::Choice(options) = parameter(id).expect("a parameter").kind else { panic!("options") };
            for (index, wanted) in options.iter().enumerate() {
                let mut settings = Settings::default();
                parameter(id).expect("a parameter").set(&mut settings, Value::Option(index));
                let name = option(&settings, id).map(c_char::cast_unsigned);
                let text = CStr::from_bytes_until_nul(&name).expect("a zero byte");
                assert_eq!(text.to_str(), Ok(wanted.id));
            }
        }
    }

    #[test]
    fn a_text_sets_the_parameters_that_it_names_in_any_order_and_keeps_the_others() {
        let text = "name = \"mine\\n\"\nsummary = 'x'\nbias.slope = 1_0.5\r\n\n# a comment\n[splits]\nlambda = 0.25 # after\nscheme = \
                    \"practical\"\n[\"map\"]\nfilter = \"pcf_3x3\"\n[input]\nboxes = \"objects\"\n";
        let start = preset("calm-4").unwrap_or_default().with_resolution(512, 512);
        let read = with_text(&start, text).map_err(|failure| failure.text.as_c_str().to_owned()).expect("valid");
        assert_eq!(
            (read.bias.slope, read.filter, read.fit.resolution),
            (10.5, FilterKind::Pcf3x3, start.fit.resolution)
        );
        assert!(format!("{:?}", read.maps).contains("Practical(0.25)"));
    }

    #[test]
    fn the_list_of_parameters_is_the_default_technique_and_names_them_all() {
        let list = include_str!("../technique.toml");
        let read = with_text(&preset("calm-4").unwrap_or_default(), list)
            .map_err(|failure| failure.text.as_c_str().to_owned());
        assert_eq!(read.expect("valid"), Technique::default());
        for parameter in shadowfit_params::technique_parameters() {
            let key = parameter.id.split_once('.').expect("a group").1;
            assert!(list.contains(&format!("\n{key} = ")) || list.contains(&format!("`{key}`")), "{key}");
        }
    }

    #[test]
    fn a_wrong_text_names_line_and_key() {
        for (text, words) in [
            ("[bias]\nbent = 1", &["line 2", "bias.bent", "slope"][..]),
            ("\n\ncolour = 1", &["line 3", "colour", "[map]"]),
            ("[sun]", &["line 1", "sun", "splits"]),
            ("[light]\nelevation = 30", &["line 1", "light"]),
            ("[map]\nresolution = 64", &["line 2", "map.resolution", "64"]),
            ("[map]\nfilter = \"blur\"", &["line 2", "map.filter", "blur", "pcf_5x5"]),
            ("[map]\nfilter = pcf", &["line 2"]),
            ("[map]\n\nfade = 0.1\nfade = 0.2", &["line 4", "map.fade", "line 3"]),
            ("[splits]\nlambda = 0.5", &["line 2", "splits.lambda"]),
            ("[bias]\nslope = nan", &["line 2", "bias.slope"]),
            ("[map]\nfade = [[[[1]]]]", &["line 2", "number"]),
            ("[map]\nfade = {a = 1}", &["line 2", "number"]),
            ("[[map]]", &["line 1", "brackets"]),
            ("[map", &["line 1"]),
            ("[map]\nfade =", &["line 2"]),
            ("[map]\nfade", &["line 2"]),
            ("[map.fade]\nx = 1", &["line 1", "one word"]),
            ("map.fade.x = 1", &["line 1", "map.fade", "too many"]),
            ("[map]\nsplits.count = 3", &["line 2", "splits.count", "too many"]),
            ("[map]\nfilter = \"pcf_3x3", &["line 2"]),
            ("[map]\nfilter = 'pcf_3x3", &["line 2"]),
            ("[map]\nresolution = 0x400", &["line 2", "decimal"]),
            ("[map]\nresolution = 0o2000", &["line 2", "decimal"]),
            (
                "[map]\nthe_key_of_a_person_who_likes_to_write_very_long_names = 1",
                &["line 2", "map.the_key_of", "filter"],
            ),
            ("[map]\nfade = 0.1000000000000000000000000000000000000000000000000001", &["line 2", "map.fade"]),
            ("[map]\n\"res\\u0000olution\" = 1", &["line 2", "map.res?olution", "filter"]),
        ] {
            let error = refused(text);
            assert!(words.iter().all(|word| error.contains(word)), "{text}: {error}");
        }
        assert!(refused(&". ".repeat(1000)).contains("too long"));
    }
}

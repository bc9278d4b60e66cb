//! The tables of a run, as Markdown for people and JSON for programs.
//!
//! Techniques are rows. The best value of each column is bold, to show the trade-offs.

use std::fmt::Write;
use std::iter;

use anyhow::Result;

use crate::markdown::{markdown_table, readable};
use crate::run::{Better, Columns, Run, better};

/// Heading of the list of scene parts that import skipped, replaced or repaired.
pub(crate) const SCENE_NOTES: &str = "Notes on the scene";

/// Text of a value, and whether it is the best of its column. Unequal numbers with equal texts are equally
/// good.
type Cell = (String, bool);

/// A table of techniques.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Table {
    pub(crate) title: String,
    pub(crate) columns: Vec<String>,
    /// Name of each technique and its cells.
    pub(crate) rows: Vec<(String, Vec<Cell>)>,
}

/// Returns the tables of a run: all frames, then each group.
pub(crate) fn tables(run: &Run) -> Vec<Table> {
    let overall = run.techniques.iter().map(|technique| (technique.name.as_str(), Some(&technique.overall)));
    let mut tables = vec![table("All frames", &overall.collect::<Vec<_>>())];
    let mut groups: Vec<&String> = Vec::new();
    for (group, _) in run.techniques.iter().flat_map(|technique| &technique.groups) {
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    for group in groups {
        let rows = run.techniques.iter().map(|technique| {
            let columns = technique.groups.iter().find(|(known, _)| known == group).map(|(_, columns)| columns);
            (technique.name.as_str(), columns)
        });
        tables.push(table(group, &rows.collect::<Vec<_>>()));
    }
    tables
}

/// Returns all data of a run as JSON, with keys in the order of fields and columns. Values that are not
/// numbers are `null`.
///
/// # Errors
///
/// Only if memory runs out.
pub fn to_json(run: &Run) -> Result<String> {
    Ok(serde_json::to_string_pretty(run)? + "\n")
}

/// Returns the run's facts and tables as Markdown.
pub fn to_markdown(run: &Run) -> String {
    let mut text = format!("# {}\n\n", escape(&run.title));
    if !run.finished {
        let _ = writeln!(text, "**Stopped early:** {}\n", stopped(run));
    }
    for (name, value) in facts(run) {
        let _ = writeln!(text, "- {name}: {}", escape(&value));
    }
    for note in &run.notes {
        let _ = writeln!(text, "- {}", escape(note));
    }
    if !run.scene_notes.is_empty() {
        let _ = write!(text, "\n## {SCENE_NOTES}\n\n");
        for note in &run.scene_notes {
            let _ = writeln!(text, "- {}", escape(note));
        }
    }
    for table in tables(run) {
        let _ = write!(text, "\n## {}\n\n{}", escape(&table.title), markdown(&table));
    }
    text.push_str("\n## Techniques\n");
    for technique in &run.techniques {
        let (name, what) = (escape(&technique.name), escape(&technique.what));
        let fence = "`".repeat(longest_fence(&technique.settings).max(2) + 1);
        let _ = write!(text, "\n### {name}\n\n{what}\n\n{fence}toml\n{}\n{fence}\n", technique.settings.trim_end());
    }
    text
}

/// Returns the facts that a reader needs before the numbers of a run.
pub(crate) fn facts(run: &Run) -> Vec<(&'static str, String)> {
    let [width, height] = run.size;
    let mut facts = vec![
        ("Scene", format!("{}, {} triangles", run.scene, grouped(run.triangles))),
        ("Pictures", format!("{} frames of {width} × {height} pixels", run.frames.len())),
    ];
    if let Some(light) = &run.light {
        let [azimuth, elevation] = [light.azimuth, light.elevation].map(f32::to_degrees);
        facts.push(("Sun", format!("{elevation:.0}° above the horizon, from {azimuth:.0}°")));
    }
    facts.push(("Adapter", run.adapter.clone()));
    facts
}

/// Returns the note about a run that was stopped early.
pub(crate) fn stopped(run: &Run) -> String {
    format!("the figures cover the {} frames that were measured before.", run.frames.len())
}

fn table(title: &str, rows: &[(&str, Option<&Columns>)]) -> Table {
    let mut columns: Vec<String> = Vec::new();
    for (name, _) in rows.iter().filter_map(|(_, columns)| *columns).flatten() {
        if !columns.contains(name) {
            columns.push(name.clone());
        }
    }
    let value = |row: Option<&Columns>, name: &String| {
        row.and_then(|row| row.iter().find(|(known, _)| known == name)).map_or(f64::NAN, |(_, value)| *value)
    };
    let best: Vec<Option<String>> =
        columns.iter().map(|name| best(name, rows.iter().map(|(_, row)| value(*row, name)))).collect();
    let cells = |row: Option<&Columns>| {
        let cell = |(name, best): (&String, &Option<String>)| {
            let text = readable(value(row, name));
            let is_best = best.as_ref() == Some(&text);
            (text, is_best)
        };
        columns.iter().zip(&best).map(cell).collect()
    };
    let rows = rows.iter().map(|(name, row)| ((*name).to_owned(), cells(*row))).collect();
    Table { title: title.to_owned(), columns, rows }
}

/// Returns the text of a column's best value, or `None` if there is no difference.
fn best(column: &str, values: impl Iterator<Item = f64>) -> Option<String> {
    let mut values: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
    values.sort_by(f64::total_cmp);
    let (first, last) = (readable(*values.first()?), readable(*values.last()?));
    match better(column) {
        _ if first == last => None,
        Better::Lower => Some(first),
        Better::Higher => Some(last),
        Better::Neither => None,
    }
}

fn markdown(table: &Table) -> String {
    let columns: Vec<String> =
        iter::once("technique").chain(table.columns.iter().map(String::as_str)).map(escape).collect();
    let cell = |(text, best): &Cell| if *best { format!("**{text}**") } else { text.clone() };
    let rows = table.rows.iter().map(|(name, cells)| iter::once(escape(name)).chain(cells.iter().map(cell)).collect());
    markdown_table(&columns, rows)
}

/// Returns a whole number with spaces between its thousands.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let first = digits.len() % 3;
    let rest = digits.as_bytes()[first..].chunks(3).map(|chunk| String::from_utf8_lossy(chunk).into_owned());
    let head = (first > 0).then(|| digits[..first].to_owned());
    head.into_iter().chain(rest).collect::<Vec<_>>().join(" ")
}

/// Escapes text for one line of Markdown.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' => escaped.extend(['\\', character]),
            '&' => escaped.push_str("&amp;"),
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(character),
        }
    }
    escaped
}

/// Returns the length of the longest run of backticks. A fence around the text must be longer.
fn longest_fence(text: &str) -> usize {
    text.split(|character| character != '`').map(str::len).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::tests::run;

    #[test]
    fn the_best_value_of_a_column_is_bold_where_there_is_a_difference_that_matters() {
        let text = to_markdown(&run());
        let rows: Vec<_> = text.lines().filter(|line| line.starts_with('|')).take(4).collect();
        assert_eq!(
            rows,
            [
                "| technique | wrong % | false light % | maps | crawl % |",
                "|---|---:|---:|---:|---:|",
                "| xna | 12 | **0.25** | 4 | - |",
                "| focused \\| best | **3** | 1 | 1 | - |",
            ]
        );
    }

    #[test]
    fn markdown_has_a_table_for_all_and_for_each_group_and_the_settings() {
        let text = to_markdown(&run());
        let headings: Vec<_> = text.lines().filter(|line| line.starts_with('#')).collect();
        let techniques = ["## Techniques", "### xna", "### focused \\| best"];
        assert_eq!(
            headings,
            [
                &["# Courtyard \\<1\\>", "## Notes on the scene", "## All frames", "## orbit", "## fly-through"],
                &techniques[..]
            ]
            .concat()
        );
        assert!(text.contains("1 234 567 triangles") && text.contains("A note &amp; more."), "{text}");
        assert!(
            text.contains("```toml\nkind = \"Sphere\"\nmargin = 0.1\n```\n") && !text.contains("Stopped"),
            "{text}"
        );
    }

    #[test]
    fn markdown_lists_the_notes_on_the_scene_and_has_no_heading_for_none() {
        let text = to_markdown(&run());
        let list = "## Notes on the scene\n\n- images\\[0\\]: replaced by a placeholder\n- points \\<skipped\\>\n\n";
        assert!(text.contains(list), "{text}");
        let text = to_markdown(&Run { scene_notes: Vec::new(), ..run() });
        assert!(!text.contains("Notes on the scene"), "{text}");
    }

    #[test]
    fn a_run_that_was_stopped_says_so_first() {
        let text = to_markdown(&Run { finished: false, ..run() });
        assert!(text.starts_with("# Courtyard \\<1\\>\n\n**Stopped early:** the figures cover the 5 frames"), "{text}");
    }

    #[test]
    fn json_holds_all_data_with_columns_in_order_and_null_for_what_is_not_there() {
        let json = to_json(&run()).expect("JSON");
        let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert_eq!(value["scene_notes"][1], "points <skipped>");
        let technique = &value["techniques"][1];
        assert_eq!(technique["frames"][2]["wrong %"], 3.0);
        assert!(technique["groups"]["fly-through"]["crawl %"].is_null());
        let places = ["\"wrong %\"", "\"false light %\"", "\"maps\"", "\"crawl %\""].map(|key| json.find(key));
        assert!(places.is_sorted() && places[0].is_some(), "{json}");
    }

    #[test]
    fn runs_without_techniques_or_groups_have_empty_tables() {
        let empty = Run { techniques: Vec::new(), frames: Vec::new(), ..run() };
        assert_eq!(tables(&empty).len(), 1);
        assert!(to_markdown(&empty).contains("## All frames") && to_json(&empty).is_ok());
    }
}

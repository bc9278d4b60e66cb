//! Merges variants of a text into one, with the preprocessor's conditions around the items that differ.

use anyhow::{Result, ensure};

use super::translate::Item;

/// A choice that changes some items.
pub(super) struct Axis {
    /// Alternatives: the preprocessor's condition, and all items of the text in this case. One alternative is the
    /// default of the file, and so is one of each other axis.
    pub(super) alternatives: Vec<(String, Vec<Item>)>,
}

/// Alternative forms of a run of items: the conditions that any of them chooses it, and the text.
type Chain = Vec<(Vec<String>, String)>;

/// Returns a text that has each item of any alternative, in an order that all of them share.
///
/// # Errors
/// If an item differs along two axes.
pub(super) fn merge(axes: &[Axis]) -> Result<String> {
    let mut text = String::new();
    let mut open: Chain = Vec::new();
    for name in order(axes) {
        let (same, mut differing): (Vec<Chain>, Vec<Chain>) = axes
            .iter()
            .map(|axis| chain(axis, name))
            .filter(|chain| !chain.is_empty())
            .partition(|chain| chain.len() == 1 && chain[0].0.is_empty());
        ensure!(differing.len() < 2, "{name} differs along two axes");
        let Some(next) = differing.pop().or_else(|| same.into_iter().next()) else { continue };
        let is_same_choice = open.len() == next.len() && open.iter().zip(&next).all(|(a, b)| a.0 == b.0);
        if is_same_choice {
            for ((_, part), (_, more)) in open.iter_mut().zip(next) {
                *part += &separated(&more);
            }
        } else {
            text += &written(&std::mem::replace(&mut open, next));
        }
    }
    Ok(text + &written(&open))
}

/// Returns the names of all items. An item that some alternatives lack comes after the item that precedes it there.
fn order(axes: &[Axis]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for (_, items) in axes.iter().flat_map(|axis| &axis.alternatives) {
        let mut at = 0;
        for item in items {
            if let Some(place) = names.iter().position(|name| *name == item.name) {
                at = place + 1;
            } else {
                names.insert(at, &item.name);
                at += 1;
            }
        }
    }
    names
}

/// Returns the forms of an item along an axis. Overloads of a name count as one item.
fn chain(axis: &Axis, name: &str) -> Chain {
    let mut chain: Chain = Vec::new();
    let mut lacking = Vec::new();
    for (condition, items) in &axis.alternatives {
        let text = items.iter().filter(|item| item.name == name).map(|item| separated(&item.text)).collect::<String>();
        let text = text.trim_start_matches('\n').to_owned();
        if text.is_empty() {
            lacking.push(condition.clone());
            continue;
        }
        match chain.iter_mut().find(|(_, form)| *form == text) {
            Some((conditions, _)) => conditions.push(condition.clone()),
            None => chain.push((vec![condition.clone()], text)),
        }
    }
    if lacking.is_empty() {
        // The last form needs no condition.
        if let Some((conditions, _)) = chain.last_mut() {
            conditions.clear();
        }
    }
    chain
}

/// Returns an item's text, with an empty line before it unless it is a single line.
fn separated(text: &str) -> String {
    if text.lines().count() == 1 { text.to_owned() } else { format!("\n{text}") }
}

/// Returns the forms with their conditions.
fn written(chain: &Chain) -> String {
    let mut text = String::new();
    for (index, (conditions, form)) in chain.iter().enumerate() {
        let condition = conditions.join(" || ");
        let directive = match (index, condition.is_empty()) {
            (0, true) => return separated(form),
            (0, false) => format!("\n#if {condition}\n"),
            (_, false) => format!("#elif {condition}\n"),
            (_, true) => "#else\n".to_owned(),
        };
        text += &directive;
        text += form.trim_start_matches('\n');
    }
    if !text.is_empty() {
        text += "#endif\n";
    }
    text
}

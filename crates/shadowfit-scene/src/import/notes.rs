//! Readable notes about elements that import skipped, replaced or repaired.

use std::collections::BTreeMap;

/// Notes stored as text. Further notes are only counted, so that a broken file cannot fill the memory.
const MAX_NOTES: usize = 64;

/// Kinds of repair that can affect many elements. Each gets one note with the number of elements.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Tally {
    /// Triangles without area.
    ZeroAreaTriangles,
    /// Normals that were zero or not finite.
    RepairedNormals,
    /// Texture coordinates that were not finite.
    RepairedUvs,
    /// Primitives without normals.
    ComputedNormals,
}

impl Tally {
    fn sentence(self, count: usize) -> String {
        let what = match self {
            Self::ZeroAreaTriangles => "triangles without area dropped",
            Self::RepairedNormals => "unusable normals recomputed",
            Self::RepairedUvs => "texture coordinates that are not finite set to 0",
            Self::ComputedNormals => "primitives without normals given flat ones",
        };
        format!("{what}: {count}")
    }
}

/// Collects notes.
#[derive(Default)]
pub(crate) struct Notes {
    lines: Vec<String>,
    left_out: usize,
    tallies: BTreeMap<Tally, usize>,
}

impl Notes {
    /// Adds a note, unless it was added before.
    pub(crate) fn add(&mut self, note: impl Into<String>) {
        let note = note.into();
        if self.lines.len() >= MAX_NOTES {
            self.left_out += 1;
        } else if !self.lines.contains(&note) {
            self.lines.push(note);
        }
    }

    /// Adds to a sum.
    pub(crate) fn count(&mut self, tally: Tally, count: usize) {
        if count > 0 {
            *self.tallies.entry(tally).or_default() += count;
        }
    }

    /// Returns all notes, sums last.
    pub(crate) fn finish(self) -> Vec<String> {
        let mut lines = self.lines;
        if self.left_out > 0 {
            lines.push(format!("{} more notes left out", self.left_out));
        }
        lines.extend(self.tallies.into_iter().map(|(tally, count)| tally.sentence(count)));
        lines
    }
}

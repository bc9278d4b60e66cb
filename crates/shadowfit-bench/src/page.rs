//! Replaces the tables of `docs/BENCHMARKS.md`, each between two marks.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use shadowfit_study::write_whole;

/// The page, relative to the workspace.
const PAGE: &str = "docs/BENCHMARKS.md";
/// Folder of the page's curves, relative to the workspace.
const CURVES: &str = "docs/images/benchmarks";

/// A place for tables in the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Core,
    Gpu,
    Growth,
}

impl Section {
    /// The marks before and after the tables.
    fn marks(self) -> [&'static str; 2] {
        match self {
            Self::Core => ["<!-- measured: begin -->", "<!-- measured: end -->"],
            Self::Gpu => ["<!-- measured on a GPU: begin -->", "<!-- measured on a GPU: end -->"],
            Self::Growth => ["<!-- measured growth: begin -->", "<!-- measured growth: end -->"],
        }
    }

    /// Replaces the tables of the page.
    ///
    /// # Errors
    ///
    /// When the page cannot be read or written, or lacks the marks.
    pub(crate) fn publish(self, tables: &str) -> Result<()> {
        let page = root().join(PAGE);
        let text = fs::read_to_string(&page).with_context(|| format!("{}: cannot be read", page.display()))?;
        let replaced = self.replaced(&text, tables).with_context(|| page.display().to_string())?;
        write_whole(&page, replaced.as_bytes())
    }

    fn replaced(self, page: &str, tables: &str) -> Result<String> {
        let [begin, end] = self.marks();
        let (before, rest) = page.split_once(begin).with_context(|| format!("it has no {begin}"))?;
        let (_, after) = rest.split_once(end).with_context(|| format!("it has no {end}"))?;
        Ok(format!("{before}{begin}\n{}\n{end}{after}", tables.trim_end()))
    }
}

/// The folder of the page's curves.
pub(crate) fn curves() -> PathBuf {
    root().join(CURVES)
}

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_replaced_between_their_marks_alone() {
        let page = "a\n<!-- measured growth: begin -->\nold\n<!-- measured growth: end -->\nb\n";
        let replaced = Section::Growth.replaced(page, "| new |\n\n").expect("a page with marks");
        assert_eq!(replaced, page.replace("old", "| new |"));
        assert!(Section::Gpu.replaced(page, "").is_err());
    }

    #[test]
    fn the_page_has_the_marks_of_all_sections() {
        let page = fs::read_to_string(root().join(PAGE)).expect("the page");
        for section in [Section::Core, Section::Gpu, Section::Growth] {
            assert!(section.replaced(&page, "").is_ok(), "{section:?}");
        }
    }
}

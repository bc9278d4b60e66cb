//! Writes the tables into files of `docs/figures`.

use std::path::{Path, PathBuf};

use anyhow::Result;
use shadowfit_study::write_whole;

/// Folder of the files, relative to the workspace.
const FOLDER: &str = "docs/figures";
/// Folder of the curves, relative to the workspace.
const CURVES: &str = "docs/images/benchmarks";

/// A file of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Core,
    Gpu,
    Growth,
}

impl Section {
    /// Returns the file's name.
    fn file(self) -> &'static str {
        match self {
            Self::Core => "core.md",
            Self::Gpu => "gpu.md",
            Self::Growth => "growth.md",
        }
    }

    /// Returns the file's title and the command that writes it.
    fn head(self) -> [&'static str; 2] {
        match self {
            Self::Core => ["Times of the core crate", "cargo xtask bench"],
            Self::Gpu => ["Times on a GPU", "cargo xtask bench --gpu"],
            Self::Growth => ["Growth with the size of the world", "cargo xtask bench --growth"],
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    ///
    /// If it cannot be written.
    pub(crate) fn publish(self, tables: &str) -> Result<()> {
        write_whole(&root().join(FOLDER).join(self.file()), self.page(tables).as_bytes())
    }

    fn page(self, tables: &str) -> String {
        let [title, command] = self.head();
        format!("# {title}\n\nWritten by `{command}`.\n\n{}\n", tables.trim_end())
    }
}

/// Returns the folder of the curves.
pub(crate) fn curves() -> PathBuf {
    root().join(CURVES)
}

/// Returns the folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn the_files_in_the_docs_begin_as_they_are_written() {
        for section in [Section::Core, Section::Gpu, Section::Growth] {
            let file = root().join(FOLDER).join(section.file());
            let text = fs::read_to_string(&file).expect("a file of the docs");
            assert!(text.starts_with(section.page("").trim_end()), "{}", file.display());
        }
    }
}

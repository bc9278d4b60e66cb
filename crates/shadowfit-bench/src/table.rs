//! Tables of measurements.

use core::fmt;

use shadowfit_report::markdown_table;

/// A table with a heading and a sentence that explains it.
#[derive(Debug)]
pub(crate) struct Table {
    pub(crate) title: &'static str,
    pub(crate) note: String,
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "### {}\n\n{}\n", self.title, self.note)?;
        f.write_str(&markdown_table(&self.columns, self.rows.iter().cloned()))
    }
}

/// Returns a time with three digits, in milliseconds.
pub(crate) fn ms(time: f64) -> String {
    let decimals = if time < 1.0 { 3 } else { 2 };
    format!("{time:.decimals$} ms")
}

/// Returns a time as a share of another.
pub(crate) fn share(time: f64, of: f64) -> String {
    format!("{:.2}", time / of)
}

//! The options of command lines that choose the adapter.

use crate::AdapterChoice;

/// Options of a command line that choose the adapter.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AdapterOptions {
    /// Graphics adapter: `any` for the fastest one, `software`, or a part of its name. A name that no adapter has lists the
    /// adapters of this machine.
    #[arg(long, value_name = "NAME", default_value_t)]
    adapter: AdapterChoice,

    /// Draws with the software adapter even if there is a GPU: short for `--adapter software`.
    #[arg(long, conflicts_with = "adapter")]
    software: bool,
}

impl AdapterOptions {
    /// Returns the chosen adapter.
    pub fn choice(&self) -> AdapterChoice {
        if self.software { AdapterChoice::Software } else { self.adapter.clone() }
    }
}

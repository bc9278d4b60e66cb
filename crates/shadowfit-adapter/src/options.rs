//! The options of command lines that choose the adapter.

use crate::AdapterChoice;

/// Options of a command line that choose the adapter. Without them, the environment variable `SHADOWFIT_ADAPTER` chooses it.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct AdapterOptions {
    /// Graphics adapter: `any` for the fastest one, `software`, or a part of its name. A name that no adapter has lists the
    /// adapters of this machine. If not given, the environment variable `SHADOWFIT_ADAPTER` names it, or else it is `any`.
    #[arg(long, value_name = "NAME")]
    adapter: Option<AdapterChoice>,

    /// Draws with the software adapter even if there is a GPU: short for `--adapter software`.
    #[arg(long, conflicts_with = "adapter")]
    software: bool,
}

impl AdapterOptions {
    /// Returns the chosen adapter.
    pub fn choice(&self) -> AdapterChoice {
        self.choice_or(AdapterChoice::from_env)
    }

    fn choice_or(&self, from_env: impl FnOnce() -> Option<AdapterChoice>) -> AdapterChoice {
        if self.software {
            return AdapterChoice::Software;
        }
        self.adapter.clone().or_else(from_env).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        adapter: AdapterOptions,
    }

    #[test]
    fn an_option_wins_over_the_environment_and_the_environment_over_the_fastest_adapter() {
        let named = |name: &str| AdapterChoice::Named(name.into());
        let set = Some(named("radeon"));
        for (words, variable, chosen) in [
            (&[][..], None, AdapterChoice::Any),
            (&[], set.clone(), named("radeon")),
            (&["--adapter", "nvidia"], set.clone(), named("nvidia")),
            (&["--adapter", "any"], set.clone(), AdapterChoice::Any),
            (&["--software"], set, AdapterChoice::Software),
        ] {
            let line = Line::try_parse_from(["program"].iter().chain(words)).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(line.adapter.choice_or(|| variable), chosen, "{words:?}");
        }
    }
}

//! Ctrl-C: the first press ends a run early with a report, a second one ends it at once.
//!
//! A run over a long path takes minutes, and its finished frames are worth keeping.

use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Context, Result};
use shadowfit_study::tell;

/// Exit code after Ctrl-C: 128 and the number of the signal, by the convention of shells.
pub(crate) const INTERRUPTED: u8 = 130;

/// Flag that Ctrl-C was pressed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt {
    pressed: Arc<AtomicU32>,
}

/// The effect of a press of Ctrl-C.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    FinishFrame,
    EndNow,
}

impl Interrupt {
    /// Installs the handler of Ctrl-C for the rest of the program.
    ///
    /// # Errors
    ///
    /// If another handler is already installed.
    pub(crate) fn install() -> Result<Self> {
        let interrupt = Self::default();
        let own = interrupt.clone();
        ctrlc::set_handler(move || match own.press() {
            Answer::FinishFrame => tell("stopping after this frame; Ctrl-C again ends at once, without a report"),
            Answer::EndNow => process::exit(i32::from(INTERRUPTED)),
        })
        .context("cannot install a handler for Ctrl-C")?;
        Ok(interrupt)
    }

    /// Returns whether to stop after this frame.
    pub(crate) fn is_requested(&self) -> bool {
        self.pressed.load(Ordering::Relaxed) > 0
    }

    fn press(&self) -> Answer {
        if self.pressed.fetch_add(1, Ordering::Relaxed) == 0 { Answer::FinishFrame } else { Answer::EndNow }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_press_asks_to_stop_and_the_second_ends() {
        let interrupt = Interrupt::default();
        let seen_by_run = interrupt.clone();
        assert!(!seen_by_run.is_requested());
        assert_eq!(interrupt.press(), Answer::FinishFrame);
        assert!(seen_by_run.is_requested());
        assert_eq!(interrupt.press(), Answer::EndNow);
    }
}

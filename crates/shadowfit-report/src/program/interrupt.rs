//! Ctrl-C: the first one asks a run to write what it has, a second one ends it at once.
//!
//! A run over a long path takes minutes, and the frames that are measured by then are worth keeping.

use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use anyhow::{Context, Result};
use shadowfit_study::tell;

/// Exit code of a program that Ctrl-C ended: 128 and the number of the signal, as shells count.
pub(crate) const INTERRUPTED: u8 = 130;

/// Whether somebody pressed Ctrl-C.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt {
    pressed: Arc<AtomicU32>,
}

/// What a press of Ctrl-C does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    FinishFrame,
    EndNow,
}

impl Interrupt {
    /// Takes over Ctrl-C for the rest of the program.
    ///
    /// # Errors
    ///
    /// When something else in the program already has.
    pub(crate) fn install() -> Result<Self> {
        let interrupt = Self::default();
        let own = interrupt.clone();
        ctrlc::set_handler(move || match own.press() {
            Answer::FinishFrame => tell("stopping after this frame; Ctrl-C again ends at once, without a report"),
            Answer::EndNow => process::exit(i32::from(INTERRUPTED)),
        })
        .context("Ctrl-C cannot be watched for")?;
        Ok(interrupt)
    }

    /// Whether to stop after this frame.
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

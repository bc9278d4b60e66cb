//! Text for the standard output and the standard error. `println!` panics if it cannot write. Programs that
//! use these functions exit cleanly instead.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

use anyhow::{Context, Result};

/// Writes text to the standard output. A closed pipe, as after `head`, is not an error.
///
/// # Errors
///
/// If the text cannot be written for another reason, such as a full disk.
pub fn print(text: impl Display) -> Result<()> {
    print_to(&mut io::stdout().lock(), text)
}

fn print_to(output: &mut impl Write, text: impl Display) -> Result<()> {
    match write!(output, "{text}").and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(error).context("cannot write to the standard output")
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

/// Writes a line to the standard error. Ignores failures.
pub fn tell(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An output whose writes fail.
    struct Broken(ErrorKind);

    impl Write for Broken {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_closed_pipe_is_no_error_and_a_full_disk_is_one() {
        let mut text = Vec::new();
        print_to(&mut text, "two\nlines\n").expect("memory has room");
        assert_eq!(text, b"two\nlines\n");
        print_to(&mut Broken(ErrorKind::BrokenPipe), "text").expect("nobody reads it");
        let error = print_to(&mut Broken(ErrorKind::StorageFull), "text").expect_err("a full disk");
        assert!(format!("{error:#}").contains("cannot write to the standard output: "), "{error:#}");
    }
}

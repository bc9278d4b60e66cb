//! The codes that all functions return, and the text of the last error.

use core::ffi::CStr;
use core::fmt::{self, Write};

/// Result of a function. shadowfit_error returns a sentence about the last failure.
#[allow(missing_docs, clippy::enum_variant_names, reason = "the names of C constants")]
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowfitResult {
    ShadowfitOk = 0,
    ShadowfitNullPointer = 1,
    ShadowfitMisaligned = 2,
    /// The state or the program was made for another version of the library, or a struct's `size` is wrong.
    ShadowfitOtherVersion = 3,
    ShadowfitCallInitFirst = 4,
    ShadowfitCallFitFirst = 5,
    /// Kept maps need shadowfit_update in each frame.
    ShadowfitCallUpdateFirst = 6,
    /// A buffer is too small. The function or the text says which size is needed.
    ShadowfitTooSmall = 7,
    ShadowfitUnknownPreset = 8,
    ShadowfitBadTechnique = 9,
    ShadowfitBadInput = 10,
}

use ShadowfitResult as Code;

impl Code {
    /// All results, by their numbers.
    pub(crate) const ALL: [Self; 11] = [
        Self::ShadowfitOk,
        Self::ShadowfitNullPointer,
        Self::ShadowfitMisaligned,
        Self::ShadowfitOtherVersion,
        Self::ShadowfitCallInitFirst,
        Self::ShadowfitCallFitFirst,
        Self::ShadowfitCallUpdateFirst,
        Self::ShadowfitTooSmall,
        Self::ShadowfitUnknownPreset,
        Self::ShadowfitBadTechnique,
        Self::ShadowfitBadInput,
    ];

    /// Returns a sentence for functions without a state.
    pub(crate) const fn text(self) -> &'static CStr {
        match self {
            Self::ShadowfitOk => c"success",
            Self::ShadowfitNullPointer => c"a pointer is null",
            Self::ShadowfitMisaligned => c"the state's buffer is not aligned to 16 bytes; use memory from malloc",
            Self::ShadowfitOtherVersion => {
                c"the state or a struct was made for another version of shadowfit; set size to sizeof, and compile with this library's header"
            }
            Self::ShadowfitCallInitFirst => c"the state was not initialised; call shadowfit_init first",
            Self::ShadowfitCallFitFirst => c"there are no maps; call shadowfit_fit first",
            Self::ShadowfitCallUpdateFirst => c"the map was not updated in this frame; call shadowfit_update first",
            Self::ShadowfitTooSmall => c"a buffer is too small",
            Self::ShadowfitUnknownPreset => c"there is no preset of this name; shadowfit_preset lists them",
            Self::ShadowfitBadTechnique => c"the text of a technique is wrong",
            Self::ShadowfitBadInput => c"a number of the input is wrong",
        }
    }
}

/// Text with a fixed capacity, which ends with a zero byte. Text beyond the capacity is cut off.
#[derive(Clone, Copy)]
pub(crate) struct Text {
    bytes: [u8; Self::CAPACITY],
    length: usize,
}

impl Text {
    const CAPACITY: usize = 512;
    pub(crate) const EMPTY: Self = Self { bytes: [0; Self::CAPACITY], length: 0 };

    /// Replaces the text.
    pub(crate) fn set(&mut self, text: impl fmt::Display) {
        self.length = 0;
        // The only error is a text that is cut off.
        let _ = write!(self, "{text}");
        self.bytes[self.length] = 0;
    }

    /// Returns the text.
    pub(crate) fn as_c_str(&self) -> &CStr {
        CStr::from_bytes_until_nul(&self.bytes).unwrap_or_default()
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let free = Self::CAPACITY - 1 - self.length;
        let end = text.floor_char_boundary(free);
        let copy = &mut self.bytes[self.length..self.length + end];
        copy.copy_from_slice(&text.as_bytes()[..end]);
        // A zero byte would end the text.
        copy.iter_mut().filter(|byte| **byte == 0).for_each(|byte| *byte = b'?');
        self.length += end;
        if end == text.len() { Ok(()) } else { Err(fmt::Error) }
    }
}

/// An error with a sentence.
#[derive(Clone, Copy)]
pub(crate) struct Failure {
    pub(crate) code: Code,
    pub(crate) text: Text,
}

impl Failure {
    pub(crate) fn new(code: Code, text: impl fmt::Display) -> Self {
        let mut failure = Self { code, text: Text::EMPTY };
        failure.text.set(text);
        failure
    }
}

impl Failure {
    /// Returns this failure with another code, unless a pointer is null.
    pub(crate) fn with_code_unless_null(self, code: Code) -> Self {
        if self.code == Code::ShadowfitNullPointer { self } else { Self { code, ..self } }
    }
}

impl From<Code> for Failure {
    fn from(code: Code) -> Self {
        Self::new(code, code.text().to_str().unwrap_or_default())
    }
}

impl From<shadowfit::FitError> for Failure {
    fn from(error: shadowfit::FitError) -> Self {
        Self::new(Code::ShadowfitBadInput, error)
    }
}

//! Work that takes longer than a frame. The viewer starts it and takes the results in later frames.

pub(crate) mod device_check;
pub(crate) mod loading;
pub(crate) mod measuring;
pub(crate) mod tuning;

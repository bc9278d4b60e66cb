//! Plays scripts: actions as text, the frames that they take, random actions, and their effects on the viewer.

pub(crate) mod effect;
pub(crate) mod monkey;
pub(crate) mod playback;
pub(crate) mod script;

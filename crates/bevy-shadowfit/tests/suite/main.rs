//! Tests of the plugin in a single program, because each program links all of Bevy.

mod cascades;
mod pictures;
mod support;
mod window;

//! Tests of the plugin in one program: each program links all of Bevy.

mod cascades;
mod pictures;
mod support;
mod window;

//! Facts about the built-in scene.

//! Facts that the core keeps, by subject. Tolerances are relative and justified where they stand.

mod bad_input;
mod bias;
mod caster;
mod clusters;
mod conventions;
mod diagnostics;
mod frustum;
mod invariance;
mod settings;
mod support;
mod tightness;
mod unprojection;
mod xna_cases;

//! Tests of the core's guarantees, by subject. Tolerances are relative, and a comment next to each one
//! justifies it.

mod automatic_bias;
mod bad_input;
mod bad_input_figures;
mod bad_scenes;
mod batched_culling;
mod bias;
#[cfg(feature = "bytemuck")]
mod bytemuck;
mod cache;
mod caster;
mod caster_depth;
mod clusters;
mod conventions;
mod coverage;
mod demand;
mod diagnostics;
mod f64_reference;
mod filters;
mod frustum;
mod invariance;
mod light_steps;
mod maps;
mod metamorphic;
#[cfg(feature = "mint")]
mod mint;
mod oblique;
mod optimality;
mod other_matrices;
mod proof;
mod read_by_coverage;
mod recommendation;
mod rounding;
mod scenes;
mod scroll;
mod selection;
mod self_shadowing;
#[cfg(feature = "serde")]
mod serde;
mod settings;
mod shadowless;
mod softness;
mod spot;
mod spot_bad_input;
mod spot_bias;
mod spot_self_shadowing;
mod static_boxes;
mod support;
mod sweep;
mod texel_phase;
mod texel_ratio;
mod tightness;
mod unprojection;
mod windows;
mod xna_cases;

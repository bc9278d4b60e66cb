//! The edge pass from an engine's view: it equals its reference in plain Rust, and works with all kinds of
//! views, budgets, boxes and schedules.

#[path = "exact_edges/any_hit_gpu.rs"]
mod any_hit_gpu;
#[path = "exact_edges/errors_gpu.rs"]
mod errors_gpu;
#[path = "exact_edges/exact_gpu.rs"]
mod exact_gpu;
#[path = "exact_edges/factors_gpu.rs"]
mod factors_gpu;
#[path = "exact_edges/pass_gpu.rs"]
mod pass_gpu;
#[path = "exact_edges/soft_gpu.rs"]
mod soft_gpu;
#[path = "exact_edges/stage.rs"]
mod stage;
#[path = "exact_edges/twin.rs"]
mod twin;
#[path = "exact_edges/twin_gpu.rs"]
mod twin_gpu;

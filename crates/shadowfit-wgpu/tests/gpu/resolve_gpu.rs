//! The resolve pass as an engine meets it: against its twin in plain Rust, and with pictures, budgets, boxes and schedules
//! of all kinds.

#[path = "resolve/any_hit_gpu.rs"]
mod any_hit_gpu;
#[path = "resolve/errors_gpu.rs"]
mod errors_gpu;
#[path = "resolve/exact_gpu.rs"]
mod exact_gpu;
#[path = "resolve/factors_gpu.rs"]
mod factors_gpu;
#[path = "resolve/pass_gpu.rs"]
mod pass_gpu;
#[path = "resolve/soft_gpu.rs"]
mod soft_gpu;
#[path = "resolve/stage.rs"]
mod stage;
#[path = "resolve/twin.rs"]
mod twin;
#[path = "resolve/twin_gpu.rs"]
mod twin_gpu;

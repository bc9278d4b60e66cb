//! Rays on the GPU against brute force in `f64`, and what scenes and meshes promise.

mod answers_gpu;
mod brute_force;
mod cut_outs_gpu;
mod deforming_gpu;
mod device;
mod meshes;
mod scenes_gpu;
mod shaders;

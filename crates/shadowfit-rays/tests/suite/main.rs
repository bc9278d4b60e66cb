//! Tests of rays on the GPU against brute force in `f64`, and of scenes and meshes.

mod answers_gpu;
mod brute_force;
mod cut_outs_gpu;
mod deforming_gpu;
mod device;
mod meshes;
mod scenes_gpu;
mod shaders;

//! Rendered pictures judged against rays: artefacts that are made on purpose are found and named, and the GPU's
//! verdicts are those of the CPU.

mod agreement_gpu;
mod artefacts_gpu;
mod large_grounds_gpu;
mod shapes;
mod traced_gpu;

//! Rendered pictures judged against rays: artefacts that are made on purpose are found and named, and the
//! GPU's verdicts equal the CPU's.

mod agreement_gpu;
mod artefacts_gpu;
mod large_grounds_gpu;
mod opengl_gpu;
mod shapes;
mod traced_gpu;

//! The library with renderers of the tests' own making, published figures, and the program.

mod contestant;
mod numbers;
mod peers;
mod reports_gpu;
mod scratch;

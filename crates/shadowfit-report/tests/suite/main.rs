//! Tests of the library with renderers made for the tests, of published figures, and of the program.

mod contestant;
mod docs_gpu;
mod numbers;
mod peers;
mod reports_gpu;
mod scratch;

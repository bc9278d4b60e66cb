//! The graphics adapter that an example draws with.

use shadowfit_adapter::AdapterOptions;
use shadowfit_render::Gpu;

/// Exit code after bad input, as of clap's own complaints.
const BAD_INPUT: i32 = 2;

/// Opens the adapter of the command line. Without such an adapter, says which adapters there are and ends the program with
/// exit code 2.
pub(crate) fn open(options: &AdapterOptions) -> Gpu {
    pollster::block_on(Gpu::headless(&options.choice())).unwrap_or_else(|error| {
        eprintln!("error: {error}");
        std::process::exit(BAD_INPUT)
    })
}

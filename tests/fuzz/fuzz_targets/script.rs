#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| shadowfit_fuzz::script(data));

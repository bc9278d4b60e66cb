#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| shadowfit_fuzz::technique_toml(data));

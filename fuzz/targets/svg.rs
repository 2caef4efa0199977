//! `cargo +nightly fuzz run svg -s none --features libfuzzer fuzz/corpus/svg fuzz/seeds/svg`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::svg(data));

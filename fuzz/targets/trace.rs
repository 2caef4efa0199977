//! `cargo +nightly fuzz run trace -s none --features libfuzzer fuzz/corpus/trace fuzz/seeds/trace`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::trace(data));

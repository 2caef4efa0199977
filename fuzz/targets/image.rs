//! `cargo +nightly fuzz run image -s none --features libfuzzer fuzz/corpus/image fuzz/seeds/image`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::image(data));

//! `cargo +nightly fuzz run project -s none --features libfuzzer fuzz/corpus/project fuzz/seeds/project`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::project(data));

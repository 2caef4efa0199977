//! `cargo +nightly fuzz run pdf -s none --features libfuzzer fuzz/corpus/pdf fuzz/seeds/pdf`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::pdf(data));

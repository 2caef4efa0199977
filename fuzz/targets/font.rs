//! `cargo +nightly fuzz run font -s none --features libfuzzer fuzz/corpus/font fuzz/seeds/font`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| khatt_fuzz::font(data));

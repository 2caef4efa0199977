//! Mutates the seeds of each door and shows it the results: the same ones for the same number, on any Rust.
//!
//!     cargo run --release --manifest-path fuzz/Cargo.toml -- [--seconds N] [--start N] [DOOR…]
//!     cargo run --release --manifest-path fuzz/Cargo.toml -- --show N DOOR > input
//!
//! Input N of a door is made by a generator that starts at N alone, so `--show` gives any of them again. An input
//! that makes a door panic, or keeps it longer than ten seconds, is named with its number, and the exit status is 1.
//! The number of the input at work stands on standard error.

use khatt_fuzz::{TARGETS, Target};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use std::{env, fs, panic};

/// An input that takes longer than this is told of.
const SLOW: Duration = Duration::from_secs(10);
/// Inputs grow to this at most.
const LONGEST: usize = 16_384;

fn main() -> ExitCode {
    let (mut seconds, mut start, mut show, mut doors) = (10, 0, None, Vec::new());
    let mut args = env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut number = || args.next().and_then(|n| n.parse().ok()).unwrap_or(0);
        match arg.as_str() {
            "--seconds" => seconds = number(),
            "--start" => start = number(),
            "--show" => show = Some(number()),
            _ => doors.push(arg),
        }
    }
    let chosen = |name: &str| doors.is_empty() || doors.iter().any(|d| d == name);
    let mut failed = false;
    for (name, target) in TARGETS.into_iter().filter(|t| chosen(t.0)) {
        let seeds = seeds(name);
        if let Some(n) = show {
            let written = std::io::stdout().write_all(&input(&seeds, n));
            return if written.is_ok() {
                ExitCode::SUCCESS
            } else {
                ExitCode::FAILURE
            };
        }
        failed |= run(
            name,
            target,
            &seeds,
            start..u64::MAX,
            Duration::from_secs(seconds),
        ) > 0;
    }
    if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    }
}

fn seeds(name: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("seeds")
        .join(name);
    let mut paths: Vec<_> = fs::read_dir(folder)
        .expect("a folder of seeds")
        .flatten()
        .map(|e| e.path())
        .collect();
    paths.sort();
    paths.iter().map(|p| fs::read(p).expect("a seed")).collect()
}

/// Shows a door the seeds and then what they become, and says how it went.
fn run(
    name: &str,
    target: Target,
    seeds: &[Vec<u8>],
    numbers: std::ops::Range<u64>,
    long: Duration,
) -> usize {
    let (begin, mut runs, mut bad, mut slowest) = (Instant::now(), 0, 0, Duration::ZERO);
    for number in numbers {
        if begin.elapsed() >= long {
            break;
        }
        let input = input(seeds, number);
        // what stops the program at once, as running out of memory does, leaves the number behind
        eprint!("\r{name} {number} ");
        let one = Instant::now();
        let panicked = panic::catch_unwind(|| target(&input)).is_err();
        let took = one.elapsed();
        (runs, slowest) = (runs + 1, slowest.max(took));
        if panicked || took > SLOW {
            bad += 1;
            println!(
                "{name}: input {number} {} ({took:.1?})",
                if panicked { "panics" } else { "is slow" }
            );
        }
    }
    println!(
        "{name}: {runs} inputs in {:.0?}, {bad} bad, slowest {slowest:.1?}",
        begin.elapsed()
    );
    bad
}

/// Input `n`: a seed, changed in a few places; the seeds themselves come first.
fn input(seeds: &[Vec<u8>], n: u64) -> Vec<u8> {
    let mut random = Random(n.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0x5851_F42D_4C95_7F2D);
    if let Some(seed) = usize::try_from(n).ok().and_then(|n| seeds.get(n)) {
        return seed.clone();
    }
    let mut bytes = random.of(seeds).clone();
    for _ in 0..1 << random.below(6) {
        change(&mut bytes, seeds, &mut random);
    }
    bytes.truncate(LONGEST);
    bytes
}

/// One change such as transfers, editors and ill will make.
fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut Random) {
    /// Numbers that break sizes and counts.
    const EDGES: [u32; 8] = [0, 1, 0x7F, 0xFF, 0x7FFF, 0xFFFF, 0x7FFF_FFFF, 0xFFFF_FFFF];
    let at = random.below(bytes.len() + 1);
    let end = (at + 1 + random.below(32)).min(bytes.len());
    match random.below(9) {
        0 => bytes.truncate(at),
        1 => drop(bytes.drain(at.min(end)..end)),
        2 => {
            let part = bytes[at.min(end)..end].to_vec();
            bytes.splice(at..at, part);
        }
        3 => {
            let other = random.of(seeds);
            let from = random.below(other.len() + 1);
            let to = (from + random.below(256)).min(other.len());
            bytes.splice(at..at, other[from..to].iter().copied());
        }
        4 => {
            let wide = EDGES[random.below(EDGES.len())].to_be_bytes();
            let wide = &wide[random.below(4)..];
            bytes
                .iter_mut()
                .skip(at)
                .zip(wide)
                .for_each(|(b, w)| *b = *w);
        }
        5 => {
            // a number in text
            let number =
                ["0", "-1", "1e308", "nan", "inf", "99999999999", "0.0000001"][random.below(7)];
            let digits = |b: &u8| b.is_ascii_digit() || *b == b'.';
            let from = bytes
                .iter()
                .skip(at)
                .position(digits)
                .map_or(at, |p| p + at);
            let to = bytes
                .iter()
                .skip(from)
                .position(|b| !digits(b))
                .map_or(from, |p| p + from);
            bytes.splice(from..to, number.bytes());
        }
        6 => {
            let byte = random.byte();
            bytes.insert(at, byte);
        }
        _ => {
            let (flip, whole) = (1 << random.below(8), random.byte());
            if let Some(b) = bytes.get_mut(at) {
                *b = if random.below(2) == 0 {
                    *b ^ flip
                } else {
                    whole
                };
            }
        }
    }
}

/// The generator xorshift64*.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// From 0 to `n` − 1; 0 for 0.
    fn below(&mut self, n: usize) -> usize {
        usize::try_from((self.next() >> 33) % n.max(1) as u64).unwrap_or(0)
    }

    fn byte(&mut self) -> u8 {
        self.next().to_be_bytes()[0]
    }

    fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        let i = self.below(list.len());
        &list[i]
    }
}

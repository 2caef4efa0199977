//! Time of tracing pictures in process, one thread, beside potrace where it is installed.
//!
//!     cargo bench --bench trace -- PICTURES

#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a bench prints what its clock says"
)]

use khatt::pipeline::picture::{Options, trace_picture};
use khatt::scan::{InkStreaks, Reading, load};
use khatt::types::Gray;
use std::error::Error;
use std::io::Write as _;
use std::process::{Command, Stdio};
use std::time::Instant;
use std::{env, fs};

/// Each picture is traced this often, and its least time counts.
const TIMES: usize = 3;

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = env::args()
        .skip(1)
        .filter(|a| !a.starts_with("--"))
        .collect();
    let options = Options::default();
    let (mut ours, mut potraces) = (Vec::new(), Vec::new());
    for file in &files {
        let pages = load(&fs::read(file)?, file, Reading::default())?;
        for page in &pages {
            ours.push(least(|| {
                Ok(trace_picture(&page.gray, InkStreaks::default(), &options).map(|_| ())?)
            })?);
            let pbm = pbm(&page.gray);
            potraces.extend(least(|| potrace(&pbm)));
        }
    }
    println!(
        "{} pictures, ms each on one core: median, mean, largest",
        ours.len()
    );
    println!("khatt, in process: {}", figures(&mut ours));
    if potraces.is_empty() {
        println!("potrace: not installed");
    } else {
        println!("potrace, a process each: {}", figures(&mut potraces));
    }
    Ok(())
}

/// Milliseconds of the quickest of some runs.
fn least(run: impl Fn() -> Result<(), Box<dyn Error>>) -> Result<f64, Box<dyn Error>> {
    let mut least = f64::INFINITY;
    for _ in 0..TIMES {
        let start = Instant::now();
        run()?;
        least = least.min(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(least)
}

fn figures(ms: &mut [f64]) -> String {
    ms.sort_by(f64::total_cmp);
    let median = ms.get(ms.len() / 2).copied().unwrap_or_default();
    let mean = ms.iter().sum::<f64>() / ms.len().max(1) as f64;
    let largest = ms.last().copied().unwrap_or_default();
    format!("{median:.2}, {mean:.2}, {largest:.2}")
}

/// The picture in black and white, as potrace reads it.
fn pbm(gray: &Gray) -> Vec<u8> {
    let mut out = format!("P4\n{} {}\n", gray.width(), gray.height()).into_bytes();
    for y in 0..gray.height() {
        for eight in gray.row(y).chunks(8) {
            let bit = |(i, v): (usize, &f32)| u8::from(*v >= 0.5) << (7 - i);
            out.push(eight.iter().enumerate().map(bit).sum());
        }
    }
    out
}

fn potrace(pbm: &[u8]) -> Result<(), Box<dyn Error>> {
    let mut child = Command::new("potrace")
        .args(["--svg", "--output", "-", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()?;
    child.stdin.take().ok_or("no input")?.write_all(pbm)?;
    child.wait()?;
    Ok(())
}

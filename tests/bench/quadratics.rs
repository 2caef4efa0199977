//! Bytes, points and time of the conversions to quadratics, beside each other and the fewest bytes possible:
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench times and reports"
)]
//! `cargo bench --bench quadratics -- FONT.otf [all] TOLERANCE…` (font units; `all`: every glyph, else 65 Latin
//! ones).

use khatt::quadratic::rate::{Rate, Strictness, glyf_bytes, glyf_points};
use khatt::quadratic::{Method, split::Split};
use khatt::read;
use khatt::types::{Glyph, Outline};
use std::{env, fs, time::Instant};

const LATIN: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!";

fn main() {
    let args: Vec<String> = env::args().skip(1).filter(|a| a != "--bench").collect();
    let Some(path) = args.first() else {
        println!("a font's path and tolerances are wanted; nothing measured");
        return;
    };
    let data = fs::read(path).expect("a readable file");
    let font = read::font(&data, None, &[]).expect("a font").font;
    let all = args.iter().any(|a| a == "all");
    let wanted = |g: &&Glyph| all || g.codepoints.iter().any(|&c| LATIN.contains(c));
    let drawn = font.glyphs().iter().filter(wanted).map(|g| &g.outline);
    let outlines: Vec<&Outline> = drawn.filter(|o| !o.is_empty()).collect();
    println!("{} glyphs of {path}", outlines.len());
    println!(
        "method         tolerance    bytes   at least, above  points  ms a glyph  slowest ms  failed"
    );
    for tolerance in args.iter().filter_map(|a| a.parse().ok()) {
        measure(
            ("split", &Method::Split(Split::default()), None),
            tolerance,
            &outlines,
        );
        for (name, keep) in [
            ("rate, corners", Strictness::Corners),
            ("rate, extrema", Strictness::Extrema),
        ] {
            let rate = Rate {
                keep,
                ..Rate::default()
            };
            let method = Method::Rate(rate.clone());
            measure((name, &method, Some(&rate)), tolerance, &outlines);
        }
    }
}

fn measure(
    (name, method, least): (&str, &Method, Option<&Rate>),
    tolerance: f64,
    outlines: &[&Outline],
) {
    let (mut bytes, mut points, mut fewest, mut failed) = (0, 0, 0, 0);
    let (mut total, mut slowest) = (0.0, 0.0_f64);
    for outline in outlines {
        let clock = Instant::now();
        let result = method.convert(outline, tolerance);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        (total, slowest) = (total + ms, slowest.max(ms));
        let Ok(q) = result else {
            failed += 1;
            continue;
        };
        bytes += glyf_bytes(&q);
        points += glyf_points(&q);
        if let Some(rate) = least {
            let least = rate.least_bytes(outline, tolerance);
            assert!(least <= glyf_bytes(&q), "{least} of {}", glyf_bytes(&q));
            fewest += least;
        }
    }
    let each = total / f64::from(u32::try_from(outlines.len()).expect("few glyphs"));
    let above = 100.0 * (f64::from(bytes) / f64::from(fewest) - 1.0);
    let beside = least.map_or_else(String::new, |_| format!("{fewest} {above:6.1} %"));
    println!(
        "{name:14} {tolerance:9} {bytes:8} {beside:>17} {points:7} {each:11.2} {slowest:11.1} {failed:7}"
    );
}

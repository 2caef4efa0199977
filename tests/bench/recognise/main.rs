//! How often letters are recognised, how fast, and which wrong labels are noticed.
//!
//!     cargo bench --bench recognise -- fonts latin|arabic QUERY.ttf,… REFERENCE.ttf,…
//!     cargo bench --bench recognise -- crops latin|arabic|arabic-script FOLDER REFERENCE.ttf,…
//!     cargo bench --bench recognise -- labels REFERENCE.ttf,…
//!     cargo bench --bench recognise -- dots FONT.ttf,…
//!     cargo bench --bench recognise -- time REFERENCE.ttf
//!
//! `fonts` matches the letters of each query among those of each reference: 62 Latin letters and digits, 28
//! isolated Arabic letters. `crops` matches pictures named by their letter (`a.png`, `Baa_Start.jpg`) among those of
//! each reference, and of all references together. `labels` spoils the labels of the Latin demo sheet and prints
//! what is said. `dots` looks for letters that nothing but dots tells apart and that are taken for each other.
//! `time` is a cell against 150 references on one core.

#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a benchmark reads, times and prints its tables"
)]

mod crops;
mod dots;
mod labels;

use khatt::pipeline::reference::{Script, samples};
use khatt::recognise::{Alphabet, Look, Method, Sample};
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use std::{env, fs};

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// Arabic letters of the isolated test.
const ISOLATED: &str = "ابتثجحخدذرزسشصضطظعغفقكلمنهوي";

fn main() -> Outcome {
    let args: Vec<String> = env::args().skip(1).filter(|a| a != "--bench").collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match args.as_slice() {
        ["fonts", script, queries, references] => {
            fonts(script, &split(queries), &split(references))
        }
        ["crops", script, folder, references] => crops::run(script, folder, &split(references)),
        ["labels", references] => labels::run(&split(references)),
        ["dots", fonts] => split(fonts).into_iter().try_for_each(dots::run),
        ["time", reference] => time(reference),
        _ => {
            println!("nothing to do: see the head of tests/bench/recognise/main.rs");
            Ok(())
        }
    }
}

fn split(text: &str) -> Vec<&str> {
    text.split(',').collect()
}

/// A file's name without its folder and ending.
fn stem(path: &str) -> &str {
    let stem = Path::new(path).file_stem();
    stem.and_then(|s| s.to_str()).unwrap_or(path)
}

/// Pictures of a font's letters.
fn letters(font: &str, labels: impl IntoIterator<Item = String>) -> Outcome<Vec<Sample>> {
    let bytes = fs::read(font).map_err(|e| format!("{font}: {e}"))?;
    Ok(samples(&bytes, labels).map_err(|e| format!("{font}: {e}"))?)
}

fn repertoire(script: &str) -> Vec<String> {
    match script {
        "latin" => Script::Latin.letters(),
        _ => ISOLATED.chars().map(String::from).collect(),
    }
}

/// One letter to the eye: capitals that are large small letters count as these.
fn same(a: &str, b: &str) -> bool {
    let large = ["c", "o", "s", "v", "w", "x", "z"];
    a == b || (a.eq_ignore_ascii_case(b) && large.contains(&a.to_lowercase().as_str()))
}

/// How many answers were right at first and among the first three, and of how many.
#[derive(Debug, Clone, Copy, Default)]
struct Score {
    first: usize,
    three: usize,
    of: usize,
}

impl Score {
    /// Counts the place of the right answer.
    fn add(&mut self, place: Option<usize>) {
        self.first += usize::from(place == Some(0));
        self.three += usize::from(place.is_some_and(|p| p < 3));
        self.of += 1;
    }

    fn join(&mut self, other: Self) {
        self.first += other.first;
        self.three += other.three;
        self.of += other.of;
    }

    fn percent(self) -> String {
        let share = |part: usize| 100.0 * part as f64 / self.of.max(1) as f64;
        format!("{:.1} / {:.1}", share(self.first), share(self.three))
    }
}

fn fonts(script: &str, queries: &[&str], references: &[&str]) -> Outcome {
    for method in Method::all() {
        let mut all = Score::default();
        println!("\n{} {script}, top-1 / top-3 %\n", method.key());
        let heads: Vec<&str> = references.iter().map(|r| stem(r)).collect();
        println!("| | {} |", heads.join(" | "));
        println!("|---|{}", "---|".repeat(heads.len()));
        for query in queries {
            let drawn = letters(query, repertoire(script))?;
            let mut row = format!("| {} |", stem(query));
            for reference in references {
                let alphabet = Alphabet::new(&letters(reference, repertoire(script))?, method);
                let score = score(&alphabet, &drawn, method);
                all.join(score);
                row += &format!(" {} |", score.percent());
            }
            println!("{row}");
        }
        println!("\nall: {}", all.percent());
    }
    Ok(())
}

/// The letters of a font as the cells of a page.
fn score(alphabet: &Alphabet, queries: &[Sample], method: Method) -> Score {
    let look = |s: &Sample| Look::new(&s.gray, s.guides, method);
    let mut looks: Vec<Look> = queries.iter().map(look).collect();
    alphabet.settle_page(&mut looks);
    let mut score = Score::default();
    for (query, look) in queries.iter().zip(&looks) {
        let guesses = alphabet.rank(look);
        score.add(guesses.iter().position(|g| same(&g.label, &query.label)));
    }
    score
}

fn time(reference: &str) -> Outcome {
    /// References to compare with.
    const REFERENCES: usize = 150;
    let wanted = Script::Latin
        .letters()
        .into_iter()
        .chain((33..127_u8).map(|b| char::from(b).to_string()))
        .chain(Script::Arabic.letters());
    let mut refs = letters(reference, wanted)?;
    refs.truncate(REFERENCES);
    println!("| | ms a cell, median | slowest |\n|---|---|---|");
    for method in Method::all() {
        let alphabet = Alphabet::new(&refs, method);
        let mut times: Vec<f64> = Vec::new();
        for sample in refs.iter().cycle().take(2 * REFERENCES) {
            let start = Instant::now();
            let guesses = alphabet.rank(&Look::new(&sample.gray, None, method));
            times.push(1e3 * start.elapsed().as_secs_f64());
            assert!(!guesses.is_empty(), "a letter is answered");
        }
        times.sort_by(f64::total_cmp);
        let (key, median) = (method.key(), times[times.len() / 2]);
        println!(
            "| `{key}`, {} references | {median:.2} | {:.2} |",
            refs.len(),
            times[times.len() - 1]
        );
    }
    Ok(())
}

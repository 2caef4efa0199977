//! Letters cut from real pages, named by their files.

use super::{Outcome, Score, letters, same, stem};
use khatt::pipeline::reference::{Script, spelling};
use khatt::recognise::{Alphabet, Guess, Look, Method, Sample, once};
use khatt::scan::{Reading, load};
use khatt::types::{Gray, Label};
use std::fs;

/// Letters as file names of handwriting collections write them.
const NAMES: [(&str, &str); 46] = [
    ("Alf", "ا"),
    ("Baa", "ب"),
    ("Taa", "ت"),
    ("Thaa", "ث"),
    ("Gem", "ج"),
    ("Haa", "ح"),
    ("Khaa", "خ"),
    ("Dal", "د"),
    ("Zal", "ذ"),
    ("Raa", "ر"),
    ("Zin", "ز"),
    ("Sin", "س"),
    ("Shen", "ش"),
    ("Saad", "ص"),
    ("Daad", "ض"),
    ("Tah", "ط"),
    ("Zah", "ظ"),
    ("Ain", "ع"),
    ("Gen", "غ"),
    ("Faa", "ف"),
    ("Qaf", "ق"),
    ("Kaf", "ك"),
    ("Lam", "ل"),
    ("Mem", "م"),
    ("Non", "ن"),
    ("Ha", "ه"),
    ("Waw", "و"),
    ("Yaa_Dot", "ي"),
    ("Yaa", "ى"),
    ("Alf_Hamza_Above", "أ"),
    ("Alf_Hamza_Under", "إ"),
    ("Hamza", "ء"),
    ("Waw_Hamza", "ؤ"),
    ("Lam_Alf", "لا"),
    ("Lam_Alf_Hamza", "لأ"),
    ("Lam_Alf_Mad", "لآ"),
    ("Zero", "٠"),
    ("One", "١"),
    ("Two", "٢"),
    ("Three", "٣"),
    ("Four", "٤"),
    ("Five", "٥"),
    ("Six", "٦"),
    ("Seven", "٧"),
    ("Eight", "٨"),
    ("Nine", "٩"),
];

/// Letters of the script that Arabic itself does not write: peh, tcheh, jeh, veh, gaf.
const PERSIAN: [&str; 5] = ["uni067E", "uni0686", "uni0698", "uni06A4", "uni06AF"];

/// Matches every picture of `folder` with each reference, and with all of them together.
pub(super) fn run(script: &str, folder: &str, references: &[&str]) -> Outcome {
    let crops = crops(folder)?;
    let heads: Vec<&str> = Method::all().iter().map(|m| m.key()).collect();
    println!("\n{} crops, top-1 / top-3 %\n", crops.len());
    println!("| | {} |\n|---|---|---|---|", heads.join(" | "));
    let mut all = Vec::new();
    let mut sums = [Score::default(); 3];
    for reference in references {
        let drawn = letters(reference, wanted(script))?;
        let mut row = format!("| {} |", stem(reference));
        for (method, sum) in Method::all().into_iter().zip(&mut sums) {
            let score = score(&crops, &read(&crops, &drawn, method));
            sum.join(score);
            row += &format!(" {} |", score.percent());
        }
        println!("{row}");
        all.extend(drawn);
    }
    let mean: Vec<String> = sums.iter().map(|s| s.percent()).collect();
    println!("| mean | {} |", mean.join(" | "));
    if references.len() > 1 {
        let together = Method::all().map(|method| read(&crops, &all, method));
        let row = together.each_ref().map(|g| score(&crops, g).percent());
        println!("| all together | {} |", row.join(" | "));
        let row = together.each_ref().map(|g| alone(&crops, g).percent());
        println!("| no letter twice | {} |", row.join(" | "));
        println!(
            "\nmissed by `{}`: {}",
            heads[0],
            missed(&crops, &together[0])
        );
    }
    Ok(())
}

fn wanted(script: &str) -> Vec<String> {
    match script {
        "latin" => ('A'..='Z').chain('a'..='z').map(String::from).collect(),
        "arabic" => {
            let persian = |l: &String| PERSIAN.iter().any(|p| l.starts_with(p));
            let letters = Script::Arabic.letters().into_iter();
            letters.filter(|l| !persian(l)).collect()
        }
        _ => Script::Arabic.letters(),
    }
}

fn crops(folder: &str) -> Outcome<Vec<Sample>> {
    let entries = fs::read_dir(folder).map_err(|e| format!("{folder}: {e}"))?;
    let mut paths: Vec<_> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
    paths.sort();
    let mut crops = Vec::new();
    for path in paths {
        let name = path.display().to_string();
        let pages = load(&fs::read(&path)?, &name, Reading::default())?;
        crops.extend(pages.first().map(|page| Sample {
            label: named(stem(&name)),
            gray: levelled(&page.gray),
            guides: None,
        }));
    }
    Ok(crops)
}

/// The letter that a crop's name says: `a`, or `Baa_Start`.
fn named(stem: &str) -> String {
    let forms = ["_End", "_Isolated", "_Middle", "_Start"];
    let base = forms.iter().find_map(|f| stem.strip_suffix(f));
    let base = base.unwrap_or(stem);
    let arabic = NAMES.iter().find(|n| n.0 == base).map(|n| n.1);
    spelling(&Label(arabic.unwrap_or(base).to_owned()))
}

/// The letter in any position; one and alef are one stroke in any hand.
fn letter(label: &str) -> &str {
    match label.split('.').next().unwrap_or(label) {
        "uni0661" => "uni0627",
        base => base,
    }
}

/// What each crop may be. They come from one page, so that their sizes compare.
fn read(crops: &[Sample], drawn: &[Sample], method: Method) -> Vec<Vec<Guess>> {
    let alphabet = Alphabet::new(drawn, method);
    let looks = crops.iter().map(|c| Look::new(&c.gray, None, method));
    let mut looks: Vec<Look> = looks.collect();
    alphabet.settle_page(&mut looks);
    looks.iter().map(|look| alphabet.rank(look)).collect()
}

/// The letters that a crop may be, in any position, likeliest first.
fn told(guesses: &[Guess]) -> Vec<&str> {
    let mut told: Vec<&str> = Vec::new();
    for guess in guesses {
        if !told.contains(&letter(&guess.label)) {
            told.push(letter(&guess.label));
        }
    }
    told
}

fn score(crops: &[Sample], guesses: &[Vec<Guess>]) -> Score {
    let mut score = Score::default();
    for (crop, guesses) in crops.iter().zip(guesses) {
        let wanted = letter(&crop.label);
        score.add(told(guesses).iter().position(|g| same(g, wanted)));
    }
    score
}

/// The score where no letter, and no form of one, is given to two crops.
fn alone(crops: &[Sample], guesses: &[Vec<Guess>]) -> Score {
    let mut score = Score::default();
    for (crop, given) in crops.iter().zip(once(guesses)) {
        let right = given.is_some_and(|g| same(letter(&g.label), letter(&crop.label)));
        score.add(right.then_some(0));
    }
    score
}

/// What was taken for what.
fn missed(crops: &[Sample], guesses: &[Vec<Guess>]) -> String {
    let wrong = crops.iter().zip(guesses).filter_map(|(crop, guesses)| {
        let first = told(guesses).first().copied().unwrap_or("nothing");
        let wrong = !same(first, letter(&crop.label));
        wrong.then(|| format!("{} for {}", first, crop.label))
    });
    wrong.collect::<Vec<_>>().join(", ")
}

/// Paper to 0 and ink to 1: a crop has no page that its light was evened out with.
fn levelled(gray: &Gray) -> Gray {
    let mut all = gray.samples().to_vec();
    all.sort_by(f32::total_cmp);
    let at = |per_mille: usize| {
        all.get(all.len() * per_mille / 1000)
            .copied()
            .unwrap_or_default()
    };
    let (paper, ink) = (at(500), at(997));
    let range = (ink - paper).max(0.2);
    Gray::from_fn(gray.width(), gray.height(), |x, y| {
        (gray.at(x, y) - paper) / range
    })
}

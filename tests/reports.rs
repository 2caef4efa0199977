//! What a build says of itself: report, gate, proof and log, and what written words tell.

use crate::common::desk::{BUILD, Desk};
use crate::common::pictures::{bar, page, png, ring};

#[test]
fn a_build_reports_lists_its_inputs_and_can_be_locked() {
    let desk = Desk::letters();
    desk.edit(|text| format!("{text}report = \"out/report.json\"\n"));
    let locked = ["build", "font.toml", "--locked"];
    desk.fails(&locked);
    assert!(!desk.has("out"), "--locked writes nothing");
    let args = [
        "build",
        "font.toml",
        "--no-cache",
        "--depfile",
        "out/font.d",
        "--keep",
        "out/keep",
    ];
    desk.done(&args);
    desk.done(&locked);
    let made = desk.files("out");
    let rule = String::from_utf8_lossy(&made["font.d"]);
    assert!(
        rule.contains("out/test.ttf") && rule.contains(": font.toml page.png\n"),
        "{rule}"
    );
    let kept = |stage: &str| {
        made.keys()
            .filter(|k| k.starts_with(&format!("keep/{stage}")))
            .count()
    };
    let stages = ["1-cut", "2-trace", "3-fit", "4-place", "5-assemble"];
    assert_eq!(stages.map(kept), [9, 9, 9, 12, 1]);
    let report = desk.json("out/report.json");
    let rows = report["glyphs"].as_array().expect("a list");
    assert_eq!(rows.len(), 9);
    for row in rows {
        let error = row["max_error"].as_f64().expect("a number");
        assert!(error > 0.0 && error < 15.0, "{row}");
    }
    desk.done(&["build", "font.toml", "--timings", "--no-cache"]);
    let report = desk.json("out/report.json");
    assert!(report["stage_seconds"]["cut"].is_number());
    assert!(report["pages_per_decoding"].is_number());
    let plain = || {
        desk.done(&["build", "font.toml", "--no-cache", "--quiet"]);
        desk.text("out/report.json")
    };
    let first = plain();
    assert!(!first.contains("seconds"));
    assert_eq!(first, plain(), "without times the report is the same");
}

#[test]
fn a_gate_fails_the_build_and_names_the_cells() {
    let desk = Desk::letters();
    desk.edit(|text| text.replace("[output]", "[gate]\nmax_error = 0.001\n[output]"));
    let said = desk.fails(&BUILD);
    let first = "page.png, cell 1 “H”: max_error is ";
    assert!(said.contains(first), "{said}");
    assert!(!desk.has("out"), "nothing may be written");
}

#[test]
fn a_proof_shows_what_has_changed_and_stays_the_same_until_something_does() {
    let desk = Desk::letters();
    let proof = || desk.text("out/test.html");
    let again = ["build", "font.toml", "--no-cache"];
    desk.done(&again);
    let first = proof();
    assert!(!first.contains("Changed since the build before"));
    desk.done(&again);
    assert_eq!(proof(), first, "nothing has changed");

    desk.edit(|text| format!("{text}[cells.o]\nbaseline_shift = -20\n"));
    desk.done(&BUILD);
    let second = proof();
    let (_, row) = second
        .split_once("<a href=\"#glyph-o\">o</a>")
        .expect("a change");
    assert!(row.starts_with("</td><td>20."), "{}", &row[..50]);
    desk.done(&again);
    assert_eq!(proof(), second, "what was before stays");
    desk.done(&["build", "font.toml", "--locked", "--no-cache"]);
}

#[test]
fn what_a_build_remarks_and_why_it_fails_is_in_the_sarif_log() {
    let desk = Desk::letters();
    let logged = ["build", "font.toml", "--sarif", "log/out.sarif"];
    desk.done(&logged);
    let good = desk.json("log/out.sarif");
    // o and c are one drawing in the page, and so on: that is remarked
    assert!(!results(&good).is_empty());
    for result in results(&good) {
        assert_ne!(result["level"], "error", "{result}");
        let place = &result["locations"][0];
        let uri = &place["physicalLocation"]["artifactLocation"]["uri"];
        assert_eq!(uri, "page.png", "{result}");
        assert_eq!(place["logicalLocations"][0]["kind"], "glyph", "{result}");
    }

    desk.write("page.png", page(&[4, 7]));
    desk.fails(&logged);
    let bad = desk.json("log/out.sarif");
    let said: Vec<&str> = results(&bad)
        .iter()
        .filter_map(|r| r["message"]["text"].as_str())
        .collect();
    assert_eq!(said.len(), 2, "{said:?}");
    let first = "page.png, cell 5 “e”: the cell is empty";
    assert!(said[0].contains(first), "{said:?}");
    let errors = results(&bad).iter().filter(|r| r["level"] == "error");
    assert_eq!(errors.count(), 2, "{said:?}");
}

/// The results of a SARIF log, whose shape is that of version 2.1.0: what its schema demands of the parts used
/// (sarifLog, run, tool, toolComponent, reportingDescriptor, result, location, artifactLocation, message).
fn results(log: &serde_json::Value) -> &[serde_json::Value] {
    let shape = |value: &serde_json::Value, wanted: &[&str]| {
        assert_eq!(keys(value), wanted, "{value}");
    };
    let level = |value: &serde_json::Value| {
        let known = matches!(value.as_str(), Some("error" | "warning" | "note"));
        assert!(known, "{value} is no level");
    };
    shape(log, &["$schema", "runs", "version"]);
    assert_eq!(log["version"], "2.1.0", "{log}");
    let run = &log["runs"][0];
    shape(run, &["results", "tool"]);
    shape(&run["tool"], &["driver"]);
    let driver = &run["tool"]["driver"];
    shape(driver, &["name", "rules", "semanticVersion"]);
    let rules = driver["rules"].as_array().expect("a list");
    for rule in rules {
        shape(rule, &["defaultConfiguration", "id", "shortDescription"]);
        shape(&rule["shortDescription"], &["text"]);
        level(&rule["defaultConfiguration"]["level"]);
    }
    let results = run["results"].as_array().expect("a list");
    for result in results {
        let parts = ["level", "locations", "message", "ruleId", "ruleIndex"];
        shape(result, &parts);
        shape(&result["message"], &["text"]);
        level(&result["level"]);
        let index = result["ruleIndex"].as_u64().expect("a number");
        let rule = &rules[usize::try_from(index).expect("a few")];
        assert_eq!(rule["id"], result["ruleId"], "{result}");
        for place in result["locations"].as_array().expect("a list") {
            let known = ["logicalLocations", "physicalLocation"];
            assert!(keys(place).iter().all(|k| known.contains(k)), "{place}");
            let uri = &place["physicalLocation"]["artifactLocation"]["uri"];
            let reference = uri.as_str().is_some_and(|u| !u.contains([' ', '\\']));
            assert!(reference, "{place}");
        }
    }
    results
}

/// The keys of a table, sorted.
fn keys(value: &serde_json::Value) -> Vec<&str> {
    let table = value.as_object().expect("a table");
    let mut keys: Vec<&str> = table.keys().map(String::as_str).collect();
    keys.sort_unstable();
    keys
}

/// Words of H, o and l, a row of 150 px a word, so many px between any two letters.
fn words(all: &[&str], gap: f64) -> Vec<u8> {
    let height = 150 * u32::try_from(all.len()).expect("few words");
    png(600, height, |x, y| {
        let word = all[(y / 150) as usize];
        let (x, y) = (f64::from(x) + 0.5, f64::from(y % 150) + 0.5);
        let mut left = 40.0;
        let mut ink = 0;
        for letter in word.chars() {
            let at = (x - left, y);
            let (width, drawn) = match letter {
                'H' => (
                    80.0,
                    bar(at, [0.0, 25.0, 16.0, 125.0])
                        .max(bar(at, [64.0, 25.0, 80.0, 125.0]))
                        .max(bar(at, [10.0, 67.0, 70.0, 83.0])),
                ),
                'o' => (70.0, ring(at, (35.0, 91.0))),
                _ => (16.0, bar(at, [0.0, 15.0, 16.0, 125.0])),
            };
            ink = ink.max(drawn);
            left += width + gap;
        }
        ink
    })
}

#[test]
fn written_words_say_how_loosely_letters_stand() {
    let all = ["oHol", "loHo", "Holo", "lolo"];
    let built = |gap: f64| {
        let desk = Desk::letters();
        desk.write("words.png", words(&all, gap));
        let table = format!(
            "report = \"out/report.json\"\n[[sheet]]\nimage = \"words.png\"\ncontent = \"words\"\n\
             layout = {{ grid = [4, 1] }}\nglyphs = \"{}\"\npixels_per_em = 150\n",
            all.join(" ")
        );
        desk.edit(|text| text + &table);
        desk.done(&BUILD);
        let report = desk.json("out/report.json");
        let gaps = report["gaps"].as_array().expect("gaps");
        assert_eq!(gaps.len(), 12);
        // words are no glyphs
        assert_eq!(report["glyphs"].as_array().expect("glyphs").len(), 9);
        for found in gaps {
            let [written, set] = ["written", "set"].map(|k| found[k].as_f64().expect("a length"));
            assert!((written - gap / 0.15).abs() < 1.0, "{found}");
            assert!((written - set).abs() < 10.0, "{found}");
        }
    };
    built(12.0);
    built(40.0);
}

#[test]
fn what_is_no_word_is_told() {
    let desk = Desk::letters();
    desk.write("words.png", words(&["oHol"], 12.0));
    let table = "[[sheet]]\nimage = \"words.png\"\ncontent = \"words\"\nlayout = { grid = [3, 1] }\n\
                 glyphs = \"oHol H beh-ar.init\"\n";
    desk.edit(|text| text + table);
    let said = desk.fails(&BUILD);
    for wrong in [
        "words.png: word 2 “H” is none",
        "words.png: word 3 “beh-ar.init” is none",
        "words.png: words do not tell how large the em is",
    ] {
        assert!(said.contains(wrong), "{said}");
    }
}

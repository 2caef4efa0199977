//! Text → [`Project`], with errors that say where and which key was meant.

use super::Project;
use std::ops::Range;
use thiserror::Error;
use toml::de::Error as TomlError;

/// Why a text is no project.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct ProjectError {
    /// What is wrong.
    pub message: String,
    /// Where in the text, bytes.
    pub span: Option<Range<usize>>,
    /// What to do.
    pub help: Option<String>,
}

impl Project {
    /// Reads a project file.
    ///
    /// # Errors
    /// The text is no TOML, has a key that is not known, or a value of the wrong kind or out of its range.
    pub fn parse(text: &str) -> Result<Self, ProjectError> {
        toml::from_str(text).map_err(|e| explain(text, &e))
    }
}

/// The decoder's error with the key that was probably meant.
fn explain(text: &str, error: &TomlError) -> ProjectError {
    let message = error.message().trim_end();
    let span = error.span();
    let span = span.map(|s| s.start.min(text.len())..s.end.min(text.len()));
    if message.contains("expected internally tagged enum") {
        let word = message.split('"').nth(1).unwrap_or("…");
        return ProjectError {
            message: format!("must be a table: {{ method = \"{word}\" }}"),
            span,
            help: Some(
                "`khatt methods --json` lists methods and what else the table may hold".to_owned(),
            ),
        };
    }
    let mut quoted = message.split('`').skip(1).step_by(2);
    let unknown = message.starts_with("unknown ");
    let help = unknown.then(|| quoted.next()).flatten().and_then(|wrong| {
        let known: Vec<&str> = quoted.collect();
        nearest(wrong, &known).map(|right| format!("did you mean `{right}`?"))
    });
    ProjectError {
        message: message.to_owned(),
        span,
        help,
    }
}

/// The known word least different from `wrong`, if it differs by no more than half its letters.
pub(in crate::pipeline) fn nearest<'a>(wrong: &str, known: &[&'a str]) -> Option<&'a str> {
    let far = |word: &str| strsim::osa_distance(wrong, word);
    let best = *known.iter().min_by_key(|word| far(word))?;
    let letters = wrong.chars().count().max(best.chars().count());
    (2 * far(best) <= letters).then_some(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"
[font]
family = "Khatt Latin"
units_per_em = 1000
[[sheet]]
image = "latin.png"
layout = { grid = [8, 8] }
glyphs = "A B C _ beh-ar.init"
pixels_per_em = 504
[trace]
tolerance_px = 0.4
[compose]
letters = ["urdu", "é"]
gap = 0.06
[output]
ttf = "build/KhattLatin.ttf"
"#;

    #[test]
    fn the_readmes_project_is_read() {
        let project = Project::parse(GOOD).unwrap();
        assert_eq!(project.font.family, "Khatt Latin");
        assert_eq!(project.font.style, "Regular");
        assert_eq!(project.font.version, "1.000");
        let again = toml::to_string(&project).unwrap();
        assert_eq!(Project::parse(&again), Ok(project), "{again}");
    }

    #[test]
    fn the_height_that_scales_a_page_is_the_fonts() {
        let page = GOOD.replace("pixels_per_em = 504", "x_height = 400");
        let font = format!("{page}[spacing.heights]\nx_height = 0.45\ncap_height = 0.7\n");
        for (text, x, cap) in [
            (GOOD, None, None),
            (&page, Some(0.4), None),
            (&font, Some(0.45), Some(0.7)),
        ] {
            let heights = Project::parse(text).unwrap().heights();
            assert_eq!((heights.x_height, heights.cap_height), (x, cap));
        }
    }

    #[test]
    fn lengths_of_fonts_have_ranges() {
        for (table, option, value) in [
            ("spacing.joining", "limit", "-1.0"),
            ("spacing.joining", "limit", "-inf"),
            ("spacing.joining", "edges", "[nan, nan]"),
            ("spacing.joining", "edges", "[0.1, 0.0]"),
            ("spacing.letters", "tracking", "inf"),
            ("spacing.letters", "sidebearing", "nan"),
            ("spacing.kerning", "strength", "1e300"),
            ("spacing", "space", "-1.0"),
            ("spacing", "space", "250"),
            ("spacing.heights", "descender", "0.3"),
        ] {
            let text = format!("{GOOD}[{table}]\n{option} = {value}\n");
            let problem = Project::parse(&text).expect_err(&text).to_string();
            assert!(problem.contains("must be"), "{option} = {value}: {problem}");
            let told = option == "edges" || problem.contains("lengths are parts of the em");
            assert!(told, "{option} = {value}: {problem}");
        }
    }

    #[test]
    fn options_of_methods_have_ranges() {
        for (key, method) in [
            ("trace.fit", "method = \"wls\"\norder = 40"),
            ("trace.fit", "method = \"joint\"\nleast_noise = nan"),
            ("quadratic.convert", "method = \"rate\"\ngrain = 0.0"),
        ] {
            let text = format!("{GOOD}[{key}]\n{method}\n");
            let problem = Project::parse(&text).expect_err(&text).to_string();
            assert!(problem.contains("must be"), "{method}: {problem}");
        }
    }

    #[test]
    fn versions_are_decimal() {
        for (text, numbers) in [
            ("1.002", Some((1, 2))),
            ("1.5", Some((1, 500))),
            ("2.05", Some((2, 50))),
            ("1.1234", None),
            ("1.", None),
            ("1", None),
        ] {
            assert_eq!(
                super::super::check::version_numbers(text),
                numbers,
                "{text}"
            );
        }
    }

    #[test]
    fn wrong_keys_and_values_are_found_where_they_stand() {
        let cases = [
            (
                "family",
                "famly",
                "unknown field `famly`",
                "famly",
                "family",
            ),
            (
                "tolerance_px",
                "tolerance",
                "unknown field",
                "tolerance",
                "tolerance_px",
            ),
            ("ttf =", "tff =", "unknown field", "tff", "ttf"),
            ("1000", "8", "must be between 16 and 16384", "8", ""),
            ("1000", "\"x\"", "invalid type", "\"x\"", ""),
            ("504", "-1", "must be above 0", "-1", ""),
            ("504", "nan", "must be above 0", "nan", ""),
            ("504", "1e-300", "must be above 0", "1e-300", ""),
            (
                "urdu",
                "klingon",
                "is neither an alphabet",
                "[\"klingon\", \"é\"]",
                "",
            ),
            (
                "\"é\"",
                "\"e\"",
                "nor a letter that others compose",
                "[\"urdu\", \"e\"]",
                "",
            ),
            ("0.06", "-0.06", "must be between 0 and 1", "-0.06", ""),
            ("grid", "grad", "unknown variant", "grad", "grid"),
            (
                "Khatt Latin",
                "Khatt\\nLatin",
                "must be a name in one line",
                "\"Khatt\\nLatin\"",
                "",
            ),
            (
                "[compose]",
                "fit = \"qbc\"\n[compose]",
                "must be a table: { method = \"qbc\" }",
                "\"qbc\"",
                "khatt methods",
            ),
            (
                "[compose]",
                "[quadratic]\nconvert = \"split\"\n[compose]",
                "must be a table: { method = \"split\" }",
                "\"split\"",
                "khatt methods",
            ),
        ];
        for (right, wrong, message, at, help) in cases {
            let text = GOOD.replacen(right, wrong, 1);
            let error = Project::parse(&text).unwrap_err();
            assert!(error.message.contains(message), "{wrong}: {error:?}");
            let span = error.span.unwrap();
            assert_eq!(&text[span], at, "{wrong}");
            assert!(error.help.unwrap_or_default().contains(help), "{wrong}");
        }
    }
}

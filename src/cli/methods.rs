//! `khatt methods`: what can be chosen.

use super::{Outcome, say};
use clap::Args;
use khatt::{corner, fit, quadratic, recognise};
use serde::Serialize;

/// Lists the methods one can choose, with their options' defaults
#[derive(Debug, Args)]
pub(crate) struct Methods {
    /// As JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Row {
    stage: &'static str,
    method: &'static str,
    about: &'static str,
    options: serde_json::Value,
}

impl Methods {
    pub(crate) fn run(&self) -> Outcome {
        let rows = rows();
        if self.json {
            let text = format!("{:#}\n", serde_json::json!(rows));
            return say::print(text.as_bytes());
        }
        let (mut text, mut stage) = (String::new(), "");
        for row in &rows {
            if row.stage != stage {
                stage = row.stage;
                text += &format!("{stage}:\n");
            }
            text += &format!("  {:<12}  {}\n", row.method, row.about);
        }
        say::print(text.as_bytes())
    }
}

/// A row for each method of a menu, its options with their defaults.
macro_rules! rows {
    ($stage:literal, $menu:ty) => {
        <$menu>::all().into_iter().map(|m| Row {
            stage: $stage,
            method: m.key(),
            about: m.about(),
            options: options(&m),
        })
    };
}

fn rows() -> Vec<Row> {
    let corners = rows!("corners", corner::Method);
    let fitters = rows!("fit", fit::Method);
    let quadratics = rows!("quadratic", quadratic::Method);
    let matching = rows!("match", recognise::Method);
    corners
        .chain(fitters)
        .chain(quadratics)
        .chain(matching)
        .collect()
}

/// The options of a method without its name.
fn options(method: &impl Serialize) -> serde_json::Value {
    match serde_json::json!(method) {
        serde_json::Value::Object(mut table) => {
            table.remove("method");
            serde_json::Value::Object(table)
        }
        _ => serde_json::json!({}),
    }
}

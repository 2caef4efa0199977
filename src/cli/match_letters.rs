//! `khatt match`: which letters the cells hold.

use super::project::Opened;
use super::{Common, Outcome, say};
use clap::Args;
use khatt::pipeline::{Matched, match_letters};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Guesses that are told of a cell.
const TOLD: usize = 3;

/// Tells which letters the cells look like, and whether the labels say so
#[derive(Debug, Args)]
pub(crate) struct Match {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// TTF or OTF font to compare with; several may be given [default: the project's]
    #[arg(long, value_name = "FONT")]
    reference: Vec<PathBuf>,
    /// As JSON
    #[arg(long)]
    json: bool,
}

impl Match {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let mut opened = Opened::new(&self.project)?;
        if !self.reference.is_empty() {
            opened.compare_with(&self.reference);
        }
        let ((cells, remarks), ..) = opened.work(common, match_letters)?;
        if self.json {
            let cells: Vec<Value> = cells.iter().map(entry).collect();
            let remarks: Vec<String> = remarks.iter().map(ToString::to_string).collect();
            let text = format!("{:#}\n", json!({ "cells": cells, "remarks": remarks }));
            return say::print(text.as_bytes());
        }
        let lines = cells.iter().map(line);
        let lines = lines.chain(remarks.iter().map(ToString::to_string));
        let text: String = lines.map(|line| line + "\n").collect();
        say::print(text.as_bytes())
    }
}

fn entry(cell: &Matched) -> Value {
    let guesses = cell.guesses.iter().take(TOLD);
    json!({
        "sheet": cell.place.sheet,
        "cell": cell.place.index + 1,
        "label": cell.place.label,
        "guesses": guesses.collect::<Vec<_>>(),
    })
}

/// The cell, then letter, distance and confidence of each guess.
fn line(cell: &Matched) -> String {
    let mut out = format!("{:<36}", cell.place.to_string());
    for g in cell.guesses.iter().take(TOLD) {
        out += &format!(
            "  {:<12} {:.4} {:>3.0} %",
            g.label,
            g.distance,
            100.0 * g.confidence
        );
    }
    out
}

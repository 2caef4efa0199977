//! The palette of a font whose letters are drawn in several inks.

use super::page::Page;
use super::project::Project;
use crate::scan::Colour;

/// The inks that are layers and how they look, red, green and blue: in the order in which the project names them,
/// each as the mean of its pages, by their ink.
pub(super) fn of(project: &Project, pages: &[Page]) -> Vec<(String, [u8; 3])> {
    let named = project.sheets.iter().flat_map(|s| s.ink.layers());
    let mut palette: Vec<(String, [u8; 3])> = Vec::new();
    for ink in named.map(|&ink| String::from(ink)) {
        let seen = || {
            let colours = pages.iter().flat_map(|p| &p.cut.colours);
            colours.filter(|c| c.ink == ink)
        };
        if seen().next().is_some() && palette.iter().all(|p| p.0 != ink) {
            let rgb = [0, 1, 2].map(|channel| mean(seen(), channel));
            palette.push((ink, rgb));
        }
    }
    palette
}

fn mean<'a>(colours: impl Iterator<Item = &'a Colour>, channel: usize) -> u8 {
    let add = |(sum, area): (usize, usize), c: &Colour| {
        (
            sum + usize::from(c.rgb[channel]) * c.area_px,
            area + c.area_px,
        )
    };
    let (sum, area) = colours.fold((0, 0), add);
    u8::try_from((sum + area / 2) / area.max(1)).unwrap_or(u8::MAX)
}

//! A UFO built again keeps what was done to it by hand.
//!
//! Every build notes in the UFO what it wrote (`khatt.built` in the libs of the font and of each glyph). Of each
//! thing that both a hand and a build can change — a glyph's outline, one anchor, one kerning pair, one group, a
//! field of the font's information, the features — there are then three states: built last time, lying in the UFO,
//! built now. What only one side has changed is taken from that side; where both did, the hand's stays and is named.
//! What no build writes is left alone: notes, guidelines, colours, layers, images, further glyphs and lib keys.

use super::WriteError;
use super::ufo::files::{bytes, failed, load};
use super::ufo::has_layers;
use super::ufo::states::{
    ANCHOR, CHARACTERS, FEATURES, GROUP, INFORMATION, KERNING, OUTLINE, States, font_states,
    glyph_states, information, pairs, signed,
};
use crate::types::Files;
use crate::types::formats::{COLOUR_KEYS, GLYPH_ORDER};
use norad::{Anchor, Font, Glyph};
use plist::Value;
use std::collections::BTreeSet;

/// Folders of a UFO whose files nobody reads here.
const OTHERS: [&str; 2] = ["data/", "images/"];

/// What was kept of the work of hands.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Kept {
    /// What only a hand has changed: that stays.
    pub kept: Vec<String>,
    /// What hand and build have both changed: the hand's stays.
    pub conflicts: Vec<String>,
}

/// Whose state is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Build,
    Hand,
}

/// The UFO `new` with what hands did to `old` since it was built.
///
/// # Errors
/// One of them is no UFO that can be read, or the result cannot be written.
pub fn merge(old: &Files, new: &Files) -> Result<(Files, Kept), WriteError> {
    let (hand, build) = (load(old)?, load(new)?);
    let mut merge = Merge::default();
    let mut out = hand.clone();
    merge.glyphs(&hand, &build, &mut out)?;
    merge.font(&hand, &build, &mut out)?;
    let mut files = bytes(&out)?;
    let others = old
        .0
        .iter()
        .filter(|(name, _)| OTHERS.iter().any(|o| name.starts_with(o)));
    files
        .0
        .extend(others.map(|(name, content)| (name.clone(), content.clone())));
    Ok((files, merge.kept))
}

/// Whether khatt has made the UFO whose `lib.plist` that is.
#[must_use]
pub fn is_built(lib: &[u8]) -> bool {
    let lib = plist::from_bytes::<Value>(lib);
    lib.is_ok_and(|lib| lib.as_dictionary().and_then(signed).is_some())
}

#[derive(Default)]
struct Merge {
    kept: Kept,
}

/// A thing's states: built last time, lying there, built now.
struct Three<'a> {
    built: &'a States,
    hand: &'a States,
    build: &'a States,
}

impl Merge {
    /// Whose state of `thing` is taken; `of` says what it belongs to.
    fn side(&mut self, three: &Three<'_>, thing: &str, of: &str) -> Side {
        let get = |states: &States| states.get(thing).cloned();
        let (built, hand, build) = (get(three.built), get(three.hand), get(three.build));
        if hand == build || hand == built {
            return Side::Build;
        }
        let list = if build == built {
            &mut self.kept.kept
        } else {
            &mut self.kept.conflicts
        };
        list.push(format!("{thing}{of}"));
        Side::Hand
    }

    fn glyphs(&mut self, hand: &Font, build: &Font, out: &mut Font) -> Result<(), WriteError> {
        let empty = States::new();
        for new in build.default_layer().iter() {
            let states = glyph_states(new);
            let Some(old) = hand.get_glyph(new.name()) else {
                out.default_layer_mut().insert_glyph(new.clone());
                continue;
            };
            let built = signed(&old.lib);
            let three = Three {
                built: built.as_ref().unwrap_or(&empty),
                hand: &glyph_states(old),
                build: &states,
            };
            let glyph = self.glyph(old, new, &three);
            out.default_layer_mut().insert_glyph(glyph);
        }
        for old in hand
            .default_layer()
            .iter()
            .filter(|g| build.get_glyph(g.name()).is_none())
        {
            match signed(&old.lib) {
                Some(built) if built == glyph_states(old) => {
                    out.default_layer_mut().remove_glyph(old.name());
                }
                Some(_) => self
                    .kept
                    .conflicts
                    .push(format!("{}, which is not built any more,", old.name())),
                None => self.kept.kept.push(format!("glyph {}", old.name())),
            }
        }
        let order = |font: &Font| -> Vec<String> {
            let list = font.lib.get(GLYPH_ORDER).and_then(Value::as_array);
            let names = list.into_iter().flatten().filter_map(Value::as_string);
            names.map(str::to_owned).collect()
        };
        let (mut names, listed) = (
            order(build),
            order(build).into_iter().collect::<BTreeSet<_>>(),
        );
        let more = out.default_layer().iter().map(|g| g.name().to_string());
        names.extend(more.filter(|n| !listed.contains(n)));
        let names = names.into_iter().map(Value::from).collect();
        out.lib.extend(build.lib.clone());
        if !has_layers(out) {
            for key in COLOUR_KEYS {
                out.lib.remove(key);
            }
        }
        out.lib.insert(GLYPH_ORDER.to_owned(), Value::Array(names));
        Ok(())
    }

    fn glyph(&mut self, old: &Glyph, new: &Glyph, three: &Three<'_>) -> Glyph {
        let of = format!(" of {}", new.name());
        let mut out = old.clone();
        if self.side(three, OUTLINE, &of) == Side::Build {
            out.width = new.width;
            out.contours.clone_from(&new.contours);
            out.components.clone_from(&new.components);
        }
        if self.side(three, CHARACTERS, &of) == Side::Build {
            out.codepoints = new.codepoints.clone();
        }
        let things: BTreeSet<&String> = three.hand.keys().chain(three.build.keys()).collect();
        for thing in things {
            let Some(name) = thing.strip_prefix(ANCHOR) else {
                continue;
            };
            if self.side(three, thing, &of) == Side::Build {
                let is_it = |a: &Anchor| a.name.as_ref().is_some_and(|n| n.as_str() == name);
                out.anchors.retain(|a| !is_it(a));
                out.anchors
                    .extend(new.anchors.iter().find(|a| is_it(a)).cloned());
            }
        }
        out.lib.extend(new.lib.clone());
        out
    }

    fn font(&mut self, hand: &Font, build: &Font, out: &mut Font) -> Result<(), WriteError> {
        let built = signed(&hand.lib).unwrap_or_default();
        let (old, new) = (font_states(hand)?, font_states(build)?);
        let three = Three {
            built: &built,
            hand: &old,
            build: &new,
        };
        if self.side(&three, FEATURES, "") == Side::Build {
            out.features.clone_from(&build.features);
        }
        let (mut info, new_info) = (information(hand)?, information(build)?);
        let (mut kerning, new_kerning) = (pairs(hand), pairs(build));
        let things: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
        for thing in things {
            if thing == FEATURES || self.side(&three, thing, "") == Side::Hand {
                continue;
            }
            if let Some(key) = thing.strip_prefix(INFORMATION) {
                info.remove(key);
                info.extend(new_info.get(key).map(|v| (key.to_owned(), v.clone())));
            } else if let Some(name) = thing.strip_prefix(GROUP) {
                out.groups.remove(name);
                let group = build.groups.get_key_value(name);
                out.groups
                    .extend(group.map(|(n, m)| (n.clone(), m.clone())));
            } else if let Some((a, b)) = thing.strip_prefix(KERNING).and_then(|p| p.split_once(' '))
            {
                kerning.retain(|(first, second), _| first.as_str() != a || second.as_str() != b);
                let pair = new_kerning
                    .iter()
                    .find(|((f, s), _)| f.as_str() == a && s.as_str() == b);
                kerning.extend(pair.map(|(k, v)| (k.clone(), *v)));
            }
        }
        out.font_info = plist::from_value(&Value::Dictionary(info)).map_err(|e| failed(&e))?;
        out.kerning.clear();
        for ((first, second), value) in kerning {
            out.kerning.entry(first).or_default().insert(second, value);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types;
    use crate::write::ufo;
    use crate::write::ufo::states::sign_glyph;
    use kurbo::{Point, Rect, Shape};
    use norad::Name;

    /// A UFO of A and V, as high as said.
    fn built(height: f64, kern: f64) -> Files {
        let glyph = |name: &str, c: char, height: f64| types::Glyph {
            outline: types::Outline::new(vec![Rect::new(0.0, 0.0, 100.0, height).to_path(0.1)])
                .unwrap(),
            anchors: vec![types::Anchor {
                name: "top".to_owned(),
                at: Point::new(50.0, height),
            }],
            ..types::Glyph::new(types::Name::new(name).unwrap(), vec![c], 120.0)
        };
        let notdef = types::Glyph::new(types::Name::notdef(), Vec::new(), 500.0);
        let glyphs = vec![notdef, glyph("A", 'A', height), glyph("V", 'V', 700.0)];
        let mut font = types::Font::new(types::Info::default(), glyphs).unwrap();
        font.kerning
            .pairs
            .insert(("A".to_owned(), "V".to_owned()), kern);
        ufo::files(&font).unwrap()
    }

    /// The UFO after a hand has worked on it.
    fn edited(files: &Files, edit: impl FnOnce(&mut Font)) -> Files {
        let mut font = load(files).unwrap();
        edit(&mut font);
        bytes(&font).unwrap()
    }

    fn wider(font: &mut Font) {
        font.get_glyph_mut("V").unwrap().width = 130.0;
    }

    fn merged(old: &Files, new: &Files) -> (Font, Kept) {
        let (files, kept) = merge(old, new).unwrap();
        (load(&files).unwrap(), kept)
    }

    #[test]
    fn nothing_by_hand_gives_the_build() {
        for new in [built(700.0, -40.0), built(650.0, -50.0)] {
            let (files, kept) = merge(&built(700.0, -40.0), &new).unwrap();
            assert_eq!(kept, Kept::default());
            assert!(files == new, "the same files");
        }
    }

    #[test]
    fn characters_that_xml_cannot_hold_are_noted_by_number() {
        let mut glyph = Glyph::new("nul");
        glyph.codepoints = norad::Codepoints::new(['\0', '\u{8}', '\u{1D}', '\u{FFFF}', 'A']);
        sign_glyph(&mut glyph);
        let noted = signed(&glyph.lib).unwrap();
        assert_eq!(noted[CHARACTERS], "U+0000U+0008U+001DU+FFFFA");
    }

    #[test]
    fn a_glyph_an_anchor_and_a_pair_by_hand_stay() {
        let name = |n: &str| Name::new(n).unwrap();
        let old = edited(&built(700.0, -40.0), |font| {
            wider(font);
            let a = font.get_glyph_mut("A").unwrap();
            a.anchors
                .push(Anchor::new(90.0, 0.0, Some(name("ogonek")), None, None));
            a.note = Some("look again".to_owned());
            font.kerning
                .entry(name("V"))
                .or_default()
                .insert(name("A"), -60.0);
            font.default_layer_mut().insert_glyph(Glyph::new("logo"));
            font.font_info.note = Some("by hand".to_owned());
        });
        // the build has changed A and the pair that it had made
        let (font, kept) = merged(&old, &built(650.0, -50.0));
        let want = [
            "anchor ogonek of A",
            "outline of V",
            "glyph logo",
            "font information note",
            "kerning V A",
        ];
        assert_eq!(kept.kept, want);
        assert!(kept.conflicts.is_empty(), "{kept:?}");
        let (a, v) = (font.get_glyph("A").unwrap(), font.get_glyph("V").unwrap());
        assert!((v.width - 130.0).abs() < 1e-9);
        assert_eq!(
            (a.anchors.len(), a.note.as_deref()),
            (2, Some("look again"))
        );
        assert!(
            a.contours[0]
                .points
                .iter()
                .any(|p| (p.y - 650.0).abs() < 1e-9),
            "built anew"
        );
        assert_eq!(
            pairs(&font).values().copied().collect::<Vec<_>>(),
            [-50.0, -60.0]
        );
        assert!(font.get_glyph("logo").is_some());

        // a third build knows again what is by hand
        let again = merge(&bytes(&font).unwrap(), &built(600.0, -50.0)).unwrap();
        assert_eq!(again.1.kept, want);
    }

    #[test]
    fn where_both_changed_the_hands_stays_and_is_named() {
        let name = |n: &str| Name::new(n).unwrap();
        let old = edited(&built(700.0, -40.0), |font| {
            font.get_glyph_mut("A").unwrap().width = 140.0;
            font.kerning
                .get_mut(&name("A"))
                .unwrap()
                .insert(name("V"), -90.0);
        });
        let (font, kept) = merged(&old, &built(650.0, -50.0));
        assert_eq!(kept.conflicts, ["outline of A", "kerning A V"]);
        assert!((font.get_glyph("A").unwrap().width - 140.0).abs() < 1e-9);
        assert_eq!(pairs(&font).values().copied().collect::<Vec<_>>(), [-90.0]);
    }

    #[test]
    fn a_glyph_that_is_not_built_any_more_goes_unless_a_hand_was_at_it() {
        let old = edited(&built(700.0, -40.0), |font| {
            for gone in ["W", "X"] {
                let mut glyph = font.get_glyph("A").unwrap().clone();
                glyph.codepoints.clear();
                font.default_layer_mut().insert_glyph(Glyph::new(gone));
                sign_glyph(font.get_glyph_mut(gone).unwrap());
            }
            font.get_glyph_mut("X").unwrap().width = 1.0;
        });
        let (font, kept) = merged(&old, &built(700.0, -40.0));
        assert!(font.get_glyph("W").is_none() && font.get_glyph("X").is_some());
        assert_eq!(kept.conflicts, ["X, which is not built any more,"]);
    }

    #[test]
    fn images_and_data_are_carried_over_and_what_is_no_ufo_is_refused() {
        let mut old = built(700.0, -40.0);
        old.0.insert("images/a.png".to_owned(), vec![1, 2]);
        let (files, _) = merge(&old, &built(700.0, -40.0)).unwrap();
        assert_eq!(files.0["images/a.png"], [1, 2]);
        assert!(merge(&Files::default(), &built(700.0, -40.0)).is_err());
    }
}

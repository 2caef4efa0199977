//! What pieces are, by what is seen of them and their names.

use super::costs::{WITHIN, misfit};
use super::*;
use crate::types::Label;

fn shapes(names: &str) -> Vec<Option<Shape>> {
    let shape = |n: &str| (n != "_").then(|| Shape::of(&Label(n.to_owned())));
    names.split(' ').map(shape).collect()
}

fn align(pieces: &[Seen], shapes: &[Option<Shape>]) -> Reading {
    super::align(pieces, Names { shapes, lines: &[] })
}

fn letter() -> Seen {
    Seen {
        full: 1.0,
        slight: false,
        above: false,
        below: false,
        inside: false,
        body: None,
        within: false,
        dirt: false,
        first: false,
        letters: 1,
    }
}

/// A sign over the letter that is read before it.
fn sign(full: f64) -> Seen {
    let body = Body {
        off: 0.2,
        before: true,
        sign: Side::Over,
    };
    Seen {
        full,
        body: Some(body),
        ..letter()
    }
}

/// The same over the letter that is read after it.
fn read_first(sign: Seen) -> Seen {
    let body = sign.body.map(|body| Body {
        before: false,
        ..body
    });
    Seen { body, ..sign }
}

fn under_signs() -> Seen {
    Seen {
        above: true,
        ..letter()
    }
}

#[test]
fn a_sign_is_a_part_and_a_small_letter_a_letter() {
    // alef with hamza, hamza, theh with three dots, one of them read first
    let pieces = [
        under_signs(),
        sign(0.4),
        Seen {
            full: 0.4,
            ..letter()
        },
        read_first(sign(0.0)),
        under_signs(),
        sign(0.0),
        sign(0.0),
    ];
    let reading = align(&pieces, &shapes("uni0623 uni0621 uni062B"));
    let part = Role::Part;
    let want = [
        Role::Letter(0),
        part,
        Role::Letter(1),
        part,
        Role::Letter(2),
        part,
        part,
    ];
    assert_eq!(reading.roles, want);
    assert!(reading.agrees());
}

#[test]
fn dirt_takes_no_name() {
    let mote = Seen {
        full: 0.0,
        dirt: true,
        ..letter()
    };
    let pieces = [mote, letter(), mote, letter(), mote];
    let reading = align(&pieces, &shapes("uni062F uni0631"));
    let want = [
        Role::Dirt,
        Role::Letter(0),
        Role::Dirt,
        Role::Letter(1),
        Role::Dirt,
    ];
    assert_eq!(reading.roles, want);
}

#[test]
fn dots_say_where_a_name_was_forgotten() {
    // dal, noon, dal, noon, dal; the names lack the second dal
    let noon = under_signs();
    let pieces = [
        letter(),
        noon,
        sign(0.0),
        letter(),
        noon,
        sign(0.0),
        letter(),
    ];
    let reading = align(&pieces, &shapes("uni062F uni0646 uni0646 uni062F"));
    assert_eq!(reading.roles[3], Role::Nameless);
    assert!(reading.missing.is_empty() && !reading.agrees());
}

#[test]
fn a_name_too_many_has_no_letter() {
    let reading = align(&[letter(); 3], &shapes("uni062F uni0631 uni062F uni0631"));
    assert_eq!(reading.missing.len(), 1);
    assert!(!reading.agrees());
}

#[test]
fn a_sign_within_its_letter_takes_no_name() {
    // kaf with its sign, as large as a letter, and qaf; the names have a letter more
    let within = Seen {
        within: true,
        ..sign(1.0)
    };
    let pieces = [letter(), within, letter()];
    let reading = align(&pieces, &shapes("uni0643 uni0642"));
    assert_eq!(reading.roles[1], Role::Part);
    let reading = align(&pieces, &shapes("uni0643 uni062F uni062F"));
    assert!(reading.cost >= WITHIN);
}

#[test]
fn a_wide_piece_has_the_names_of_letters_that_touch() {
    let wide = Seen {
        letters: 2,
        ..letter()
    };
    let pieces = [letter(), wide, letter()];
    let roles = |names: &str| align(&pieces, &shapes(names)).roles;
    let touching = [Role::Letter(0), Role::Touching(1, 2), Role::Letter(3)];
    assert_eq!(roles("uni062F uni0631 uni062F uni0631"), touching);
    let single = [Role::Letter(0), Role::Letter(1), Role::Letter(2)];
    assert_eq!(roles("uni062F uni0631 uni062F"), single);
}

#[test]
fn names_that_fit_two_letters_alike_are_in_doubt() {
    // one of the last two is a part of the other, and nothing tells which
    let part = Seen {
        above: true,
        ..sign(1.0)
    };
    let pieces = [letter(), read_first(part), part];
    let reading = align(&pieces, &shapes("uni062F uni0646"));
    assert!(reading.agrees());
    assert_eq!(reading.doubtful(), [1]);
    assert!(
        align(&[letter(); 2], &shapes("uni062F uni0631"))
            .doubtful()
            .is_empty()
    );
}

#[test]
fn letters_that_look_like_none_of_their_names_do_not_agree() {
    let pieces = [Seen {
        full: 0.3,
        ..letter()
    }; 4];
    let reading = align(&pieces, &shapes("uni0646 uni062E uni0634 uni0646"));
    assert!(reading.missing.is_empty() && !reading.agrees());
    assert!(align(&[letter(); 4], &shapes("uni0646 uni062E uni0634 uni0646")).agrees());
}

#[test]
fn a_dot_beside_a_letter_has_no_letters_name() {
    // noon and its dot, dal; the names have a letter more
    let dot = Seen {
        slight: true,
        ..sign(0.0)
    };
    let pieces = [under_signs(), dot, letter()];
    let reading = align(&pieces, &shapes("uni0646 uni0645 uni062F"));
    assert_eq!(reading.roles[1], Role::Part);
    assert_eq!(reading.missing.len(), 1);
    // a comma is as small
    let comma = align(&[letter(), dot], &shapes("uni062F uni060C"));
    assert_eq!(comma.roles[1], Role::Letter(1));
}

#[test]
fn a_name_without_which_the_page_is_likelier_is_spare() {
    // theh, a dot of its three that lies below another one, dal
    let dot = Seen {
        above: true,
        body: Some(Body {
            off: 0.0,
            before: true,
            sign: Side::Over,
        }),
        ..sign(0.0)
    };
    let pieces = [under_signs(), dot, letter()];
    let reading = align(&pieces, &shapes("uni062B uni0645 uni062F"));
    assert!(reading.agrees());
    // the last letter may be a meem as well
    assert_eq!(reading.spare(), Some(1..=2));
    assert_eq!(align(&pieces, &shapes("uni062B uni062F")).spare(), None);
    // a letter of its own is as likely as none
    let reading = align(&[letter(); 3], &shapes("uni062F uni0631 uni062F"));
    assert_eq!(reading.spare(), None);
}

#[test]
fn a_dot_within_its_letter_is_on_either_side() {
    let within = Seen {
        inside: true,
        ..letter()
    };
    let cost = |name: &str| misfit(&within, &shapes(name)[0].unwrap());
    assert!(cost("uni062C") + cost("uni062E") < 1e-9);
    assert!(cost("uni062D") > 0.0);
}

#[test]
fn nothing_is_read_as_nothing() {
    assert_eq!(align(&[], &[]).roles, []);
    assert_eq!(align(&[], &shapes("a b")).missing, [(0, 0), (1, 0)]);
    assert_eq!(align(&[letter()], &[]).roles, [Role::Nameless]);
}

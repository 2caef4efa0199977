use super::*;
use kurbo::BezPath;

impl Draft {
    /// Contours under a name.
    pub(super) fn drawn(label: &str, contours: Vec<BezPath>) -> Self {
        let id = names::identify(&Label(label.to_owned())).unwrap();
        Self::new(id, Outline::new(contours).unwrap())
    }
}

fn drawn(label: &str) -> Drawn {
    // a stem on a stroke that leaves it to both sides
    let shape = "M0 0L500 0L500 60L300 60L300 500L200 500L200 60L0 60Z";
    Drawn {
        label: Label(label.to_owned()),
        outline: Outline::new(vec![BezPath::from_svg(shape).unwrap()]).unwrap(),
        plates: Vec::new(),
        advance: None,
    }
}

fn build(labels: &[&str]) -> Assembled {
    let shapes = labels.iter().map(|l| drawn(l)).collect();
    font(shapes, Info::default(), &Options::default()).unwrap()
}

#[test]
fn basic_glyphs_are_always_there() {
    for labels in [&["A"][..], &[], &["space", "A"], &[".notdef"], &["uni00A0"]] {
        let font = build(labels).font;
        let names: Vec<_> = font
            .glyphs()
            .iter()
            .take(3)
            .map(|g| g.name.as_str())
            .collect();
        assert_eq!(names, [".notdef", "space", "uni00A0"], "{labels:?}");
        let [a, b] = [1, 2].map(|i: usize| font.glyphs()[i].advance);
        assert!((a - b).abs() < 1e-9, "{labels:?}");
        assert_eq!(font.glyphs()[1].codepoints, [' '], "{labels:?}");
    }
}

#[test]
fn features_follow_from_names() {
    let labels = [
        "ب",
        "uni0628.init",
        "uni0628.medi",
        "uni0628.fina",
        "lam-ar",
        "lam-ar.init",
        "lam-ar.medi",
        "alef-ar",
        "alef-ar.fina",
        "lam_alef-ar",
        "lam_alef-ar.fina",
        "f",
        "i",
        "f_i",
        "a",
        "a.ss01",
    ];
    let built = build(&labels);
    insta::with_settings!({
        snapshot_path => "../../snapshots",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, { insta::assert_snapshot!("features", built.font.features) });
    let told: Vec<&str> = built.notes.iter().map(|n| n.message.as_str()).collect();
    assert_eq!(
        told,
        [
            "it has .init and .medi but no .fina: there it stands unjoined within words; draw what is missing"
        ]
    );
}

/// Arabic letters, each in all forms that it takes.
fn arabic(letters: &str) -> Vec<String> {
    let joins_on = |c: char| get_joining_type(c) == JoiningType::DualJoining;
    let forms = |c: char| {
        let forms = ["", ".fina", ".init", ".medi"].into_iter();
        let forms = forms.take(if joins_on(c) { 4 } else { 2 });
        forms.map(move |form| format!("uni{:04X}{form}", u32::from(c)))
    };
    letters.chars().flat_map(forms).collect()
}

/// The font of these letters and labels.
fn with(letters: &str, labels: &[&str]) -> Assembled {
    let letters = arabic(letters);
    let all = letters
        .iter()
        .map(String::as_str)
        .chain(labels.iter().copied());
    build(&all.collect::<Vec<&str>>())
}

#[test]
fn a_ligature_takes_its_letters_in_the_forms_that_text_gives_them() {
    for (label, rule) in [
        ("الله", "uni0627 uni0644.init uni0644.medi uni0647.fina by"),
        (
            "الله.fina",
            "uni0627.fina uni0644.init uni0644.medi uni0647.fina by",
        ),
        ("ريال", "uni0631 uni064A.init uni0627.fina uni0644 by"),
        ("له.init", "uni0644.init uni0647.medi by"),
        ("له.medi", "uni0644.medi uni0647.medi by"),
        ("uni0644064E0647", "uni0644.init uni064E uni0647.fina by"),
        ("ﷲ", "uni0627 uni0644.init uni0644.medi uni0647.fina by"),
    ] {
        let built = with("الهري", &["uni064E", label]);
        assert!(
            built.font.features.contains(&format!("sub {rule} ")),
            "{label}: {}",
            built.font.features
        );
        assert!(built.notes.is_empty(), "{label}: {:?}", built.notes);
    }
    let built = with("ال", &["لا.init"]);
    assert_eq!(
        built.notes[0].message,
        "the ligature is never used: ا does not join as .init says; correct the suffix"
    );
    assert!(
        !built.font.features.contains("rlig"),
        "{}",
        built.font.features
    );
    let both = with("اله", &["الله", "ﷲ"]).font;
    assert!(
        both.features.contains("by uni0627064406440647;"),
        "{}",
        both.features
    );
    assert!(
        both.glyphs().iter().any(|g| g.codepoints == ['ﷲ']),
        "it can be typed"
    );
}

#[test]
fn a_suffix_that_says_nothing_is_told_with_the_nearest() {
    let labels = ["A", "A.alt", "A.ss21", "A.numr", "A.frac", "f", "f.swsh"];
    let notes = build(&labels).notes;
    let of = |glyph: &str| {
        notes
            .iter()
            .find(|n| n.glyph == glyph)
            .map(|n| n.message.as_str())
    };
    let of = |glyph: &str| of(glyph).unwrap_or_else(|| panic!("{glyph}: {notes:?}"));
    assert_eq!(notes.len(), 3, "{notes:?}");
    assert!(
        of("A.alt").ends_with("did you mean “.aalt” or “.calt” or “.salt”?"),
        "{notes:?}"
    );
    assert!(
        of("A.ss21").ends_with("is no joining form and no feature that replaces single glyphs"),
        "{notes:?}"
    );
    assert!(
        of("A.frac").contains("“.frac” is no joining form"),
        "{notes:?}"
    );
    for (wrong, right) in [("int", "init"), ("fin", "fina"), ("Medi", "medi")] {
        let label = format!("beh-ar.{wrong}");
        let notes = build(&["beh-ar", &label]).notes;
        assert!(
            notes[0]
                .message
                .ends_with(&format!("did you mean “.{right}”?")),
            "{notes:?}"
        );
    }
}

#[test]
fn forms_may_be_written_out() {
    let labels = [
        "beh-ar",
        "beh-ar.initial",
        "beh-ar.medial",
        "beh-ar.final",
        "seen-ar.isolated",
    ];
    let built = build(&labels);
    for form in ["initial", "medial", "final"] {
        let rule = format!("sub beh-ar by beh-ar.{form};");
        assert!(
            built.font.features.contains(&rule),
            "{}",
            built.font.features
        );
    }
    assert_eq!(
        built.font.glyph("seen-ar.isolated").unwrap().codepoints,
        ['س']
    );
    assert!(built.notes.is_empty(), "{:?}", built.notes);
}

#[test]
fn a_letter_without_some_of_its_forms_is_told() {
    // ى and د are whole so; of س no form is there
    let labels = [
        "ب", "ب.init", "ب.fina", "ى", "ى.fina", "د", "د.fina", "س", "ن.medi",
    ];
    let told: Vec<_> = build(&labels)
        .notes
        .into_iter()
        .map(|n| (n.glyph, n.message))
        .collect();
    let note = |glyph: &str, what: &str| {
        let rest = "there it stands unjoined within words; draw what is missing";
        (glyph.to_owned(), format!("it has {what}: {rest}"))
    };
    let want = [
        note("uni0628", ".init and .fina but no .medi"),
        note("uni0646", ".medi but no .init and .fina"),
    ];
    assert_eq!(told, want);
}

#[test]
fn capitals_of_all_kinds_come_before_ligatures() {
    let built = build(&["f", "i", "f_i", "f.smcp", "i.smcp", "f.ss01"]);
    let text = built.font.features;
    let at = |tag: &str| {
        text.find(&format!("feature {tag} {{"))
            .unwrap_or_else(|| panic!("{tag}: {text}"))
    };
    assert!(at("smcp") < at("liga") && at("liga") < at("ss01"), "{text}");
}

#[test]
fn a_ligature_with_a_suffix_alone_is_its_features() {
    let built = with(
        "لح",
        &[
            "s",
            "t",
            "f",
            "i",
            "s_t.dlig",
            "f_i.liga",
            "لح.init.dlig",
            "t.dlig",
        ],
    );
    let text = built.font.features;
    let dlig = "feature dlig {\n    lookupflag IgnoreMarks;\n    sub uni0644.init uni062D.medi by uni0644062D.init.dlig;\n    \
                lookupflag 0;\n    sub s t by s_t.dlig;\n    sub t by t.dlig;\n} dlig;";
    assert!(text.contains(dlig), "{text}");
    assert!(
        text.contains("feature liga {\n    sub f i by f_i.liga;\n} liga;"),
        "{text}"
    );
    assert!(built.notes.is_empty(), "{:?}", built.notes);
    let notes = build(&["s", "s_t.dlig", "s.liga"]).notes;
    let told: Vec<&str> = notes.iter().map(|n| n.glyph.as_str()).collect();
    assert_eq!(told, ["s_t.dlig", "s.liga"], "{notes:?}");
    assert!(notes[0].message.contains("its part t"), "{notes:?}");
}

#[test]
fn soft_dots_go_under_marks() {
    let letters = [
        "i",
        "j",
        "ı",
        "uni0237",
        "uni012F",
        "uni0328",
        "uni0323",
        "acutecomb",
    ];
    let text = build(&letters).font.features;
    for rule in [
        "lookup parted {\n    sub uni012F by dotlessi uni0328;\n} parted;",
        "    lookupflag UseMarkFilteringSet [acutecomb];\n    sub i' [acutecomb] by dotlessi;\n",
        "    sub j' [acutecomb] by uni0237;\n",
        "    sub uni012F' lookup parted [acutecomb];\n",
    ] {
        assert!(text.contains(rule), "{text}");
    }
    for without in [
        &["i", "ı"][..],
        &["i", "acutecomb"],
        &["i", "ı", "uni0323", "uni0651"],
    ] {
        let text = build(without).font.features;
        assert!(!text.contains("ccmp"), "{without:?}: {text}");
    }
}

#[test]
fn a_form_stands_in_for_a_missing_letter() {
    let font = build(&["beh-ar.fina", "beh-ar.init", "beh-ar.init.ss01"]).font;
    assert_eq!(font.glyph("beh-ar.fina").unwrap().codepoints, ['\u{628}']);
    assert!(
        font.features.contains("sub beh-ar.fina by beh-ar.init;"),
        "{}",
        font.features
    );
    assert!(
        font.features
            .contains("sub beh-ar.init by beh-ar.init.ss01;"),
        "{}",
        font.features
    );
}

#[test]
fn a_ligature_of_missing_parts_is_reported() {
    let notes = build(&["lam-ar", "lam_alef-ar"]).notes;
    assert_eq!(notes.len(), 1);
    assert!(notes[0].message.contains("U+0627"), "{}", notes[0].message);
}

#[test]
fn a_ligature_with_a_character_of_its_own_is_one_too() {
    let built = build(&["f", "i", "fi", "fl"]);
    assert!(
        built.font.features.contains("sub f i by fi;"),
        "{}",
        built.font.features
    );
    assert!(built.notes.is_empty(), "ﬂ can be typed: {:?}", built.notes);
    let both = build(&["f", "i", "fi", "f_i"]).font.features;
    assert!(
        both.contains("by f_i;") && !both.contains("by fi;"),
        "{both}"
    );
}

#[test]
fn presentation_forms_join() {
    let features = build(&["ﺏ", "ﺑ", "ﺒ", "ﺐ"]).font.features;
    for rule in [
        "sub uni0628 by uni0628.init;",
        "sub uni0628 by uni0628.medi;",
        "sub uni0628 by uni0628.fina;",
    ] {
        assert!(features.contains(rule), "{features}");
    }
}

#[test]
fn an_alternate_of_nothing_is_reported() {
    let notes = build(&["A", "A.ss01", "B.ss01"]).notes;
    let glyphs: Vec<&str> = notes.iter().map(|n| n.glyph.as_str()).collect();
    assert_eq!(glyphs, ["B.ss01"]);
}

#[test]
fn wrong_labels_are_errors_with_their_place() {
    let all = |labels: &[&str]| {
        let shapes = labels.iter().map(|l| drawn(l)).collect();
        font(shapes, Info::default(), &Options::default())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        all(&["A", "beh-arr"]),
        "glyph 2: “beh-arr” is no known glyph name; did you mean “beh-ar”?"
    );
    assert_eq!(
        all(&["A", "b", "A"]),
        "glyphs 1 and 3 are both A; rename one or skip its cell with “_”"
    );
    assert!(all(&["beh-ar", "uni0628"]).contains("U+0628"));
}

#[test]
fn a_body_that_no_stroke_leaves_stays_as_drawn() {
    // a stem that is met, with a notch inside; a bow; a tooth
    let bodies = [
        "M0 0L300 0L300 400L220 400L220 60L60 60L40 90L60 120L0 120Z",
        "M0 0L200 -40C270 -40 300 0 300 50C300 120 250 160 200 160L0 160Z",
        "M0 0L290 0L300 20L270 180L250 180L210 60L0 60Z",
    ];
    for svg in bodies {
        let body = Drawn {
            outline: Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap(),
            ..drawn("dal-ar.fina")
        };
        let labels = ["beh-ar.medi", "teh-ar.medi", "seen-ar.medi"];
        let shapes = labels.iter().map(|l| drawn(l)).chain([body.clone()]);
        let built = font(shapes.collect(), Info::default(), &Options::default()).unwrap();
        let other = built
            .notes
            .iter()
            .find(|n| !n.message.starts_with("it has .medi but"));
        assert_eq!(other, None, "{svg}");
        let glyph = built.font.glyph("dal-ar.fina").unwrap();
        let (was, is) = (body.outline.bounds().unwrap(), glyph.outline.bounds());
        let is = is.unwrap();
        let met = glyph.advance - is.x1;
        assert!((-20.0..=0.5).contains(&met), "{svg}: {met}");
        let off =
            |p: Option<kurbo::Point>, q: Option<kurbo::Point>| p.zip(q).map(|(p, q)| p.distance(q));
        let home = glyph
            .outline
            .transformed(Affine::translate((was.x0 - is.x0, 0.0)));
        let pairs = home.contours()[0]
            .iter()
            .zip(body.outline.contours()[0].iter());
        let moved = pairs.filter_map(|(a, b)| off(a.end_point(), b.end_point()));
        assert!(
            moved.fold(0.0, f64::max) < 0.75,
            "{svg}: {:?}",
            home.contours()
        );
    }
}

#[test]
fn a_stem_is_met_where_strokes_come_to_it() {
    let mut alef = drawn("uni0627.fina");
    let stem = BezPath::from_svg("M0 0L90 -20L90 700L0 700Z").unwrap();
    alef.outline = Outline::new(vec![stem]).unwrap();
    let options = Options {
        joining: joining::Options {
            method: joining::Method::Cursive,
            ..joining::Options::default()
        },
        ..Options::default()
    };
    let shapes = vec![drawn("uni0628.init"), drawn("uni0628.fina"), alef];
    let built = font(shapes, Info::default(), &options).unwrap();
    let glyph = |name: &str| {
        built
            .font
            .glyphs()
            .iter()
            .find(|g| g.name.as_str() == name)
            .unwrap()
    };
    let at = |name: &str, anchor: &str| {
        let anchors = glyph(name).anchors.iter();
        anchors
            .filter(|a| a.name == anchor)
            .map(|a| a.at)
            .next()
            .unwrap()
    };
    let (exit, entry) = (at("uni0628.init", "exit"), at("uni0627.fina", "entry"));
    assert!((exit.y - entry.y).abs() < 1.0, "{exit:?} {entry:?}");
    // the stroke ends within the stem
    let alef = glyph("uni0627.fina");
    let right = alef.outline.bounds().unwrap().x1;
    assert!(
        (entry.x - alef.advance).abs() < 1e-9 && entry.x < right,
        "{entry:?}"
    );
}

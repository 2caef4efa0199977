//! Captions in single strokes: the same in SVG, PDF and PNG, and no font to carry.

use kurbo::{BezPath, Point};

/// Strokes of a character as pairs of digits x y, strokes parted by `|`. x 0…4; y 0…8 upwards, descenders
/// end at 0, the baseline is 2, x-height 6, capitals 8.
const STROKES: &[(char, &str)] = &[
    ('A', "022842|1434"),
    ('B', "02083847463505|3544433202"),
    ('C', "4738180703123243"),
    ('D', "02082846442202"),
    ('E', "48080242|0535"),
    ('F', "480802|0535"),
    ('G', "47381807031232434525"),
    ('H', "0802|4842|0545"),
    ('I', "1838|2822|1232"),
    ('J', "4843321203"),
    ('K', "0802|480542"),
    ('L', "080242"),
    ('M', "0208254842"),
    ('N', "02084248"),
    ('O', "183847433212030718"),
    ('P', "02083847463505"),
    ('Q', "183847433212030718|2442"),
    ('R', "02083847463505|2542"),
    ('S', "473818070615354443321203"),
    ('T', "0848|2822"),
    ('U', "080312324348"),
    ('V', "082248"),
    ('W', "0812263248"),
    ('X', "0842|0248"),
    ('Y', "082548|2522"),
    ('Z', "08480242"),
    ('a', "4642|4536160503123243"),
    ('b', "0802|0516364543321203"),
    ('c', "4536160503123243"),
    ('d', "4842|4536160503123243"),
    ('e', "04444536160503123243"),
    ('f', "382722|1636"),
    ('g', "4641301001|4536160503123243"),
    ('h', "0802|0516364542"),
    ('i', "2622|2827"),
    ('j', "36312010|3837"),
    ('k', "0802|460442"),
    ('l', "282332"),
    ('m', "0206|05162522|25364542"),
    ('n', "0206|0516364542"),
    ('o', "163645433212030516"),
    ('p', "0600|0516364543321203"),
    ('q', "4640|4536160503123243"),
    ('r', "0602|041636"),
    ('s', "45361605143443321203"),
    ('t', "28233242|0646"),
    ('u', "0603123243|4642"),
    ('v', "062246"),
    ('w', "0612243246"),
    ('x', "0642|0246"),
    ('y', "0622|462210"),
    ('z', "06460242"),
    ('0', "183847433212030718|0347"),
    ('1', "172822|1232"),
    ('2', "07183847460242"),
    ('3', "0718384746354443321203|1535"),
    ('4', "32380444"),
    ('5', "480805354443321203"),
    ('6', "38180703123243443505"),
    ('7', "084822"),
    ('8', "183847463515060718|1504031232434435"),
    ('9', "45150607183847433212"),
    ('.', "2223"),
    (',', "2311"),
    (':', "2324|2627"),
    ('_', "0141"),
    ('-', "1535"),
    ('+', "0545|2723"),
    ('/', "0148"),
    ('(', "38161332"),
    (')', "18363312"),
    (' ', ""),
];

/// The box for a character without strokes.
const UNKNOWN: &str = "0208484202";
/// Units between the starts of two characters; the widest is 4.
const PITCH: f64 = 6.0;
/// Units from the lowest to the highest stroke.
const HEIGHT: f64 = 8.0;

/// Strokes of `text` in mm, y down, its top left corner at `corner`, `height` mm from the highest to the
/// lowest stroke, pressed together where it would be wider than `width` mm.
pub(super) fn strokes(text: &str, corner: Point, height: f64, width: f64) -> BezPath {
    let unit = height / HEIGHT;
    let squeeze = (width / (text.chars().count().max(1) as f64 * PITCH * unit)).min(1.0);
    let mut path = BezPath::new();
    for (i, c) in text.chars().enumerate() {
        let known = STROKES.iter().find(|(k, _)| *k == c);
        let left = i as f64 * PITCH;
        for stroke in known.map_or(UNKNOWN, |(_, s)| s).split('|') {
            let digits: Vec<f64> = stroke
                .chars()
                .filter_map(|d| d.to_digit(10))
                .map(f64::from)
                .collect();
            for (k, xy) in digits.chunks_exact(2).enumerate() {
                let x = (left + xy[0]) * unit * squeeze;
                let p = corner + (x, (HEIGHT - xy[1]) * unit);
                if k == 0 {
                    path.move_to(p)
                } else {
                    path.line_to(p)
                }
            }
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    #[test]
    fn every_name_character_has_its_own_strokes() {
        let all: Vec<char> = ('a'..='z')
            .chain('A'..='Z')
            .chain('0'..='9')
            .chain(['.', '_', '-'])
            .collect();
        let drawn: Vec<String> = all
            .iter()
            .map(|c| strokes(&c.to_string(), Point::ORIGIN, 8.0, 99.0).to_svg())
            .collect();
        for (i, a) in drawn.iter().enumerate() {
            assert!(a.len() > 4, "{} has no strokes", all[i]);
            for (j, b) in drawn[..i].iter().enumerate() {
                assert_ne!(a, b, "{} and {} look alike", all[i], all[j]);
            }
        }
    }

    #[test]
    fn long_captions_are_pressed_into_their_width() {
        let path = strokes("uni06440627.fina", Point::new(1.0, 2.0), 2.0, 12.0);
        let b = path.bounding_box();
        assert!(
            b.x0 >= 1.0 && b.x1 <= 13.0 && b.y0 >= 2.0 && b.y1 <= 4.0,
            "{b:?}"
        );
    }
}

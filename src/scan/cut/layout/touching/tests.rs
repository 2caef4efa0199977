use super::*;
use crate::scan::components::components;
use kurbo::Affine;

#[test]
fn the_surest_border_tells_where_the_next_letter_ends() {
    // the first two letters' strokes lie in line for 18 px, and pale pixels alone join the third one to the second
    let letters = [
        [(10.0, 10.0, 25.0, 110.0), (10.0, 100.0, 80.0, 110.0)],
        [(120.0, 20.0, 130.0, 110.0), (62.0, 100.0, 130.0, 110.0)],
        [(132.0, 60.0, 162.0, 70.0), (152.0, 20.0, 162.0, 120.0)],
    ];
    let bars = letters.as_flattened();
    let bars: Vec<Rect> = bars.iter().map(|b| Rect::new(b.0, b.1, b.2, b.3)).collect();
    let gray = Gray::from_fn(200, 140, |x, y| {
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let is_slit = Rect::new(130.0, 60.0, 132.0, 70.0).contains(p);
        if bars.iter().any(|b| b.contains(p)) {
            1.0
        } else if is_slit {
            0.4
        } else {
            0.0
        }
    });
    let upright = Surface::from(Affine::IDENTITY);
    let mut all = components(&gray, 0.25, 0.5);
    assert_eq!(all.len(), 1, "the letters touch");
    let end = |place: f64, meeting| End {
        stretch: place - 15.0..place + 15.0,
        meeting,
        examples: [Vec::new(), Vec::new()],
    };
    let ends = vec![end(70.5, Meeting::Strokes), end(121.5, Meeting::Any)];
    let touch = Touch::at(ends, (Along::Row, vec![0]), 51.0);
    let parted = touch.part(&mut all, (&gray, &upright)).pieces;
    assert_eq!(parted.len(), 3, "{parted:?}");
    let mut found: Vec<[f64; 2]> = all
        .iter()
        .map(|c| {
            let less =
                |x: usize, y: usize| c.shares.iter().any(|s| s.2 < 0.5 && (s.0, s.1) == (x, y));
            let own = c.pixels().filter(|&(x, y)| !less(x, y));
            own.fold([f64::INFINITY, 0.0_f64], |[from, to], (x, _)| {
                [from.min(x as f64), to.max(x as f64 + 1.0)]
            })
        })
        .collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for ([from, to], drawn) in found
        .into_iter()
        .zip([[10.0, 80.0], [62.0, 130.0], [132.0, 162.0]])
    {
        assert!(
            (from - drawn[0]).abs() <= 2.0 && (to - drawn[1]).abs() <= 2.0,
            "{from} to {to}, not {drawn:?}"
        );
    }
}

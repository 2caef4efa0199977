//! Letters of a page that lies askew stay on its pixels.

use super::*;

#[test]
fn letters_of_a_skewed_page_keep_its_pixels() {
    for skew in [0.0, 1.7, -4.0] {
        let page = clean(grid_page(skew).scan(), Texture::default()).unwrap();
        let cut = cut(&page, &labels(NAMES), &options(Layout::Grid(4, 5)), &[]).unwrap();
        let mut inked = 0;
        for cell in &cut.cells {
            let (gray, height) = (&cell.gray, cell.gray.height() as f64);
            assert!(skew.abs() < 0.1 || gray.upright() != Affine::IDENTITY);
            for (y, x) in (0..gray.height()).flat_map(|y| (0..gray.width()).map(move |x| (y, x))) {
                if gray.at(x, y) < 0.5 {
                    continue;
                }
                inked += 1;
                let drawn = gray.upright() * Point::new(x as f64 + 0.5, height - y as f64 - 0.5);
                let there = cell.to_sheet * Point::new(drawn.x, height - drawn.y);
                let (column, row) = (index(there.x), index(there.y));
                let off = there - Point::new(column as f64 + 0.5, row as f64 + 0.5);
                assert!(off.hypot() < 1e-6, "{there:?}");
                let (here, seen) = (gray.at(x, y), page.sheet.gray.at(column, row));
                assert!((here - seen).abs() < 1e-6, "{here} {seen}");
            }
        }
        assert!(inked > 1000, "{inked} pixels of ink");
    }
}

#!/usr/bin/env python3
"""Many fonts traced: how many are within each limit, which outlines cross where the font's do not, and how many
have more or fewer contours.

    python3 tests/bench/outlines.py --khatt target/release/khatt --bench ../shared/bench web-fonts/*.ttf

Pictures, comparison and limits are those of outline_bench.py; of a font with Arabic letters those are drawn, of others the
Latin ones. Needs shapely beside what that script needs.
"""
import argparse, collections, os, subprocess, sys, tempfile
from multiprocessing import Pool

LIMITS = {"clean": (0.05, 0.6), "scan": (0.10, 1.0)}
WORST, CORNERS = 3, 0.96
# an outline so far off has a part too much or too little
PART_PX = 2.5
WHAT = ("mean", "median max", "worst", "worst of glyphs that do not cross", "corner F1")


def crosses(polygons):
    from shapely.geometry import LinearRing

    rings = [LinearRing(polygon) for polygon in polygons if len(polygon) > 2]
    pairs = ((a, b) for k, a in enumerate(rings) for b in rings[:k])
    return any(not ring.is_simple for ring in rings) or any(a.crosses(b) for a, b in pairs)


def pictures(task):
    """The rows of a font: character, condition, its comparison or none, whether the tracing crosses and whether the font does,
    whether it has as many contours; and the corner F1 of its own outlines, begun half-way round."""
    import outline_bench as bench
    from fontTools.ttLib import TTFont
    from PIL import Image

    khatt, path, ppem = task
    font = TTFont(path)
    glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
    rows, own = [], []
    with tempfile.TemporaryDirectory() as folder:
        picture, svg = os.path.join(folder, "in.png"), os.path.join(folder, "out.svg")
        for char in bench.charset("arabic" if ord("ع") in cmap else "latin"):
            true = ord(char) in cmap and bench.true_outline(font, glyphs, cmap[ord(char)])
            if not true:
                continue
            drawn = crosses(bench.flatten(true, 0.5))
            begun = [contour[len(contour) // 2 :] + contour[: len(contour) // 2] for contour in true]
            own.append(bench.compare(true, begun, upem, ppem)["corner_f1"])
            for condition in LIMITS:
                image, (scale, left, foot) = bench.render(true, upem, ppem, 20, condition, ord(char))
                Image.fromarray(image).save(picture)
                run = subprocess.run([khatt, "--quiet", "trace", picture, "-o", svg], capture_output=True)
                if run.returncode:
                    rows.append((char, condition, None, False, drawn, False))
                    continue
                got = bench.svg_contours(open(svg).read())
                tangled = crosses(bench.flatten(got, 0.05))
                as_many = len(got) == len(true)
                got = [[tuple(((x - left) / scale, (foot - y) / scale) for x, y in s) for s in c] for c in got]
                found = bench.compare(true, bench.clean(got, upem * 2e-4), upem, ppem)
                rows.append((char, condition, found, tangled, drawn, as_many))
    return os.path.basename(path), rows, own


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--ppem", type=int, default=500)
    parser.add_argument("font", nargs="+")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    import numpy as np

    with Pool() as pool:
        fonts = list(pool.imap(pictures, [(args.khatt, path, args.ppem) for path in args.font]))
    print(f"| picture | fonts | {' | '.join(WHAT)} | means and median maxima, median of the fonts |")
    print(f"|---|---|{len(WHAT) * '---|'}---|")
    beyond = collections.defaultdict(list)
    for condition, (most, most_median) in LIMITS.items():
        figures = []
        for name, rows, _ in fonts:
            found = [row[2] for row in rows if row[1] == condition and row[2]]
            if not found:
                sys.exit(f"{name}: no letter of it was traced ({condition})")
            largest = [f["max"] for f in found]
            corners = [f["corner_f1"] for f in found if f["corner_f1"] is not None]
            plain = max((row[2]["max"] for row in rows if row[1] == condition and row[2] and not row[4]), default=0)
            row = np.mean([f["mean"] for f in found]), np.median(largest), max(largest), plain, np.mean(corners)
            figures.append(row)
            within = row[0] <= most, row[1] <= most_median, row[2] <= WORST, plain <= WORST, row[4] >= CORNERS
            for what, value, held in zip(WHAT, row, within):
                if not held:
                    beyond[condition, what].append(f"{name} {value:.3f}")
        counts = [len(figures) - len(beyond[condition, what]) for what in WHAT]
        medians = np.median([f[0] for f in figures]), np.median([f[1] for f in figures])
        print(f"| {condition} | {len(fonts)} | {' | '.join(map(str, counts))} | {medians[0]:.3f}, {medians[1]:.2f} |")
    rows = [(name, *row) for name, rows, _ in fonts for row in rows]
    found = [row for row in rows if row[3]]
    over = [row for row in found if row[3]["max"] > WORST]
    lost = [row for row in found if row[3]["max"] * args.ppem / 1000 > PART_PX]
    print(
        f"\n{len(rows)} pictures, {len(rows) - len(found)} failed; mean {np.mean([r[3]['mean'] for r in found]):.4f}, mean of the "
        f"maxima {np.mean([r[3]['max'] for r in found]):.4f}, above {PART_PX} px: {len(lost)}, above {WORST}: {len(over)}, of them "
        f"{sum(r[5] for r in over)} of glyphs that cross themselves (of {len({r[:2] for r in rows})} glyphs "
        f"{len({r[:2] for r in rows if r[5]})} do)"
    )
    new = [f"{name} {char} {condition}" for name, char, condition, _, tangled, drawn, _ in rows if tangled and not drawn]
    torn = sum(bool(row[3]) and not row[5] and not row[6] for row in rows)
    print(f"of glyphs that do not cross themselves, other numbers of contours than the font's: {torn}")
    print(f"cross where the font's outlines do not: {len(new)}: {', '.join(new)}")
    for (condition, what), names in beyond.items():
        if names:
            print(f"{condition}, beyond the limit of {what}: {', '.join(names)}")
    low = [f"{name} {np.mean(own):.3f}" for name, _, own in fonts if np.mean(own) < CORNERS]
    print(f"corner F1 of the fonts' own outlines, begun half-way round, below {CORNERS}: {', '.join(low) or 'none'}")


if __name__ == "__main__":
    main()

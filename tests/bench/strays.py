#!/usr/bin/env python3
"""Where the joined letters of built pages stand and end, beside those of their fonts: rows of BENCHMARKS.md's "Joined letters that stray".

    python3 tests/bench/untried.py --khatt target/release/khatt --bench ../shared/bench --fonts web-fonts /usr/share/fonts \\
        --pages tests/bench/strays.txt --keep pages
    python3 tests/bench/strays.py pages --bench ../shared/bench --fonts web-fonts /usr/share/fonts

Each built initial, medial and final form is laid over the font's as font_bench.py does it. A letter stands wrong where it lies more than 12
thousandths of the em above or below the usual one, and ends wrong where the origin or the end of its advance, on a side that joins, lies more
than 30 to the left or right of the usual place. --letters names them.
"""
import argparse, glob, json, os, sys

import numpy as np
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree

from untried import found

HEIGHT, END = 12, 30


def shift(true, built):
    """How far the second outline's points are to be moved to lie on the first's."""
    at = (true.min(0) + true.max(0) - built.min(0) - built.max(0)) / 2
    for _ in range(8):
        nearest = cKDTree(true).query(built + at)[1]
        at = at + np.mean(true[nearest] - (built + at), 0)
    return at


def forms(folder, path):
    """Of every joined form: its name, and how far it, its origin and its advance's end lie from the font's, 1/1000 em."""
    import make_sheet
    import outline_bench

    original, built = TTFont(path), TTFont(os.path.join(folder, "out.ttf"))
    glyphs, unit, em = built.getGlyphSet(), 1000 / built["head"].unitsPerEm, 1000 / original["head"].unitsPerEm
    points = lambda outline, k: np.vstack(outline_bench.flatten(outline, 0.5 / k)) * k
    rows = []
    for cell in json.load(open(os.path.join(folder, "page.png.json")))["cells"]:
        name = cell["name"]
        if not name.endswith((".init", ".medi", ".fina")) or name not in glyphs:
            continue
        true, got = make_sheet.shaped_outline(path, cell["text"])[0], outline_bench.true_outline(built, glyphs, name)
        if true and got:
            x, y = shift(points(true, em), points(got, unit))
            rows.append((name, -y, x, x + built["hmtx"][name][0] * unit - cell["advance"] * em))
    return rows


def off(rows, column, limit, without=None):
    """Names and distances of those farther than the limit from the median."""
    some = [row for row in rows if not (without and row[0].endswith(without))]
    usual = np.median([row[column] for row in some])
    return [(row[0], round(row[column] - usual)) for row in some if abs(row[column] - usual) > limit]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py and outline_bench.py")
    parser.add_argument("--fonts", nargs="+", default=["/usr/share/fonts"], help="folders of the fonts")
    parser.add_argument("--letters", action="store_true", help="name the letters that are wrong")
    parser.add_argument("kept", help="folder that untried.py kept")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    print("| page | joined letters | stand wrong | end wrong |\n|---|---|---|---|")
    total = np.zeros(3, int)
    for folder in sorted(glob.glob(os.path.join(args.kept, "*", ""))):
        page = os.path.basename(folder[:-1])
        if not os.path.exists(folder + "out.ttf"):
            print(f"| {page} | not built | | |")
            continue
        rows = forms(folder, found(json.load(open(folder + "page.png.json"))["font"], args.fonts))
        high, ends = off(rows, 1, HEIGHT), off(rows, 2, END, ".fina") + off(rows, 3, END, ".init")
        total += [len(rows), len(high), len(ends)]
        print(f"| {page} | {len(rows)} | {len(high)} | {len(ends)} |", flush=True)
        if args.letters:
            print("".join(f"  {kind} {name} {by}\n" for kind, of in (("stands", high), ("ends", ends)) for name, by in of), end="")
    print("| all | {} | {} | {} |".format(*total))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""How many lines of a font that are upright or level come out exactly so, and how many that are nearly.

    python3 tests/bench/axes.py --khatt target/release/khatt --bench ../shared/bench [--ppem 500] [--turn DEGREES] FONT...

Pictures are those of outline_bench.py. Of every line of the font that is turned from an axis by less than 1.5 degrees and
at least 8 px long, the traced line that runs along its middle is looked at. Lines that are aslant count where their
ends differ by at least a tenth of a pixel; --turn turns the font, so that all are.
"""
import argparse, math, os, subprocess, sys, tempfile
from multiprocessing import Pool

NEAR, LEAST_PX, ASLANT_PX, ALONG_PX, EXACT = math.tan(math.radians(1.5)), 8, 0.1, 1.5, 1e-6
CONDITIONS = ("clean", "scan")


def lines(contours):
    return [(s[0], s[-1]) for contour in contours for s in contour if len(s) == 2]


def off(line):
    """How far its ends differ across the nearest axis, and along it."""
    return sorted(abs(a - b) for a, b in zip(*line))


def runs_along(found, line):
    """Whether a line passes near the middle of another."""
    (ax, ay), (bx, by) = found
    x, y = ((p + q) / 2 for p, q in zip(*line))
    length = math.hypot(bx - ax, by - ay)
    if length < LEAST_PX / 2:
        return False
    along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length
    across = abs((x - ax) * (by - ay) - (y - ay) * (bx - ax)) / length
    return 0 < along < length and across < ALONG_PX and off(found)[0] < 2 * NEAR * off(found)[1]


def counted(task):
    """Of a font: for each condition lines on an axis, those that came out so, aslant lines, those that came out on one."""
    import outline_bench as bench
    from fontTools.ttLib import TTFont
    from PIL import Image

    khatt, path, ppem, turn = task
    cos, sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    font = TTFont(path)
    glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
    counts = {condition: [0, 0, 0, 0] for condition in CONDITIONS}
    with tempfile.TemporaryDirectory() as folder:
        picture, svg = os.path.join(folder, "in.png"), os.path.join(folder, "out.svg")
        for char in bench.charset("arabic" if ord("ع") in cmap else "latin"):
            true = ord(char) in cmap and bench.true_outline(font, glyphs, cmap[ord(char)])
            if not true:
                continue
            if turn:
                true = [[tuple((cos * x - sin * y, sin * x + cos * y) for x, y in s) for s in c] for c in true]
            for condition, count in counts.items():
                image, (scale, left, foot) = bench.render(true, upem, ppem, 20, condition, ord(char))
                Image.fromarray(image).save(picture)
                subprocess.run([khatt, "--quiet", "trace", picture, "-o", svg], check=True)
                found = lines(bench.svg_contours(open(svg).read()))
                for line in lines(true):
                    line = [(x * scale + left, foot - y * scale) for x, y in line]
                    across, long = off(line)
                    there = [f for f in found if runs_along(f, line)]
                    if long < LEAST_PX or across > NEAR * long or not there:
                        continue
                    exact = min(off(f)[0] for f in there) < EXACT
                    if across < EXACT:
                        count[0] += 1
                        count[1] += exact
                    elif across >= ASLANT_PX:
                        count[2] += 1
                        count[3] += exact
    return os.path.basename(path), counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--ppem", type=int, default=500)
    parser.add_argument("--turn", type=float, default=0)
    parser.add_argument("font", nargs="+")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    print("| font | picture | lines on an axis | of them traced so | aslant lines | of them traced on one |\n|---|---|---|---|---|---|")
    sums = {condition: [0, 0, 0, 0] for condition in CONDITIONS}
    with Pool() as pool:
        for name, counts in pool.imap(counted, [(args.khatt, path, args.ppem, args.turn) for path in args.font]):
            for condition, count in counts.items():
                print(f"| {name} | {condition} | {' | '.join(map(str, count))} |", flush=True)
                sums[condition] = [a + b for a, b in zip(sums[condition], count)]
    for condition, count in sums.items():
        print(f"| all {len(args.font)} | {condition} | {' | '.join(map(str, count))} |")


if __name__ == "__main__":
    main()

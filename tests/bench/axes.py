#!/usr/bin/env python3
"""How many lines of a font that are upright or level come out exactly so, and how many that are nearly.

    python3 tests/bench/axes.py --khatt target/release/khatt --bench ../shared/bench [--tools potrace] FONT...

Pictures are those of outline_bench.py. Of every line of the font that is turned from an axis by less than 1.5 degrees and
at least 8 px long, the traced lines that run along its middle are looked at; where there is none it is not found. Lines
that are aslant count where their ends differ by at least a tenth of a pixel; --turn DEGREES turns the font, so that all are.
"""
import argparse, math, os, sys, tempfile
from multiprocessing import Pool

NEAR, LEAST_PX, ASLANT_PX, ALONG_PX, EXACT = math.tan(math.radians(1.5)), 8, 0.1, 1.5, 1e-6
CONDITIONS = ("clean", "scan")
FILES = {"in": "png", "pgm": "pgm", "pbm": "pbm", "out": "svg"}


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
    """Of a font, for each kind of picture and tool: lines on an axis, those that came out so, aslant lines, those that
    came out on one."""
    import numpy as np
    import outline_bench as bench
    from fontTools.ttLib import TTFont
    from PIL import Image

    tools, path, ppem, turn = task
    tools = {name: bench.custom(command) if command else bench.TOOLS[name] for name, command in tools.items()}
    cos, sin = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    font = TTFont(path)
    glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
    counts = {(condition, tool): [0, 0, 0, 0] for condition in CONDITIONS for tool in tools}
    with tempfile.TemporaryDirectory() as folder:
        files = {name: os.path.join(folder, f"picture.{ending}") for name, ending in FILES.items()}
        for char in bench.charset("arabic" if ord("ع") in cmap else "latin"):
            true = ord(char) in cmap and bench.true_outline(font, glyphs, cmap[ord(char)])
            if not true:
                continue
            true = [[tuple((cos * x - sin * y, sin * x + cos * y) for x, y in s) for s in c] for c in true] if turn else true
            for condition in CONDITIONS:
                image, (scale, left, foot) = bench.render(true, upem, ppem, 20, condition, ord(char))
                Image.fromarray(image).save(files["in"])
                Image.fromarray(image).save(files["pgm"])
                Image.fromarray(np.where(image < 132, 0, 255).astype(np.uint8)).convert("1", dither=0).save(files["pbm"])
                drawn = [[(x * scale + left, foot - y * scale) for x, y in line] for line in lines(true)]
                for tool, trace in tools.items():
                    add(counts[condition, tool], drawn, lines(trace(files)[0]))
    return os.path.basename(path), counts


def add(count, drawn, found):
    """Counts the lines of one picture."""
    for line in drawn:
        across, long = off(line)
        there = [off(f)[0] for f in found if runs_along(f, line)]
        if long < LEAST_PX or across > NEAR * long or not (across < EXACT or across >= ASLANT_PX):
            continue
        kind = 0 if across < EXACT else 2
        count[kind] += 1
        count[kind + 1] += min(there, default=1) < EXACT


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--tools", default="", help="others of that script, with commas")
    parser.add_argument("--ppem", type=int, default=500)
    parser.add_argument("--turn", type=float, default=0)
    parser.add_argument("font", nargs="+")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    tools = {"khatt": f"{args.khatt} --quiet trace {{in}} -o {{out}}"} | {name: "" for name in args.tools.split(",") if name}
    print("| font | picture | tool | lines on an axis | of them traced so | aslant lines | of them traced on one |")
    print("|---|---|---|---:|---:|---:|---:|")
    sums = {(condition, tool): [0, 0, 0, 0] for condition in CONDITIONS for tool in tools}
    with Pool() as pool:
        for name, counts in pool.imap(counted, [(tools, path, args.ppem, args.turn) for path in args.font]):
            for key, count in counts.items():
                print(f"| {name} | {' | '.join(map(str, (*key, *count)))} |", flush=True)
                sums[key] = [a + b for a, b in zip(sums[key], count)]
    for key, count in sums.items():
        print(f"| all {len(args.font)} | {' | '.join(map(str, (*key, *count)))} |")


if __name__ == "__main__":
    main()

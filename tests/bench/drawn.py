#!/usr/bin/env python3
"""Fonts built from pages that a simulated hand drew: a row of BENCHMARKS.md's "Letters that a hand varies" for each font.

    python3 tests/bench/drawn.py --khatt target/release/khatt --bench ../shared/bench --fonts web-fonts /usr/share/fonts \\
        --unsteady 2.2 cairo-400.ttf lateef-400.ttf

A page has every Arabic form of the font, each in its own way turned (1.5° in one standard deviation), scaled in both directions and slanted
(3 %), bent by slow waves (6 thousandths of the em) and off its place (0.2 mm), all times --unsteady. Counted are the words of words.txt
with a gap at a join, the joining strokes that cannot be brought to the others' height or are not found, and the letters that are moved to
their row. --keep FOLDER keeps pages and fonts.
"""
import argparse, contextlib, io, math, os, subprocess, sys, tempfile, zlib

import numpy as np

import untried


def hand(name, unsteady, em):
    """How the hand draws a letter: a map of its points, font units."""
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    turn, slant = rng.normal(0, (math.radians(1.5) * unsteady, 0.03 * unsteady))
    wide, high = 1 + rng.normal(0, 0.03 * unsteady, 2)
    rotated = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    whole = rotated @ np.array([[wide, slant], [0, high]])
    waves = rng.normal(0, 0.005 * em * unsteady, (3, 2)), rng.uniform(3.5, 11.2, (3, 2, 2)) / em, rng.uniform(0, 2 * math.pi, (3, 2))

    def drawn(point):
        p = np.array(point)
        bend = sum(size * np.sin(way @ p + phase) for size, way, phase in zip(*waves))
        return tuple(whole @ p + bend)

    return drawn


def draw(bench, path, unsteady, picture):
    """The page, by make_sheet.py with each letter's outline as the hand draws it."""
    sys.path.insert(0, bench)
    import make_sheet

    shaped = make_sheet.shaped_outline
    em = make_sheet.TTFont(path)["head"].unitsPerEm

    def by_hand(path, text):
        outline, advance = shaped(path, text)
        drawn = hand(text, unsteady, em)
        return [[tuple(map(drawn, segment)) for segment in contour] for contour in outline], advance

    by_hand.cache = shaped.cache
    make_sheet.shaped_outline = by_hand
    options = ["--forms", "--rows", "17", "--cols", "7", "--dpi", "300", "--jitter", str(0.2 * unsteady), "--out", picture]
    sys.argv = ["make_sheet.py", "--font-file", path, "--chars", "latin", *options]
    try:
        make_sheet.main()
    finally:
        make_sheet.shaped_outline = shaped


def row(args, name, folder):
    path = untried.found(name, args.fonts)
    if not path:
        return f"| {name} | no such font below {', '.join(args.fonts)} |"
    picture = os.path.join(folder, "page.png")
    if not os.path.exists(picture + ".json"):
        with contextlib.redirect_stdout(io.StringIO()):
            draw(args.bench, path, args.unsteady, picture)
    project = untried.page(args.bench, path, ["--forms"], "", folder)[1]
    build = subprocess.run([args.khatt, "build", "--no-cache", project], capture_output=True, text=True)
    if build.returncode:
        return f"| {name} | {' '.join(build.stderr.split())[:300]} |"
    said = build.stderr.splitlines()
    notes = [sum(text in line for line in said) for text in ("a step of", "no stroke leaves it", "was moved")]
    return f"| {name} | {untried.parted(os.path.join(folder, 'out.ttf'))} | {' | '.join(map(str, notes))} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py")
    parser.add_argument("--fonts", nargs="+", default=["/usr/share/fonts"], help="folders of the fonts")
    parser.add_argument("--unsteady", type=float, default=1.0)
    parser.add_argument("--keep", help="folder where pages and fonts stay")
    parser.add_argument("font", nargs="+", metavar="FONT")
    args = parser.parse_args()
    print("| font | parted | steps | no stroke | moved to their row |\n|---|---|---|---|---|")
    for name in args.font:
        with tempfile.TemporaryDirectory() as spare:
            folder = os.path.join(args.keep, name) if args.keep else spare
            os.makedirs(folder, exist_ok=True)
            print(row(args, name, folder), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""How near to 1 the corner F1 of outline_bench.py can come: fonts compared with themselves.

    python3 tests/bench/corners.py --bench ../shared/bench FONT...

Contours begin at another node, and nodes move with their handles at random, by so many thousandths of the em (standard
deviation of x and of y): the mean of five draws, the least and the largest. What counts as a corner there is a turn by 40 degrees within 12 thousandths, sampled from a contour's
first node on, so that rounds near that limit come and go.
"""
import argparse, os, random, sys

MOVES = (0, 0.05, 0.1, 0.2)
DRAWS = 5  # one draw is off by 0.02


def moved(contour, by, rng):
    """A contour that begins half-way around, its nodes moved."""
    contour = contour[len(contour) // 2 :] + contour[: len(contour) // 2]
    steps = [(rng.gauss(0, by), rng.gauss(0, by)) for _ in contour]
    out = []
    for i, segment in enumerate(contour):
        ends, last = (steps[i], steps[(i + 1) % len(contour)]), len(segment) - 1
        # handles go with their node, a quadratic's with both
        share = [0.0 if k < last / 2 else 1.0 if k > last / 2 else 0.5 for k in range(last + 1)]
        mix = [[a + s * (b - a) for a, b in zip(*ends)] for s in share]
        out.append(tuple((x + dx, y + dy) for (x, y), (dx, dy) in zip(segment, mix)))
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("font", nargs="+")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    import numpy as np
    import outline_bench as bench
    from fontTools.ttLib import TTFont

    print(f"| font | {' | '.join(f'moved by {by}' for by in MOVES)} |\n|---|{'---|' * len(MOVES)}")
    for path in args.font:
        font = TTFont(path)
        glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
        chars = [c for c in bench.charset("arabic" if ord("ع") in cmap else "latin") if ord(c) in cmap]
        outlines = [o for o in (bench.true_outline(font, glyphs, cmap[ord(c)]) for c in chars) if o]
        row = []
        for by in MOVES:
            rng = random.Random(1)
            found = []
            for _ in range(DRAWS if by else 1):
                others = [[moved(c, by * upem / 1000, rng) for c in outline] for outline in outlines]
                pairs = zip(outlines, others)
                found.append(np.mean([bench.compare(a, b, upem, 500)["corner_f1"] for a, b in pairs]))
            row.append(f"{np.mean(found):.3f}" + (f" ({min(found):.3f} to {max(found):.3f})" if by else ""))
        print(f"| {os.path.basename(path)} | {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Whether fontmake and fontc build the UFO of a project without errors, and the same font as khatt.

    python3 tests/bench/compilers.py build/KhattArabic build/KhattLatin build/KhattRasm [--words tests/words.txt]

For each NAME reads NAME.ufo, NAME.otf and NAME.ttf. Compared are glyph order, characters, advances, outlines (points of
cubics, or for TrueType, whose converters differ, the largest distance of the outlines both ways, units) and the words as
HarfBuzz sets them (names and places). One difference fails the run. Needs `pip install fontmake fontc fonttools uharfbuzz numpy scipy`.
"""
import argparse, os, subprocess, sys, tempfile
import numpy as np
import uharfbuzz
from fontTools.pens.basePen import BasePen
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.ttLib import TTFont
from scipy.spatial import cKDTree

# Both converters may leave the cubics by a quarter of a unit to one unit, and round.
TRUETYPE_UNITS = 2.5


def points(font, name):
    """On- and off-curve points of a glyph, each once; without those between two lines along an axis, which CFF joins."""
    pen = DecomposingRecordingPen(font.getGlyphSet())
    font.getGlyphSet()[name].draw(pen)
    ring, out = [], set()
    for verb, args in pen.value:
        at = [tuple(round(v) for v in p) for p in args]
        if verb in ("closePath", "endPath"):
            for i, (kind, p) in enumerate(ring):
                before, (after, q) = ring[i - 1][1][-1], ring[(i + 1) % len(ring)]
                level = any(before[k] == p[-1][k] == q[0][k] for k in (0, 1))
                if not (level and after != "curveTo" and kind != "curveTo"):
                    out.update(p)
                else:
                    out.update(p[:-1])
            ring = []
        elif not (ring and at[-1] == ring[0][1][-1] and verb == "lineTo"):
            ring.append((verb, at))
    return sorted(out)


class Lines(BasePen):
    """An outline as points hardly a unit apart."""

    def __init__(self, glyphs):
        super().__init__(glyphs)
        self.points, self.at, self.first = [], None, None

    def _add(self, curve, length):
        steps = max(2, int(length) + 1)
        self.points += [curve(i / steps) for i in range(steps)]

    def _moveTo(self, p):
        self.at = self.first = np.array(p, float)

    def _lineTo(self, p):
        a, b = self.at, np.array(p, float)
        self._add(lambda t: a + (b - a) * t, np.hypot(*(b - a)))
        self.at = b

    def _curveToOne(self, b, c, d):
        a, b, c, d = self.at, *(np.array(p, float) for p in (b, c, d))
        length = np.hypot(*(b - a)) + np.hypot(*(c - b)) + np.hypot(*(d - c))
        self._add(lambda t: a * (1 - t) ** 3 + 3 * b * t * (1 - t) ** 2 + 3 * c * t * t * (1 - t) + d * t**3, length)
        self.at = d

    def _closePath(self):
        self._lineTo(self.first)


def apart(one, other, name):
    sampled = []
    for font in (one, other):
        pen = Lines(font.getGlyphSet())
        font.getGlyphSet()[name].draw(pen)
        sampled.append(np.array(pen.points))
    a, b = sampled
    if not len(a) or not len(b):
        return 0.0 if len(a) == len(b) else float("inf")
    # neighbours of a sample lie half a unit away at most
    return max(cKDTree(a).query(b)[0].max(), cKDTree(b).query(a)[0].max())


def shaped(path, words):
    font = uharfbuzz.Font(uharfbuzz.Face(open(path, "rb").read()))
    out = []
    for word in words:
        buffer = uharfbuzz.Buffer()
        buffer.add_str(word)
        buffer.guess_segment_properties()
        uharfbuzz.shape(font, buffer)
        places = zip(buffer.glyph_infos, buffer.glyph_positions)
        out.append([(i.codepoint, p.x_advance, p.x_offset, p.y_offset) for i, p in places])
    return out


def compare(ours, theirs, words):
    """What differs, and the largest distance of outlines."""
    a, b = TTFont(ours), TTFont(theirs)
    bad = []
    if a.getGlyphOrder() != b.getGlyphOrder():
        return [f"glyph order: {set(a.getGlyphOrder()) ^ set(b.getGlyphOrder())}"], float("nan")
    if a.getBestCmap() != b.getBestCmap():
        bad.append("characters")
    names = a.getGlyphOrder()
    bad += [f"advance of {n}" for n in names if a["hmtx"][n][0] != b["hmtx"][n][0]]
    worst = 0.0
    for name in names:
        if "CFF " in a and points(a, name) != points(b, name):
            bad.append(f"points of {name}")
        if "glyf" in a:
            worst = max(worst, apart(a, b, name))
    if worst > TRUETYPE_UNITS:
        bad.append("outlines")
    differ = [w for w, x, y in zip(words, shaped(ours, words), shaped(theirs, words)) if x != y]
    if differ:
        bad.append(f"set otherwise: {' '.join(differ)}")
    return bad, worst


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+")
    parser.add_argument("--words", default=os.path.join(os.path.dirname(__file__), "../words.txt"))
    args = parser.parse_args()
    words = open(args.words, encoding="utf-8").read().split() + "AVATAR Type fi To. “We”".split()
    failed = False
    for name in args.names:
        ufo = name + ".ufo"
        with tempfile.TemporaryDirectory() as folder:
            base = os.path.join(folder, os.path.basename(name))
            fontmake = ["fontmake", "-u", ufo, "-o", "otf", "ttf", "--keep-overlaps", "--output-dir", folder]
            fontc = ["fontc", ufo, "--output-file", base + "-fontc.ttf"]
            runs = [("fontmake", fontmake, [".otf", ".ttf"]), ("fontc", fontc, ["-fontc.ttf"])]
            for tool, command, endings in runs:
                run = subprocess.run(command, capture_output=True, text=True)
                if run.returncode:
                    print(f"{name}: {tool} failed\n{run.stderr[-2000:]}")
                    failed = True
                    continue
                for ending in endings:
                    ours = name + ending[-4:]
                    bad, worst = compare(ours, base + ending, words)
                    glyphs = len(TTFont(ours).getGlyphOrder())
                    same = f"outlines {worst:.2f} units apart at most" if ending != ".otf" else "the same points"
                    print(f"{name}{ending[-4:]}, {tool}: {glyphs} glyphs, {'; '.join(bad) or same}")
                    failed |= bool(bad)
    sys.exit(failed)


if __name__ == "__main__":
    main()

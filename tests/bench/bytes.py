"""`glyf` bytes of `khatt convert --quadratic rate` beside cu2qu's at cu2qu's own largest errors, for any fonts of cubics:

    python3 tests/bench/bytes.py --khatt target/release/khatt --bench ../shared/bench FONT.otf...

Each font is cut to the 65 Latin letters of quad_bench.py first. cu2qu runs with 0.5, 1 and 2 thousandths of the em; its largest
error is then the tolerance of both conversions, extrema kept and corners kept. Needs fonttools, numpy, scipy.
"""
import argparse
import os
import subprocess
import sys
import tempfile

from fontTools import subset
from fontTools.ttLib import TTFont


def cut(path, out, letters):
    """The font's letters alone."""
    options = subset.Options(layout_features=[], notdef_outline=True, hinting=False, desubroutinize=True)
    font = subset.load_font(path, options)
    cutter = subset.Subsetter(options)
    cutter.populate(unicodes=[ord(c) for c in letters])
    cutter.subset(font)
    subset.save_font(font, out, options)


def drawn(glyphs, names):
    return {name: quad_bench.raw(glyphs, name) for name in names}


def rows(khatt, path, folder):
    small = os.path.join(folder, "small.otf")
    cut(path, small, outline_bench.charset("latin"))
    font = TTFont(small)
    em, known = font["head"].unitsPerEm, font.getBestCmap()
    names = [known[ord(c)] for c in outline_bench.charset("latin") if ord(c) in known]
    truth = drawn(font.getGlyphSet(), names)
    for thousandths in (0.5, 1, 2):
        glyf, quads = quad_bench.cu2qu(font, names, thousandths * em / 1000), {}
        for name in names:
            pen = outline_bench.SegPen(font.getGlyphSet())
            glyf[name].draw(pen, glyf)
            quads[name] = pen.contours
        theirs, error = quad_bench.stored(glyf, names)[0], quad_bench.errors(truth, quads, em).max()
        cells = [f"{error:.3f}", str(theirs)]
        for keep in ("extrema", "corners"):
            out = os.path.join(folder, f"{keep}.ttf")
            command = [khatt, "convert", small, "-o", out, "--quadratic", "rate", "--keep", keep]
            subprocess.run(command + ["--tolerance", f"{error:.4f}", "--quiet"], check=True)
            ours = TTFont(out)
            off = quad_bench.errors(truth, drawn(ours.getGlyphSet(), names), em).max()
            size = quad_bench.in_file(ours, names)
            cells.append(f"{size} ({off:.3f}) {100 * size / theirs:.1f} %")
        yield cells


def main():
    print("| font | cu2qu's error | its bytes | rate, extrema kept | rate, corners kept |\n|---|---|---|---|---|")
    for path in args.fonts:
        name = os.path.splitext(os.path.basename(path))[0]
        with tempfile.TemporaryDirectory() as folder:
            for cells in rows(args.khatt, path, folder):
                print("|", " | ".join([name] + cells), "|", flush=True)


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--khatt", required=True)
parser.add_argument("--bench", required=True, help="folder of quad_bench.py")
parser.add_argument("fonts", nargs="+", metavar="FONT")
args = parser.parse_args()
sys.path.insert(0, args.bench)
import outline_bench
import quad_bench

main()

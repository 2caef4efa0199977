#!/usr/bin/env python3
"""Fonts built from pages in grey and from the same pages in two levels: how far they are off, and how many points they have.

    python3 tests/bench/two_levels.py --khatt target/release/khatt --bench ../shared/bench --fonts /usr/share/fonts \\
        'FreeSans.ttf --rows 8 --cols 9 --skew 2 --dpi 600'

A page is one as untried.py takes them. Its second level begins half-way between its ink and the paper around, as scanners
set it that make the light even. Needs what untried.py needs, and scipy.
"""
import argparse, json, os, shutil, subprocess, sys, tempfile
import numpy as np
from PIL import Image
from fontTools.ttLib import TTFont
from scipy.ndimage import gaussian_filter

import untried

INK, LIGHT_PX = 0.17, 40
Image.MAX_IMAGE_PIXELS = None


def two_levels(path):
    """The picture at the path, in two levels."""
    seen = np.asarray(Image.open(path).convert("L")).astype(np.float32)
    light = gaussian_filter(np.maximum(seen, np.percentile(seen, 60)), LIGHT_PX)
    paper = seen > (1 + INK) / 2 * light
    Image.fromarray(paper.astype(np.uint8) * 255).convert("1", dither=0).save(path)


def built(args, folder, original):
    """Mean and median maximum of a folder's page and the points of its font; the message where it builds none."""
    run = subprocess.run([args.khatt, "build", "--no-cache", "--quiet", os.path.join(folder, "font.toml")], capture_output=True, text=True)
    if run.returncode:
        return " ".join(run.stderr.split())[:200]
    font = os.path.join(folder, "out.ttf")
    command = [sys.executable, os.path.join(args.bench, "font_bench.py"), "--truth", os.path.join(folder, "page.png.json")]
    found = subprocess.run(command + ["--original", original, "--built", font], capture_output=True, text=True).stdout
    found = json.loads(found[found.index("{") :])
    font = TTFont(font)
    outlines = [font["glyf"][name] for name in font.getGlyphOrder()]
    points = sum(len(glyph.coordinates) for glyph in outlines if glyph.numberOfContours > 0)
    return f"{found['mean']:.2f} | {found['median_max']:.2f} | {len(found['wrong'])} | {points}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py and font_bench.py")
    parser.add_argument("--fonts", nargs="+", default=["/usr/share/fonts"], help="folders of the fonts")
    parser.add_argument("page", nargs="+", metavar="PAGE")
    args = parser.parse_args()
    print("| page | grey: mean | median max | wrong | points | two levels: mean | median max | wrong | points |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for text in args.page:
        with tempfile.TemporaryDirectory() as grey, tempfile.TemporaryDirectory() as bare:
            name, *options = text.split()
            original = untried.found(name, args.fonts) or sys.exit(f"no font {name} below {', '.join(args.fonts)}")
            truth, _ = untried.page(args.bench, original, options, "", grey)
            for file in os.listdir(grey):
                shutil.copy(os.path.join(grey, file), bare)
            two_levels(os.path.join(bare, "page.png"))
            print(f"| {text} | {built(args, grey, original)} | {built(args, bare, original)} |", flush=True)


if __name__ == "__main__":
    main()

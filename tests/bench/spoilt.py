#!/usr/bin/env python3
"""Fonts built from pages as scanned and from the same pages spoilt: how far they are off, and how many points they have.

    python3 tests/bench/spoilt.py --khatt target/release/khatt --bench ../shared/bench --fonts /usr/share/fonts \\
        --two-levels 'FreeSans.ttf --rows 8 --cols 9 --skew 2 --dpi 600'
    python3 tests/bench/spoilt.py ... --blur 4 'FreeSans.ttf --rows 8 --cols 9 --skew 2 --dpi 600'

A page is one as untried.py takes them. In two levels the second one begins half-way between its ink and the paper around, as
scanners set it that make the light even; out of focus it is blurred by a Gaussian of so many px, and noise of 3/255 is added.
Needs what untried.py needs, and scipy.
"""
import argparse, json, os, shutil, subprocess, sys, tempfile
import numpy as np
from PIL import Image
from fontTools.ttLib import TTFont
from scipy.ndimage import gaussian_filter

import untried

INK, LIGHT_PX, NOISE = 0.17, 40, 3
Image.MAX_IMAGE_PIXELS = None


def two_levels(path):
    """The picture at the path, in two levels."""
    seen = np.asarray(Image.open(path).convert("L")).astype(np.float32)
    light = gaussian_filter(np.maximum(seen, np.percentile(seen, 60)), LIGHT_PX)
    paper = seen > (1 + INK) / 2 * light
    Image.fromarray(paper.astype(np.uint8) * 255).convert("1", dither=0).save(path)


def out_of_focus(path, blur):
    """The picture at the path, blurred by a Gaussian of so many px."""
    seen = gaussian_filter(np.asarray(Image.open(path).convert("L")).astype(np.float32), blur)
    seen += np.random.default_rng(7).normal(0, NOISE, seen.shape)
    Image.fromarray(np.clip(np.rint(seen), 0, 255).astype(np.uint8)).save(path)


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
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--two-levels", action="store_true")
    how.add_argument("--blur", type=float, help="px")
    parser.add_argument("page", nargs="+", metavar="PAGE")
    args = parser.parse_args()
    print("| page | as scanned: mean | median max | wrong | points | spoilt: mean | median max | wrong | points |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for text in args.page:
        with tempfile.TemporaryDirectory() as whole, tempfile.TemporaryDirectory() as spoilt:
            name, *options = text.split()
            original = untried.found(name, args.fonts) or sys.exit(f"no font {name} below {', '.join(args.fonts)}")
            truth, _ = untried.page(args.bench, original, options, "", whole)
            for file in os.listdir(whole):
                shutil.copy(os.path.join(whole, file), spoilt)
            picture = os.path.join(spoilt, "page.png")
            two_levels(picture) if args.two_levels else out_of_focus(picture, args.blur)
            print(f"| {text} | {built(args, whole, original)} | {built(args, spoilt, original)} |", flush=True)


if __name__ == "__main__":
    main()

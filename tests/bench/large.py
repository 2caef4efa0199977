#!/usr/bin/env python3
"""Pictures of few large letters: how much of their ink comes back.

    large.py --khatt target/release/khatt [--font FONT.ttf]

Four letters side by side on one picture, at several sizes, in even light without noise and in light that falls off to the
right under a camera's noise, built as a grid. A share is the area of the built glyph by that of the font's. Needs numpy,
pillow and fonttools.
"""
import argparse, os, subprocess, tempfile
import numpy as np
from PIL import Image, ImageDraw, ImageFont
from fontTools.pens.areaPen import AreaPen
from fontTools.ttLib import TTFont

LETTERS, SIZES = "ABOX", [100, 150, 300, 600, 1200]
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"
PROJECT = """[font]
family = "Large"
[[sheet]]
image = "page.png"
layout = {{ grid = [1, {count}] }}
glyphs = "{names}"
pixels_per_em = {size}
[output]
ttf = "font.ttf"
"""


def picture(font, size, uneven):
    """A scan in 255ths of ink that sends back a tenth of the light."""
    cell = size * 6 // 5
    page = Image.new("L", (cell * len(LETTERS), size * 3 // 2), 245)
    draw, face = ImageDraw.Draw(page), ImageFont.truetype(font, size)
    for i, letter in enumerate(LETTERS):
        draw.text((i * cell + cell // 10, size * 3 // 20), letter, font=face, fill=25)
    seen = np.asarray(page).astype(float)
    if uneven:
        seen = seen * np.linspace(1, 0.6, seen.shape[1]) + np.random.default_rng(size).normal(0, 4, seen.shape)
    return Image.fromarray(np.clip(np.rint(seen), 0, 255).astype(np.uint8))


def areas(path):
    """Area of each letter, parts of the square of the em."""
    font = TTFont(path)
    glyphs, names, out = font.getGlyphSet(), font.getBestCmap(), []
    for letter in LETTERS:
        pen = AreaPen(glyphs)
        glyphs[names[ord(letter)]].draw(pen)
        out.append(pen.value / font["head"].unitsPerEm ** 2)
    return np.array(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--font", default=FONT)
    args = parser.parse_args()
    program, truth = os.path.abspath(args.khatt), areas(args.font)
    print("| px an em | light | least share | largest |\n|---:|---|---:|---:|")
    for size in SIZES:
        for uneven in (False, True):
            with tempfile.TemporaryDirectory() as folder:
                picture(args.font, size, uneven).save(os.path.join(folder, "page.png"))
                with open(os.path.join(folder, "font.toml"), "w") as file:
                    file.write(PROJECT.format(count=len(LETTERS), names=" ".join(LETTERS), size=size))
                done = subprocess.run(
                    [program, "build", "--quiet", "--no-cache", "font.toml"], cwd=folder, capture_output=True, text=True
                )
                light = "falls off, noise" if uneven else "even"
                if done.returncode:
                    print(f"| {size} | {light} | {done.stderr.strip().splitlines()[0]} | |")
                    continue
                shares = areas(os.path.join(folder, "font.ttf")) / truth
                print(f"| {size} | {light} | {min(shares):.3f} | {max(shares):.3f} |")


main()

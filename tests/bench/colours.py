"""Draws a page of letters in three inks as a scanner sees it, builds a colour font of it and compares:
colours.py --khatt PROGRAM [--turn DEGREES] [--dots].

Letters are half black and half red, black with a red disc upon them, or black with a yellow shadow below. Prints the
palette beside the inks, and how far the area of red, which lies on top, is off. With --dots letters are black with a
red dot beside them, as vowels are written, in one of four places, among grey dust as large. Needs Pillow, NumPy,
fontTools and DejaVu Serif.
"""
import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from fontTools.pens.areaPen import AreaPen
from fontTools.ttLib import TTFont
from PIL import Image, ImageDraw, ImageFilter, ImageFont

args = argparse.ArgumentParser()
args.add_argument("--khatt", required=True)
args.add_argument("--turn", type=float, default=1.5)
args.add_argument("--dots", action="store_true")
args = args.parse_args()
OVER, CELL, EM, COLUMNS = 4, 300, 160, 5
PAPER, INKS = (248, 246, 240), {"yellow": (240, 190, 30), "black": (28, 26, 30), "red": (205, 40, 45)}
if args.dots:
    del INKS["yellow"]
BESIDE, DOT, DUST = [(50, -150), (-25, -60), (130, -60), (50, 32)], 11, 40
NAMES = "A B C D E F G H i j é R S a g e n o x z".split()
rows = len(NAMES) // COLUMNS
width, height = COLUMNS * CELL, rows * CELL
font = ImageFont.truetype("DejaVuSerif-Bold.ttf", EM * OVER)
page = Image.new("RGB", (width * OVER, height * OVER), PAPER)
red_px = {}
for k, name in enumerate(NAMES):
    x, foot = ((k % COLUMNS) * CELL + 90) * OVER, ((k // COLUMNS) * CELL + 210) * OVER

    def letter(ink, by=0):
        mask = Image.new("L", page.size)
        ImageDraw.Draw(mask).text((x + by, foot + by), name, font=font, fill=255, anchor="ls")
        page.paste(INKS[ink], mask=mask)
        return mask

    kind, top = 3 if args.dots else k % 3, Image.new("L", page.size)
    if kind == 2:
        letter("yellow", 8 * OVER)
    mask = letter("black")
    if kind == 0:
        top.paste(mask)
        ImageDraw.Draw(top).rectangle([0, 0, page.width, foot - 60 * OVER], fill=0)
    elif kind == 1:
        box = [x + 20 * OVER, foot - 70 * OVER, x + 75 * OVER, foot - 15 * OVER]
        ImageDraw.Draw(top).ellipse(box, fill=255)
    elif kind == 3:
        at = [c + d * OVER for c, d in zip((x, foot), BESIDE[k % 4])]
        ImageDraw.Draw(top).ellipse([c + s * DOT * OVER for s in (-1, 1) for c in at], fill=255)
    page.paste(INKS["red"], mask=top)
    red_px[name] = np.asarray(top, float).sum() / 255 / OVER**2
for x, y in np.random.default_rng(2).integers(0, [width, height], (DUST if args.dots else 0, 2)) * OVER:
    ImageDraw.Draw(page).ellipse([x, y, x + 2 * DOT * OVER, y + 2 * DOT * OVER], fill=(90, 86, 84))
page = page.resize((width, height), Image.Resampling.BOX).filter(ImageFilter.GaussianBlur(0.8))
page = page.rotate(args.turn, Image.Resampling.BICUBIC, fillcolor=PAPER)
noise = np.random.default_rng(1).normal(0, 3, (height, width, 3))
page = Image.fromarray((np.asarray(page, float) + noise).clip(0, 255).astype(np.uint8))
with tempfile.TemporaryDirectory() as folder:
    folder = Path(folder)
    page.save(folder / "page.jpg", quality=88)
    (folder / "font.toml").write_text(
        f'[font]\nfamily = "Inks"\n[[sheet]]\nimage = "page.jpg"\nlayout = {{ grid = [{rows}, {COLUMNS}] }}\n'
        f'ink = {["#f0be1e", "black", "red"][-len(INKS):]}\npixels_per_em = {EM}\nglyphs = "{" ".join(NAMES)}"\n[output]\nttf = "t.ttf"\n'
    )
    subprocess.run([args.khatt, "build", "--quiet", "--no-cache", folder / "font.toml"], check=True)
    built = TTFont(folder / "t.ttf")
for (ink, look), entry in zip(INKS.items(), built["CPAL"].palettes[0]):
    print(ink, "on white", [round(255 * v / p) for v, p in zip(look, PAPER)], "measured", [entry.red, entry.green, entry.blue])
shapes, cmap, off = built.getGlyphSet(), built.getBestCmap(), []
for name, area in red_px.items():
    layers = built["COLR"].ColorLayers.get(cmap[ord(name)], [])
    red = [layer.name for layer in layers if layer.colorID == len(INKS) - 1]
    if not args.dots:
        assert bool(red) == (area > 0), name
    if red:
        pen = AreaPen(shapes)
        shapes[red[0]].draw(pen)
        off.append((abs(abs(pen.value) * (EM / 1000) ** 2 / area - 1), name))
print(f"red: {len(off)} of {sum(area > 0 for area in red_px.values())} letters, area off by {100 * np.median([o[0] for o in off]):.2f} % (median),",
      f"{100 * max(off)[0]:.2f} % at most ({max(off)[1]})")

#!/usr/bin/env python3
"""Fonts built from pages as scanned and from the same pages spoilt: how far they are off, and how many points they have.

    python3 tests/bench/spoilt.py --khatt target/release/khatt --bench ../shared/bench --fonts /usr/share/fonts \\
        --two-levels 'FreeSans.ttf --rows 8 --cols 9 --skew 2 --dpi 600'
    python3 tests/bench/spoilt.py ... --blur 4 'FreeSans.ttf --rows 8 --cols 9 --skew 2 --dpi 600'
    python3 tests/bench/spoilt.py ... --way pools --way shadow 'FreeSans.ttf --rows 8 --cols 9 --dpi 300 --condition clean'

A page is one as untried.py takes them. In two levels the second one begins half-way between its ink and the paper around, as
scanners set it that make the light even; out of focus it is blurred by a Gaussian of so many px, and noise of 3/255 is added.
A way is one of WAYS below, of a clean page: what real ink, paper, light and files do; "plain" is beside it. Needs what untried.py needs, and scipy.
"""
import argparse, io, json, os, shutil, subprocess, sys, tempfile
import numpy as np
from PIL import Image
from fontTools.ttLib import TTFont
from scipy.ndimage import distance_transform_edt, gaussian_filter, map_coordinates, zoom

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


def slowly(rng, shape, px):
    """A field of deviation 1 that changes over so many px."""
    few = [max(4, int(np.ceil(side / px)) + 4) for side in shape]
    field = zoom(rng.normal(0, 1, few), [(side + 8) / (n - 3) for side, n in zip(shape, few)], order=3)
    return (field[: shape[0], : shape[1]] / field.std()).astype(np.float32)


def grain(rng, shape, px):
    field = gaussian_filter(rng.standard_normal(shape, dtype=np.float32), px)
    return field / field.std()


def rises(v):
    return 1 / (1 + np.exp(-np.clip(v, -50, 50)))


def scanned(rng, ink, dot, light=1.0, noise=NOISE):
    """Ink under a lens, of levels 228 and 40, in this light."""
    seen = light * (228 - 188 * gaussian_filter(ink, 0.9 * dot))
    return np.clip(np.rint(seen + rng.normal(0, noise, seen.shape)), 0, 255).astype(np.uint8)


def saved(seen, quality):
    file = io.BytesIO()
    Image.fromarray(seen).save(file, "JPEG", quality=quality, subsampling=2)
    return np.asarray(Image.open(file))


def streaks(rng, ink, dot, em):
    """A ballpoint's: pale lines along the stroke, in places."""
    along = np.exp(-(((distance_transform_edt(ink > 0.5) - 0.024 * em) / (1.3 * dot)) ** 2))
    pale = gaussian_filter(along * (slowly(rng, ink.shape, 0.1 * em) > 0), 0.7 * dot)
    return scanned(rng, ink * (1 - 0.55 * pale) * (0.9 + 0.1 * np.tanh(grain(rng, ink.shape, 1.5 * dot))), dot)


def scratches(rng, ink, dot, em):
    """A ballpoint's that skips: light lines of all depths along the stroke, in ink that is more even."""
    far, pale = distance_transform_edt(ink > 0.5), np.zeros(ink.shape, np.float32)
    for aside in (0.011, 0.018, 0.027):
        along = np.exp(-(((far - aside * em) / (0.9 * dot)) ** 2))
        pale = np.maximum(pale, along * rises(2 * slowly(rng, ink.shape, 0.08 * em) - 1))
    return scanned(rng, ink * (1 - 0.95 * gaussian_filter(pale, 0.7 * dot)) * (0.95 + 0.05 * np.tanh(grain(rng, ink.shape, 1.5 * dot))), dot)


def fibres(rng, ink, dot, em):
    """A felt pen's: ink runs along the paper's fibres, so that edges stray as much as on a real page of one."""
    y, x = places(ink)
    strays = [0.6 * dot * grain(rng, ink.shape, dot) + 0.3 * dot * grain(rng, ink.shape, 6 * dot) for _ in "yx"]
    return scanned(rng, map_coordinates(ink, [y + strays[0], x + strays[1]], order=1, mode="nearest"), dot)


def pencil(rng, ink, dot, em):
    """Graphite on the paper's tooth."""
    tooth, coarse = grain(rng, ink.shape, 1.3 * dot), grain(rng, ink.shape, 3 * dot)
    shape = np.clip(0.5 + 4 * (gaussian_filter(ink, 2 * dot) - 0.5 + 0.12 * tooth), 0, 1)
    return scanned(rng, shape * np.clip(0.62 + 0.22 * tooth + 0.1 * coarse, 0, 1), dot)


def coloured(paper, pen):
    def way(rng, ink, dot, em):
        part = gaussian_filter(ink, 0.9 * dot)[..., None]
        seen = np.array(paper, float) * (1 - part) + np.array(pen, float) * part
        return saved(np.clip(np.rint(seen + rng.normal(0, NOISE, seen.shape)), 0, 255).astype(np.uint8), 85)

    return way


def back(rng, ink, dot, em):
    """The other side's letters shine through, a quarter as dark."""
    behind = gaussian_filter(np.roll(ink[:, ::-1], (int(0.3 * em), int(0.17 * em)), (0, 1)), 3 * dot)
    light = 1 - 0.25 * behind * (0.6 + 0.4 * np.tanh(slowly(rng, ink.shape, 0.8 * em)))
    return scanned(rng, 1 - (1 - ink) * light, dot)


def places(ink):
    return np.mgrid[0 : ink.shape[0], 0 : ink.shape[1]].astype(np.float32)


def shadow(rng, ink, dot, em):
    """A hand's, over more than half of the page."""
    y, x = places(ink)
    off = 0.8 * x + 0.6 * y - 0.65 * ink.shape[1] + 40 * dot * slowly(rng, ink.shape, 3 * em)
    return scanned(rng, ink, dot, 1 - 0.45 * rises(off / (12 * dot)))


def fold(depth):
    def way(rng, ink, dot, em):
        y, x = places(ink)
        off = x - ink.shape[1] / 2 + 0.01 * y
        light = 1 - depth * np.exp(-((off / (25 * dot)) ** 2)) * (off < 0) - 0.4 * depth * np.exp(-np.abs(off) / (120 * dot))
        return scanned(rng, ink, dot, light * (1 - 0.7 * depth * np.exp(-(((y - ink.shape[0] / 2) / (15 * dot)) ** 2))))

    return way


def corners(rng, ink, dot, em):
    y, x = places(ink)
    far = (2 * x / ink.shape[1] - 1) ** 2 + (2 * y / ink.shape[0] - 1) ** 2
    return scanned(rng, ink, dot, 1 - 0.55 * far / 2)


def copied(rng, ink, dot, em):
    """Steep edges, toner where there is none."""
    steep = np.clip(0.5 + 6 * (gaussian_filter(ink, 1.5 * dot) + 0.05 * grain(rng, ink.shape, 1.2 * dot) - 0.45), 0, 1)
    for _ in range(int(ink.size * 4e-5 / dot**2)):
        y, x, side = rng.integers(0, ink.shape[0]), rng.integers(0, ink.shape[1]), max(1, round(rng.uniform(0.6, 4) * dot))
        steep[y : y + side, x : x + side] = 1
    return scanned(rng, steep, dot, 1, 2)


def sharpened(rng, ink, dot, em):
    seen = scanned(rng, ink, dot).astype(float)
    return np.clip(np.rint(seen + 1.5 * (seen - gaussian_filter(seen, 2))), 0, 255).astype(np.uint8)


def photographed(zoom_out, table, curl_mm=0):
    """A little barrel, a farther end; paper whose middle stands so high, in waves a sixth as high; of a table around the page its dark grain."""

    def way(rng, ink, dot, em):
        (h, w), (y, x) = ink.shape, places(ink)
        u, v = 2 * x / w - 1, 2 * y / h - 1
        u, v = (c * (1 + 0.01 * (u * u + (v * h / w) ** 2 - 1)) for c in (u, v))
        u, v = (zoom_out * c / (1 + 0.03 * v + 0.015 * u) for c in (u, v))
        if curl_mm:
            seen = u, v
            for _ in range(12):  # an A4 page from 400 mm away
                near = 1 - curl_mm * (1 - u * u + np.sin(6 * u) / 6) / 400
                u, v = (c * near for c in seen)
        at = [(v + 1) * h / 2, (u + 1) * w / 2]
        seen = map_coordinates(scanned(rng, ink, dot).astype(np.float32), at, order=1, mode="nearest")
        if table:
            wood = 70 + 15 * np.sin(y / (6 * dot) + 3 * slowly(rng, ink.shape, 0.8 * em))
            seen = np.where((np.abs(u) <= 1) & (np.abs(v) <= 1), seen, wood)
        return np.clip(np.rint(seen), 0, 255).astype(np.uint8)

    return way


def inked(level):
    """Ink as dark as the level says for a generator, a shape and px an em."""
    return lambda rng, ink, dot, em: scanned(rng, ink * level(rng, ink.shape, em), dot)


# each of a generator of random numbers, a picture's coverage, px a 600th of an inch and px an em
WAYS = {
    "plain": inked(lambda rng, shape, em: 1),
    "pools": inked(lambda rng, shape, em: 0.35 + 0.65 * rises(1.5 * slowly(rng, shape, 0.15 * em))),
    "wide pools": inked(lambda rng, shape, em: 0.25 + 0.75 * rises(1.5 * slowly(rng, shape, 0.3 * em))),
    "pen runs dry": inked(lambda rng, shape, em: 0.4 + 0.6 * rises(2 * slowly(rng, shape, 1.5 * em))),
    "marker overlaps": inked(lambda rng, shape, em: np.where(slowly(rng, shape, 0.25 * em) > 0.5, 1, 0.65)),
    "dark rims": lambda rng, ink, dot, em: scanned(
        rng, ink * (0.6 + 0.4 * np.exp(-((distance_transform_edt(ink > 0.5) / (3 * dot)) ** 2))), dot
    ),
    "ballpoint": streaks,
    "ballpoint that skips": scratches,
    "felt pen": fibres,
    "pencil": pencil,
    "blue": coloured((240, 238, 232), (35, 55, 160)),
    "red": coloured((240, 238, 232), (200, 45, 50)),
    "light blue": coloured((240, 238, 232), (110, 150, 225)),
    "sepia on cream": coloured((238, 225, 195), (110, 70, 45)),
    "on kraft paper": coloured((176, 135, 95), (30, 35, 60)),
    "back of the page": back,
    "shadow": shadow,
    "fold": fold(0.15),
    "deep fold": fold(0.3),
    "dark corners": corners,
    "photocopy": copied,
    "sharpened": sharpened,
    "jpeg 50": lambda rng, ink, dot, em: saved(scanned(rng, ink, dot), 50),
    "bent": photographed(1, False),
    "curled": photographed(1, False, 6),
    "on a table": photographed(1.25, True),
}


def as_said(way):
    """Makes a clean page's picture at a path anew in this way."""

    def spoil(path):
        ink = 1 - np.asarray(Image.open(path).convert("L")).astype(np.float32) / 255
        told = json.load(open(path + ".json"))
        seen = WAYS[way](np.random.default_rng(7), ink, told["dpi"] / 600, told["ppem"])
        Image.fromarray(seen).save(path, dpi=(told["dpi"],) * 2)

    return spoil


def spoilt(args, folder, original, spoil):
    """What is built of a copy of a folder, its picture spoilt."""
    with tempfile.TemporaryDirectory() as copy:
        for file in os.listdir(folder):
            shutil.copy(os.path.join(folder, file), copy)
        spoil(os.path.join(copy, "page.png"))
        return built(args, copy, original)


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
    how.add_argument("--way", action="append", choices=WAYS, help="several times for several")
    parser.add_argument("page", nargs="+", metavar="PAGE")
    args = parser.parse_args()
    one = two_levels if args.two_levels else lambda path: out_of_focus(path, args.blur)
    spoils = {f", {way}": as_said(way) for way in args.way} if args.way else {"": one}
    print("| page | as scanned: mean | median max | wrong | points | spoilt: mean | median max | wrong | points |")
    print("|---|---:|---:|---:|---:|---:|---:|---:|---:|")
    for text in args.page:
        with tempfile.TemporaryDirectory() as whole:
            name, *options = text.split()
            original = untried.found(name, args.fonts) or sys.exit(f"no font {name} below {', '.join(args.fonts)}")
            untried.page(args.bench, original, options, "", whole)
            before = spoilt(args, whole, original, as_said("plain") if args.way else lambda path: None)
            for named, spoil in spoils.items():
                print(f"| {text}{named} | {before} | {spoilt(args, whole, original, spoil)} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Counts the letters that `khatt cut` finds on real pages: right, wrong, missing.

    sheets.py --khatt target/release/khatt ../shared/scans

A letter is right where its box overlaps the true one by at least 0.9 (intersection over union). True boxes
of the free page come from its hand-made crops, found again on the page by the least sum of squares, without what a crop's edge cuts off a neighbour; where a
letter has no crop, and on pages of boxes and grids, a letter is right where its box lies in the place of its
row and column. Needs numpy, scipy and pillow.
"""
import argparse, json, os, string, subprocess, tempfile
import numpy as np
from PIL import Image
from scipy.ndimage import label
from scipy.signal import fftconvolve

UPPER, LOWER, DIGITS = string.ascii_uppercase, string.ascii_lowercase, string.digits
BOXES = UPPER + LOWER + DIGITS + ".,;:!?\"'-+=/%&()[]"
FREE = LOWER + UPPER + "1234567890"
KUFI = [18, 9, 14, 16, 20]
# a drop above the first row, three dots and a blot beside the second, a dab below the fourth are no letters; two
# stems of the sixth row stand apart from theirs
NOTEBOOK = [1, 12, 17, 1, 9, 10, 8, 13, 11, 10, 11]
NO_LETTERS = [0, 13, 14, 15, 30, 47, 60, 63]


def private(count):
    """Names for letters that repeat."""
    return [f"uni{0xE000 + i:04X}" for i in range(count)]


def skipping(names, places):
    return ["_" if i in places else name for i, name in enumerate(names)]


# page, layout, further keys, names in reading order, letters of each row
PAGES = [
    ("latin-free-flatbed.jpg", '"free"', "", list(FREE), [7, 8, 7, 7, 6, 6, 7, 9, 5]),
    ("latin-boxes-scan.jpg", '"boxes"', "", list(BOXES), [8] * 10),
    ("latin-boxes-phone.jpg", '"boxes"', "", list(BOXES), [8] * 10),
    ("latin-marks-blue-pen.jpg", "{ grid = [8, 8] }", 'ink = "blue"', [f"uni{c:04X}" for c in range(0x21, 0x60)], [8] * 7 + [7]),
    ("latin-tablet-grid.png", "{ grid = [10, 10] }", 'order = "columns"', private(100), [10] * 10),
    ("arabic-kufi-sheet.jpg", '"free"', 'direction = "rtl"', private(sum(KUFI)), KUFI),
    ("arabic-notebook-photo.jpg", '"free"', 'direction = "rtl"', skipping(private(sum(NOTEBOOK)), NO_LETTERS), NOTEBOOK),
]
IOU = 0.9


def project(page, layout, keys, names):
    """A page's project file."""
    image, glyphs = json.dumps(os.path.abspath(page)), json.dumps(" ".join(names))
    return f'[font]\nfamily = "P"\n[[sheet]]\nimage = {image}\nlayout = {layout}\n{keys}\nglyphs = {glyphs}\n'


def cut(khatt, page, layout, keys, names):
    """The cells of a page as `khatt cut` lists them, or what it said."""
    with tempfile.TemporaryDirectory() as out:
        file = os.path.join(out, "p.toml")
        with open(file, "w") as f:
            f.write(project(page, layout, keys, names))
        run = subprocess.run([khatt, "cut", file, "-o", os.path.join(out, "cells")], capture_output=True, text=True)
        if run.returncode:
            return [], run.stderr.strip()
        with open(os.path.join(out, "cells", "cells.json")) as f:
            return json.load(f)[0]["cells"], ""


def true_boxes(page, folder):
    """Label to true box: each crop's ink where the crop lies on the page."""
    picture = 255 - np.asarray(Image.open(page).convert("L")).astype(np.float32)
    boxes = {}
    for name in sorted(os.listdir(folder)):
        crop = 255 - np.asarray(Image.open(os.path.join(folder, name)).convert("L")).astype(np.float32)
        cross = fftconvolve(picture, crop[::-1, ::-1], mode="valid")
        energy = fftconvolve(picture**2, np.ones_like(crop), mode="valid")
        y, x = np.unravel_index((energy - 2 * cross).argmin(), cross.shape)
        ys, xs = np.where(own_ink(crop > 90))
        boxes[name[0]] = (x + xs.min(), y + ys.min(), x + xs.max() + 1, y + ys.max() + 1)
    return boxes


def own_ink(ink):
    """A crop's ink without what its edge cuts off a neighbour."""
    pieces, count = label(ink)
    sizes = np.bincount(pieces.ravel())
    edge = set(np.concatenate([pieces[0], pieces[-1], pieces[:, 0], pieces[:, -1]]))
    largest = 1 + np.argmax(sizes[1:])
    return np.isin(pieces, [i for i in range(1, count + 1) if i == largest or (i not in edge and sizes[i] > 20)])


def overlap(a, b):
    side = lambda i: max(0, min(a[i + 2], b[i + 2]) - max(a[i], b[i]))
    area = lambda r: (r[2] - r[0]) * (r[3] - r[1])
    both = side(0) * side(1)
    return both / (area(a) + area(b) - both)


def in_place(cells, rows, keys):
    """Cells whose neighbours before and after in reading order stand where they should."""
    middle = {c["cell"] - 1: ((c["box_px"][0] + c["box_px"][2]) / 2, (c["box_px"][1] + c["box_px"][3]) / 2) for c in cells}
    along, across = (1, 0) if "columns" in keys else (0, 1)
    sign = -1 if "rtl" in keys else 1
    starts = np.cumsum([0] + rows)
    lines = [range(a, b) for a, b in zip(starts, starts[1:])]
    lines = [line for line in lines if any(i in middle for i in line)]
    level = [np.median([middle[i][across] for i in line if i in middle]) for line in lines]
    gap = np.median(np.diff(level))
    good = set()
    for line, y in zip(lines, level):
        for i in line:
            if i not in middle or abs(middle[i][across] - y) > gap / 2:
                continue
            others = [j for j in line if j in middle and j != i]
            if all((sign * middle[j][along] < sign * middle[i][along]) == (j < i) for j in others):
                good.add(i)
    return good


def main():
    ap = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ap.add_argument("--khatt", default="target/release/khatt")
    ap.add_argument("scans")
    a = ap.parse_args()
    print("| page | letters | right | wrong | missing | least overlap |\n|---|---:|---:|---:|---:|---:|")
    for name, layout, keys, names, rows in PAGES:
        page = os.path.join(a.scans, name)
        cells, said = cut(a.khatt, page, layout, keys, names)
        folder = os.path.splitext(page)[0] + "-letters"
        true = true_boxes(page, folder) if os.path.isdir(folder) else {}
        good = in_place(cells, rows, keys) if cells else set()
        scores = {c["label"]: overlap(c["box_px"], true[c["label"]]) for c in cells if c["label"] in true}
        right = sum(c["cell"] - 1 in good and scores.get(c["label"], 1) >= IOU for c in cells)
        least = f"{min(scores.values()):.3f} ({len(scores)} crops)" if scores else ""
        letters = len(names) - names.count("_")
        print(f"| {name} | {letters} | {right} | {len(cells) - right} | {letters - len(cells)} | {least} {said} |")


if __name__ == "__main__":
    main()

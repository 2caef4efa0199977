#!/usr/bin/env python3
"""Lines of ink and slits of paper thinner than two pixels: how many contours come back for one, and how wide.

    thin.py --khatt target/release/khatt

A line of 100 px beside a disk, or a slit of 100 px in one, at 12 angles, as a lens of 0.9 px sees it under a scan's grain. A width is the
area of what is not the disk by 100 px; the mean over those angles whose line is there in one piece. Beside us potrace on the picture
cut at half, where it is installed. Needs numpy, scipy, pillow and fonttools.
"""
import argparse, os, re, shutil, subprocess, tempfile
import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter
from fontTools.pens.areaPen import AreaPen
from fontTools.svgLib.path import parse_path

SIDE, FINE, LENS, LONG = 180, 8, 0.9, 100.0
WIDTHS = [0.6, 0.8, 1.0, 1.3, 1.6, 2.0]
ANGLES = range(0, 180, 15)


def picture(width, degrees, slit):
    """A scan in 255ths, and the area of its disk, px²."""
    y, x = (np.mgrid[0 : SIDE * FINE, 0 : SIDE * FINE] + 0.5) / FINE
    centre, disk, radius = (97.3, (97.3, 97.3), 70.0) if slit else (105.3, (24.0, 24.0), 16.0)
    turn = np.radians(degrees)
    along = (x - centre) * np.cos(turn) + (y - centre) * np.sin(turn)
    across = (y - centre) * np.cos(turn) - (x - centre) * np.sin(turn)
    bar = (abs(along) < LONG / 2) & (abs(across) < width / 2)
    round_ = np.hypot(x - disk[0], y - disk[1]) < radius
    ink = (round_ & ~bar) if slit else (round_ | bar)
    seen = gaussian_filter(ink.reshape(SIDE, FINE, SIDE, FINE).mean((1, 3)), LENS)
    noise = np.random.default_rng(degrees).normal(0, 5, seen.shape)
    return np.clip(np.rint(228 - 190 * seen + noise), 0, 255).astype(np.uint8), np.pi * radius**2


def contours(svg, scale):
    """Areas of an SVG's closed contours, px²."""
    areas = []
    for data in re.findall(r'\sd="([^"]*)"', svg):
        for part in re.findall(r"[Mm][^Mm]*", data):
            pen = AreaPen()
            parse_path(part if part[0] == "M" else "M" + part[1:], pen)
            areas.append(abs(pen.value) * scale)
    return areas


def khatt(program, image, folder):
    png, svg = os.path.join(folder, "in.png"), os.path.join(folder, "out.svg")
    Image.fromarray(image).save(png)
    subprocess.run([program, "trace", png, "-o", svg, "--quiet"], check=True)
    return contours(open(svg).read(), 1.0)


def potrace(program, image, folder):
    pbm, svg = os.path.join(folder, "in.pbm"), os.path.join(folder, "out.svg")
    Image.fromarray(np.where(image < 133, 0, 255).astype(np.uint8)).convert("1", dither=0).save(pbm)
    subprocess.run([program, "-s", "--flat", "-u", "100", pbm, "-o", svg], check=True)
    # a unit of its paths is a hundredth of a pixel, and the page's point 4/3 of one
    return contours(open(svg).read(), 1e-4)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    tools = [("khatt", khatt, parser.parse_args().khatt), ("potrace", potrace, shutil.which("potrace"))]
    print("| | width, px | " + " | ".join(f"{name}: whole of {len(ANGLES)}, in pieces, width" for name, _, p in tools if p) + " |")
    with tempfile.TemporaryDirectory() as folder:
        for slit in (False, True):
            for width in WIDTHS:
                row = []
                for _, trace, program in tools:
                    if not program:
                        continue
                    whole, pieces, widths = 0, 0, []
                    for degrees in ANGLES:
                        image, disk = picture(width, degrees, slit)
                        areas = sorted(trace(program, image, folder))
                        thin = areas[:-1] if slit or abs(areas[-1] - disk) < 0.1 * disk else areas
                        whole += len(thin) == 1
                        pieces += len(thin) > 1
                        widths += [thin[0] / LONG] if len(thin) == 1 else []
                    row.append(f"{whole}, {pieces}, " + (f"{np.mean(widths):.2f} ± {np.std(widths):.2f}" if widths else "–"))
                print(f"| {'slit' if slit else 'line'} | {width} | " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()

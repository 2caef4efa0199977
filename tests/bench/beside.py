#!/usr/bin/env python3
"""A letter of a page beside what potrace and khatt make of it, nodes and handles shown: docs/letter.png.

    python3 tests/bench/beside.py --khatt target/release/khatt --label R glyphs/latin.toml docs/letter.png

The letter is that of `khatt cut`; potrace sees it at Otsu's threshold. Needs potrace, Chromium, numpy, Pillow and fontTools.
"""
import argparse, base64, json, os, re, subprocess, tempfile
import numpy as np
from PIL import Image
from fontTools.pens.basePen import AbstractPen
from fontTools.svgLib.path import parse_path

TIMES, GAP, HEAD = 2.6, 26, 34


class Nodes(AbstractPen):
    """On-curve points and the lines to their handles; a contour's closing point counts once."""

    def __init__(self):
        self.nodes, self.handles, self.first = [], [], None

    def moveTo(self, point):
        self.nodes.append(point)
        self.first = self.last = point

    def lineTo(self, point):
        if point != self.first:
            self.nodes.append(point)
        self.last = point

    def curveTo(self, *points):
        self.handles += [(self.last, points[0]), (points[1], points[2])]
        self.lineTo(points[2])

    def qCurveTo(self, *points):
        raise ValueError("neither program writes quadratics")

    def closePath(self):
        pass

    endPath = closePath


def otsu(grey):
    """The level that parts the picture's values best."""
    share = np.histogram(grey, 256, (0, 256))[0] / grey.size
    below, mean = np.cumsum(share), np.cumsum(share * np.arange(256))
    return int(np.argmax((mean[-1] * below - mean) ** 2 / (below * (1 - below) + 1e-12)))


def paths(svg):
    """The SVG's path data."""
    return re.findall(r'<path[^>]*\sd="([^"]*)"', open(svg).read())


def panel(x, title, size, inside):
    """One of the drawings, and what it is."""
    return (f'<text x="{x + size[0] * TIMES / 2}" y="22" text-anchor="middle">{title}</text>'
            f'<g transform="translate({x} {HEAD}) scale({TIMES})">{inside}</g>')


def drawing(data, place):
    """Outlines filled pale, their nodes and handles; `place` is the change of coordinates and its scale."""
    pen = Nodes()
    for d in data:
        parse_path(d, pen)
    where, scale = place
    px = 1 / scale / TIMES
    shapes = "".join(f'<path d="{d}" fill="#d8d8d8" fill-rule="evenodd" stroke="#222" stroke-width="{px}"/>' for d in data)
    lines = "".join(f'<path d="M{a[0]} {a[1]}L{b[0]} {b[1]}" stroke="#2a7de1" stroke-width="{px}"/>'
                    f'<circle cx="{h[0]}" cy="{h[1]}" r="{1.8 * px}" fill="#2a7de1"/>' for a, b in pen.handles for h in [b if a in pen.nodes else a])
    dots = "".join(f'<circle cx="{p[0]}" cy="{p[1]}" r="{3.4 * px}" fill="#d22"/>' for p in pen.nodes)
    return len(pen.nodes), f'<g transform="{where}">{shapes}{lines}{dots}</g>'


def main():
    args = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    args.add_argument("--khatt", default="target/release/khatt")
    args.add_argument("--label", default="R")
    args.add_argument("project")
    args.add_argument("out")
    args = args.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        at = lambda name: os.path.join(folder, name)
        subprocess.run([args.khatt, "-q", "cut", args.project, "-o", at("cells")], check=True)
        cells = [c for sheet in json.load(open(at("cells/cells.json"))) for c in sheet["cells"]]
        picture = at("cells/" + next(c["picture"] for c in cells if c["label"] == args.label))
        grey = np.asarray(Image.open(picture).convert("L"))
        Image.fromarray(((grey > otsu(grey)) * 255).astype("uint8")).convert("1").save(at("bits.bmp"))
        subprocess.run(["potrace", "-s", at("bits.bmp"), "-o", at("potrace.svg")], check=True)
        subprocess.run([args.khatt, "-q", "trace", picture, "-o", at("khatt.svg")], check=True)
        high, wide = grey.shape
        data = base64.b64encode(open(picture, "rb").read()).decode()
        scan = f'<image width="{wide}" height="{high}" style="image-rendering:pixelated" href="data:image/png;base64,{data}"/>'
        theirs, potrace = drawing(paths(at("potrace.svg")), (f"translate(0 {high}) scale(.1 -.1)", 0.1))
        ours, khatt = drawing(paths(at("khatt.svg")), ("scale(1)", 1))
        step = wide * TIMES + GAP
        drawn = (panel(0, "scan, 300 dpi", (wide, high), scan) + panel(step, f"potrace, {theirs} nodes", (wide, high), potrace)
                 + panel(2 * step, f"khatt, {ours} nodes", (wide, high), khatt))
        size = (round(3 * step - GAP), round(high * TIMES + HEAD + 4))
        page = (f'<body style="margin:0;background:#fff"><svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}" '
                f'font-family="sans-serif" font-size="17">{drawn}</svg>')
        open(at("page.html"), "w").write(page)
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", f"--window-size={size[0]},{size[1]}",
                        f"--screenshot={at('page.png')}", "file://" + at("page.html")], check=True, capture_output=True)
        Image.open(at("page.png")).convert("RGB").quantize(64, dither=0).save(args.out, optimize=True)
        print(f"{args.out}: potrace {theirs}, khatt {ours} nodes")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Letters of real pens traced: how many nodes they have, and how far their outlines lie from the scanned edge.

    python3 tests/bench/pens.py --khatt target/release/khatt --bench ../shared/bench ../shared/scans [--options '--edges keep']

Letters are cut by `khatt cut` as sheets.py says. The scanned edge is where the picture is half-way between its ink and its paper,
between pixels by straight lines; a ragged one strays from what was drawn, so that nearest is not best. Nodes are means over a page's
letters, root mean squares and largest distances, px, medians over them. potrace is given the same level. Several programs can be
given as NAME=PATH. Needs what outline_bench.py needs, and scikit-image.
"""
import argparse, glob, os, shlex, subprocess, sys, tempfile
from multiprocessing import Pool

import numpy as np
from PIL import Image
from skimage import measure

import sheets

SPECK = 4


def edge(ink, level):
    """The scanned edge as rings of (x, y), px, y down, origin at the picture's corner."""
    rings = [ring[:, ::-1] - 0.5 for ring in measure.find_contours(np.pad(ink, 1), level)]
    around = lambda ring: abs(np.dot(ring[:-1, 0], ring[1:, 1]) - np.dot(ring[1:, 0], ring[:-1, 1])) / 2
    return [ring[:-1] for ring in rings if around(ring) > SPECK]


def letter(task):
    """Nodes, root mean square and largest distance of each tool's outline of a letter."""
    import outline_bench as bench

    path, commands = task
    seen = np.asarray(Image.open(path).convert("L"))
    ink = 1 - seen / 255
    level = (np.median(ink[ink > 0.5]) + np.median(ink[ink < 0.3])) / 2
    rings, rows = edge(ink, level), {}
    with tempfile.TemporaryDirectory() as folder:
        files = {"in": path, "out": os.path.join(folder, "out.svg"), "pbm": os.path.join(folder, "in.pbm")}
        Image.fromarray(np.where(ink > level, 0, 255).astype(np.uint8)).convert("1", dither=0).save(files["pbm"])
        for tool, command in commands.items():
            got, _ = (bench.custom(command) if command else bench.tool_potrace)(files)
            drawn = bench.flatten(got, 0.05)
            off = bench.distance(rings, drawn)
            rows[tool] = len(bench.nodes(got)), np.sqrt((off**2).mean()), max(off.max(), bench.distance(drawn, rings).max())
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", action="append", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--options", action="append", default=[""], help="of khatt trace; several times for several")
    parser.add_argument("scans", help="folder of the pages")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    khatts = dict(k.split("=", 1) if "=" in k else ("khatt", k) for k in args.khatt)
    commands = {"potrace": None}
    for name, program in khatts.items():
        for options in args.options:
            commands[f"{name} {options}".strip()] = f"{shlex.quote(program)} --quiet trace {options} {{in}} -o {{out}}"
    print("| page | tool | letters | nodes a letter | rms | largest |\n|---|---|---|---|---|---|")
    for page, layout, keys, names, _ in sheets.PAGES:
        with tempfile.TemporaryDirectory() as folder, Pool() as pool:
            project, cells = os.path.join(folder, "p.toml"), os.path.join(folder, "cells")
            with open(project, "w") as file:
                file.write(sheets.project(os.path.join(args.scans, page), layout, keys, names))
            subprocess.run([next(iter(khatts.values())), "--quiet", "cut", project, "-o", cells], check=True)
            pictures = sorted(glob.glob(os.path.join(cells, "*.png")))
            found = pool.map(letter, [(picture, commands) for picture in pictures])
        for tool in commands:
            nodes, rms, largest = zip(*(rows[tool] for rows in found))
            figures = f"{np.mean(nodes):.1f} | {np.median(rms):.2f} | {np.median(largest):.2f}"
            print(f"| {page} | {tool} | {len(found)} | {figures} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Letters out of focus: known fonts drawn, blurred and traced.

    python3 tests/bench/focus.py --khatt target/release/khatt --bench ../shared/bench [--blur 1,2,3,5] [--every 5]

Pictures, potrace and the comparison are those of outline_bench.py at 500 px an em; each clean picture is blurred by a Gaussian
of so many px, its black set to 0.8 of the way to white, and noise of 3/255 added. Several programs can be given as NAME=PATH.
"""
import argparse, os, sys, tempfile
from multiprocessing import Pool

CLEAN, INK, NOISE = 255, 0.8, 3
COLUMNS = ("mean", "median max", "worst", "nodes ÷ designer’s", "corner F1", "node F1")


def letters(task):
    """The comparisons of one font under one blur, by tool."""
    import numpy as np
    import outline_bench as bench
    from fontTools.ttLib import TTFont
    from PIL import Image
    from scipy.ndimage import gaussian_filter

    khatts, name, blur, every = task
    path, charset, _ = bench.FONTS[name]
    font = TTFont(path)
    glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
    tools = {"potrace": bench.tool_potrace}
    tools |= {tool: bench.custom(f"{exe} --quiet trace {{in}} -o {{out}}") for tool, exe in khatts.items()}
    found = {tool: [] for tool in tools}
    chars = [c for c in bench.charset(charset) if ord(c) in cmap][::every]
    with tempfile.TemporaryDirectory() as folder:
        files = {"in": os.path.join(folder, "in.png"), "pbm": os.path.join(folder, "in.pbm"), "condition": "scan"}
        files["out"] = os.path.join(folder, "out.svg")
        for char in chars:
            true = bench.true_outline(font, glyphs, cmap[ord(char)])
            if not true:
                continue
            image, (scale, left, foot) = bench.render(true, upem, 500, 20 + round(3 * blur), "clean", ord(char))
            ink = gaussian_filter((CLEAN - image.astype(float)) * INK, blur)
            noise = np.random.default_rng(ord(char)).normal(0, NOISE, ink.shape)
            image = np.clip(np.rint(CLEAN - 20 - ink + noise), 0, CLEAN).astype(np.uint8)
            Image.fromarray(image).save(files["in"])
            half = CLEAN - 20 - INK * CLEAN / 2
            Image.fromarray(np.where(image < half, 0, CLEAN).astype(np.uint8)).convert("1", dither=0).save(files["pbm"])
            for tool, trace in tools.items():
                got, _ = trace(files)
                got = [[tuple(((x - left) / scale, (foot - y) / scale) for x, y in s) for s in c] for c in got]
                found[tool].append(bench.compare(true, bench.clean(got, upem * 2e-4), upem, 500))
    return name, blur, found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", action="append", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--blur", default="1,2,3,5")
    parser.add_argument("--every", type=int, default=5, help="of so many letters one is drawn")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    import numpy as np
    import outline_bench as bench

    khatts = dict(k.split("=", 1) if "=" in k else ("khatt", k) for k in args.khatt)
    tasks = [(khatts, font, float(b), args.every) for font in bench.FONTS for b in args.blur.split(",")]
    print("| font | blur, px | tool | letters | " + " | ".join(COLUMNS) + " |")
    print("|---" * (4 + len(COLUMNS)) + "|")
    with Pool() as pool:
        for font, blur, found in pool.imap(letters, tasks):
            for tool, all in found.items():
                rows = [row for row in all if row]
                largest = [row["max"] for row in rows]
                corners = np.mean([row["corner_f1"] for row in rows])
                nodes = sum(row["nodes"] for row in rows) / sum(row["true_nodes"] for row in rows)
                mean, node_f1 = (np.mean([row[key] for row in rows]) for key in ("mean", "node_f1"))
                figures = f"{mean:.3f} | {np.median(largest):.2f} | {max(largest):.2f} | {nodes:.2f} | {corners:.3f} | {node_f1:.3f}"
                print(f"| {font} | {blur:g} | {tool} | {len(rows)} of {len(all)} | {figures} |", flush=True)


if __name__ == "__main__":
    main()

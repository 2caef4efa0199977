#!/usr/bin/env python3
"""Letters out of focus, enlarged, in sRGB, and as ink and paper make them: known fonts drawn, spoilt and traced.

    python3 tests/bench/focus.py --khatt target/release/khatt --bench ../shared/bench [--blur 2,3,5] [--enlarge 2,3] [--srgb] [--every 3]
    python3 tests/bench/focus.py ... --blur '' --enlarge '' --ways pools,ballpoint

Pictures, potrace and the comparison are those of outline_bench.py at 500 px an em. Out of focus, the clean picture is blurred by a
Gaussian of so many px, its black set to 0.8 of the way to white, and noise of 3/255 added; enlarged, the scanned picture of as
many times fewer px an em is brought to 500 by cubic interpolation, as scanners do. In sRGB, the light of a picture blurred by 0.9 px
(0.85 on paper, 0.03 on ink) is written as sRGB has it, and read in both ways. --ways are those of spoilt.py, at 600 dpi; potrace's threshold is then Otsu's. Several programs can be given as NAME=PATH.
"""
import argparse, os, sys, tempfile
from multiprocessing import Pool

import numpy as np
from PIL import Image, ImageCms
from scipy.ndimage import gaussian_filter

import spoilt

PPEM, WHITE, PAPER, INK, NOISE = 500, 255, 235, 0.8, 3
COLUMNS = ("mean", "median max", "worst", "nodes ÷ designer’s", "corner F1", "node F1")


def out_of_focus(bench, true, upem, char, blur):
    """A letter's picture blurred by so many px, its px a font unit and the place of its origin."""
    image, place = bench.render(true, upem, PPEM, 20 + round(3 * blur), "clean", ord(char))
    ink = gaussian_filter((WHITE - image.astype(float)) * INK, blur)
    noise = np.random.default_rng(ord(char)).normal(0, NOISE, ink.shape)
    return np.clip(np.rint(PAPER - ink + noise), 0, WHITE).astype(np.uint8), place


def enlarged(bench, true, upem, char, times):
    """A letter's picture enlarged so many times, its px a font unit and the place of its origin."""
    image, place = bench.render(true, upem, PPEM / times, 20, "scan", ord(char))
    height, width = image.shape
    large = Image.fromarray(image).resize((width * times, height * times), Image.BICUBIC)
    return np.asarray(large), tuple(v * times for v in place)


def in_srgb(bench, true, upem, char, blur):
    """A letter's light in sRGB, its px a font unit and the place of its origin."""
    image, place = bench.render(true, upem, PPEM, 20, "clean", ord(char))
    light = 0.85 - 0.82 * gaussian_filter(1 - image / WHITE, blur)
    number = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    noise = np.random.default_rng(ord(char)).normal(0, NOISE, light.shape)
    return np.clip(np.rint(WHITE * number + noise), 0, WHITE).astype(np.uint8), place


def spoiled(bench, true, upem, char, way):
    """A letter's picture as a way of spoilt.py has it, its px a font unit and the place of its origin."""
    image, place = bench.render(true, upem, PPEM, 20, "clean", ord(char))
    seen = spoilt.WAYS[way](np.random.default_rng(ord(char)), 1 - image.astype(np.float32) / WHITE, 1, PPEM)
    return seen, place


def half(image):
    """The level by which ink and paper differ most, as Otsu has it: in colours, of their luma."""
    levels = np.arange(WHITE + 1)
    counts = np.bincount(image.ravel(), minlength=WHITE + 1).astype(float)
    below, sums = np.cumsum(counts), np.cumsum(counts * levels)
    apart = (sums[-1] * below / below[-1] - sums) ** 2 / np.maximum(below * (below[-1] - below), 1)
    return np.argmax(apart) + 0.5


def letters(task):
    """The comparisons of one font drawn in one way, by tool."""
    import outline_bench as bench
    from fontTools.ttLib import TTFont

    khatts, name, (draw, how), every = task
    path, charset, _ = bench.FONTS[name]
    font = TTFont(path)
    glyphs, cmap, upem = font.getGlyphSet(), font.getBestCmap(), font["head"].unitsPerEm
    tools = {"potrace": bench.tool_potrace}
    tools |= {tool: bench.custom(f"{exe} --quiet trace {{in}} -o {{out}}") for tool, exe in khatts.items()}
    if draw is in_srgb:
        for tones in ("srgb", "profile"):
            told = {f"{tool} --tones {tones}": f"{exe} --quiet trace --tones {tones} {{in}} -o {{out}}" for tool, exe in khatts.items()}
            tools |= {tool: bench.custom(command) for tool, command in told.items()}
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes() if draw is in_srgb else None
    found = {tool: [] for tool in tools}
    with tempfile.TemporaryDirectory() as folder:
        files = {end: os.path.join(folder, f"letter.{end}") for end in ("png", "pbm", "svg")}
        files |= {"in": files["png"], "out": files["svg"]}
        for char in [c for c in bench.charset(charset) if ord(c) in cmap][::every]:
            true = bench.true_outline(font, glyphs, cmap[ord(char)])
            if not true:
                continue
            image, (scale, left, foot) = draw(bench, true, upem, char, how)
            Image.fromarray(image).save(files["png"], icc_profile=profile)
            if draw is spoiled:
                image = np.asarray(Image.fromarray(image).convert("L"))
                level = half(image)
            else:
                level = (float(image.min()) + float(image.max())) / 2
            Image.fromarray(np.where(image < level, 0, WHITE).astype(np.uint8)).convert("1", dither=0).save(files["pbm"])
            for tool, trace in tools.items():
                got, _ = trace(files)
                got = [[tuple(((x - left) / scale, (foot - y) / scale) for x, y in s) for s in c] for c in got]
                found[tool].append(bench.compare(true, bench.clean(got, upem * 2e-4), upem, PPEM))
    return name, how if draw is spoiled else f"{draw.__name__.replace('_', ' ')}, {how:g}", found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", action="append", required=True)
    parser.add_argument("--bench", required=True, help="folder of outline_bench.py")
    parser.add_argument("--blur", default="2,3,5", help="px")
    parser.add_argument("--enlarge", default="2,3", help="times")
    parser.add_argument("--srgb", action="store_true")
    parser.add_argument("--ways", default="", help=f"of {', '.join(spoilt.WAYS)}")
    parser.add_argument("--every", type=int, default=3, help="of so many letters one is drawn")
    args = parser.parse_args()
    sys.path.insert(0, args.bench)
    import outline_bench as bench

    khatts = dict(k.split("=", 1) if "=" in k else ("khatt", k) for k in args.khatt)
    ways = [(out_of_focus, float(px)) for px in args.blur.split(",") if px]
    ways += [(enlarged, int(times)) for times in args.enlarge.split(",") if times]
    ways += [(in_srgb, 0.9)] if args.srgb else []
    ways += [(spoiled, way) for way in args.ways.split(",") if way]
    tasks = [(khatts, font, way, args.every) for font in bench.FONTS for way in ways]
    print("| font | picture | tool | letters | " + " | ".join(COLUMNS) + " |")
    print("|---" * (4 + len(COLUMNS)) + "|")
    with Pool() as pool:
        for font, picture, found in pool.imap(letters, tasks):
            for tool, all in found.items():
                rows = [row for row in all if row]
                largest = [row["max"] for row in rows]
                corners = np.mean([row["corner_f1"] for row in rows])
                nodes = sum(row["nodes"] for row in rows) / sum(row["true_nodes"] for row in rows)
                mean, node_f1 = (np.mean([row[key] for row in rows]) for key in ("mean", "node_f1"))
                figures = f"{mean:.3f} | {np.median(largest):.2f} | {max(largest):.2f} | {nodes:.2f} | {corners:.3f} | {node_f1:.3f}"
                print(f"| {font} | {picture} | {tool} | {len(rows)} of {len(all)} | {figures} |", flush=True)


if __name__ == "__main__":
    main()

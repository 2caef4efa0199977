#!/usr/bin/env python3
"""Bare pages cut with `layout = "free"`: which letters come out in order and whole. A row of BENCHMARKS.md's "Bare pages" for each.

    python3 tests/bench/bare.py --khatt target/release/khatt --bench ../shared/bench --fonts /usr/share/fonts \\
        'FreeSans.ttf --rows 8 --cols 9 --skew 2' 'KacstBook.ttf --forms --rows 12 --cols 10 --condition rough'

A page is a font's file, found below --fonts, and options of make_sheet.py, as in untried.py; --pages FILE reads one a line, as bare.txt,
bare-unseen.txt, bare-uneven.txt, bare-slopes.txt, bare-tilted.txt, bare-later.txt, bare-last.txt and bare-drawn.txt have them. Pages of --forms are read from the right. A piece is a letter's where half of its ink lies in the letter's cell; a letter has its pieces where
its cell has all of its own and none of another letter's. Dust is ink of no letter, a dot's worth or more, in a cell. Behind the figures of
the free page stand those of the same page as a grid. Baselines are compared with the page's own, of the letters in order: how far they scatter
(standard deviation) and how far the worst lies from the median, in 1/1000 em; a page drawn with jitter has that much in it. --keep FOLDER keeps pages and cells, and draws none anew that is there. --forget N
cuts each page so often again with one name left out, and counts how often that is told, and told at its place or the next one, and where names stand in lines, and as often with one name too many. A page's
own options --stray MM and --slope DEGREES move its rows up and down and let them slope by so much in the mean; --tilt SHARE shows it with its
left side that much nearer than its middle, and how much letters then differ in size, a standard deviation, stands behind the baselines. --build appends what font_bench.py says of the font of each bare
page.
Needs numpy, scipy, pillow and what make_sheet.py needs.
"""
import argparse, glob, json, os, re, shlex, subprocess, sys, tempfile, time, zlib
import numpy as np
from PIL import Image
from scipy.ndimage import binary_dilation, label

# ink this far from a letter is not the letter's own edge, px
EDGE = 3
# what is said of letters whose dots are not as many as their names have
SIGNS = "beside its body where"
# paper around a letter that goes with it where its row is moved, px
AROUND = 6
# area of the least dust that counts, px²
DUST = 6
# area of the least piece of a letter that counts, em²: a dot has twice that in the thinnest styles, needles of outlines have less
NEEDLE = 0.0005


def draw(bench, font, options, folder):
    """The truth of a page that is drawn unless it is kept already."""
    picture = os.path.join(folder, "page.png")
    if not os.path.exists(picture + ".json"):
        own = argparse.ArgumentParser()
        own.add_argument("--stray", type=float, default=0)
        own.add_argument("--slope", type=float, default=0)
        own.add_argument("--tilt", type=float, default=0)
        own, options = own.parse_known_args(options)
        command = [sys.executable, os.path.join(bench, "make_sheet.py"), "--font-file", font, "--chars", "latin"]
        subprocess.run(command + options + ["--out", picture], check=True, capture_output=True)
        if own.stray or own.slope:
            stray(picture, own.stray, own.slope)
        if own.tilt:
            tilt(picture, own.tilt)
    return json.load(open(picture + ".json"))


def stray(picture, mm, degrees):
    """Moves the rows of a page up and down and lets them slope, as they stand where no line guides a hand, by standard deviations of so
    many mm and degrees; letters stay upright."""
    truth, page = json.load(open(picture + ".json")), Image.open(picture)
    old = np.asarray(page).copy()
    new, rng = old.copy(), np.random.default_rng(zlib.crc32(truth["font"].encode()))
    moves = rng.normal(0, mm * truth["dpi"] / 25.4, truth["rows"])
    slopes = np.tan(np.radians(rng.normal(0, degrees, truth["rows"])))
    boxes = []
    for cell in truth["cells"]:
        (left, top), (right, bottom) = (np.floor(cell["ink_box"])[k : k + 2].astype(int) for k in (0, 2))
        boxes.append((slice(max(0, top - AROUND), bottom + AROUND + 1), slice(max(0, left - AROUND), right + AROUND + 1)))
        ring = old[boxes[-1]]
        new[boxes[-1]] = np.median(np.concatenate([ring[0], ring[-1], ring[:, 0], ring[:, -1]]))
    for cell, (down, across) in zip(truth["cells"], boxes):
        aside = (across.start + across.stop - new.shape[1]) / 2
        move = round(moves[cell["row"]] + slopes[cell["row"]] * aside)
        move = int(np.clip(move, -down.start, len(new) - down.stop))
        there = new[down.start + move : down.stop + move, across]
        np.minimum(there, old[down, across], out=there)
        cell["ink_box"] = [v + move * (k % 2) for k, v in enumerate(cell["ink_box"])]
        cell["origin_px"][1] += move
        cell["map"][5] += move
    Image.fromarray(new).save(picture, dpi=page.info.get("dpi"))
    json.dump(truth, open(picture + ".json", "w"), ensure_ascii=False, indent=1)


def tilt(picture, share):
    """Shows a page with its left side nearer than its middle by a share."""
    truth, page = json.load(open(picture + ".json")), Image.open(picture)
    x, y = (side / 2 for side in page.size)
    g = share / x
    back = [1 - g * x, 0, g * x * x, -g * y, 1, g * x * y, -g, 0]
    back = np.array(back) / (1 + g * x)
    page.transform(page.size, Image.PERSPECTIVE, back, Image.BICUBIC, fillcolor=255).save(picture, dpi=page.info.get("dpi"))
    for cell in truth["cells"]:
        cell["tilt"] = [g, x, y]
        left, top, right, bottom = cell["ink_box"]
        ends = np.array(seen(cell, np.array([left, right, left, right]), np.array([top, top, bottom, bottom])))
        cell["ink_box"] = [*ends.min(1), *ends.max(1)]
        cell["origin_px"] = [float(v) for v in seen(cell, *cell["origin_px"])]
    json.dump(truth, open(picture + ".json", "w"), ensure_ascii=False, indent=1)


def seen(cell, x, y):
    """Where the picture has a place of the page."""
    g, *middle = cell.get("tilt", [0, 0, 0])
    nearer = 1 + g * (x - middle[0])
    return middle[0] + (x - middle[0]) / nearer, middle[1] + (y - middle[1]) / nearer


def outline(font, cell):
    """A cell's outline in px of the page, flattened, as make_sheet.py drew it."""
    import make_sheet as ms
    import outline_bench as ob
    from fontTools.ttLib import TTFont

    if "." in cell["name"] or "\u200d" in cell["text"] or cell["name"].startswith("uni0"):
        contours = ms.shaped_outline(font, cell["text"])[0]
    else:
        known = outline.cache.setdefault(font, TTFont(font))
        contours = ob.true_outline(known, known.getGlyphSet(), cell["name"])
    a, b, c, d, e, f = cell["map"]
    for poly in ob.flatten(contours, 8):
        yield seen(cell, a * poly[:, 0] + c * poly[:, 1] + e, b * poly[:, 0] + d * poly[:, 1] + f)


outline.cache = {}


def pieces(font, truth):
    """A picture of the number of the piece to which each pixel belongs, the letter of each piece, and its area, px²."""
    import outline_bench as ob

    width, height = truth["size"]
    of, letters, areas = np.zeros((height, width), np.int32), [-1], [0]
    for i, cell in enumerate(truth["cells"]):
        left, top = (max(0, int(v) - 2) for v in cell["ink_box"][:2])
        right, bottom = (int(v) + 3 for v in cell["ink_box"][2:])
        cover = np.zeros((bottom - top, right - left + 2))
        for x, y in outline(font, cell):
            ob.cover(cover, x - left, y - top)
        ink = np.abs(np.cumsum(cover, 1)) > 0.5
        parts, count = label(ink, np.ones((3, 3)))
        here = of[top:bottom, left : left + ink.shape[1]]
        parts = parts[: here.shape[0], : here.shape[1]]
        here[(parts > 0) & (here == 0)] = parts[(parts > 0) & (here == 0)] + len(letters) - 1
        areas += [int((parts == k).sum()) for k in range(1, count + 1)]
        letters += [i] * count
    return of, np.array(letters), np.array(areas)


def names_of(truth, forms):
    """Names in reading order with the number of each one's letter; None where a row's end is empty."""
    names = [cell["name"] if forms else cell["text"] for cell in truth["cells"]]
    order = []
    for row in range(truth["rows"]):
        places = range(row * truth["cols"], (row + 1) * truth["cols"])
        order += [p if p < len(names) else None for p in (reversed(places) if forms else places)]
    return [(None if p is None else names[p], p) for p in order]


def cut(khatt, truth, layout, forms, folder, without=None, line=10**9, more=None):
    """Of each letter its cell's ink as (column, row) of the page, and how far its baseline lies below the drawn one, 1/1000 em; what was
    said of it; and the seconds taken. `without` is a place in the list of names that lacks its own; with it they are so many a
    `line`. Before the place `more` stands a name whose letter is not on the page."""
    named = [n for n in names_of(truth, forms) if layout != '"free"' or n[1] is not None]
    if more is not None:
        named.insert(more, ("uni06BE" if forms else "Þ", None))
    lines = [[n[0] or "_" for k, n in enumerate(named) if k // line == i and k != without] for i in range((len(named) - 1) // line + 1)]
    named = [n for k, n in enumerate(named) if k != without]
    kind = "free" if "free" in layout else "grid"
    project, out = os.path.join(folder, kind + ".toml"), os.path.join(folder, kind)
    with open(project, "w") as file:
        file.write(
            f'[font]\nfamily = "Bare"\n[[sheet]]\nimage = "page.png"\nlayout = {layout}\n'
            f"direction = \"{'rtl' if forms else 'ltr'}\"\nglyphs = '''{chr(10).join(map(' '.join, lines))}'''\n"
            f"pixels_per_em = {truth['ppem']}\n"
        )
    start = time.time()
    run = subprocess.run([khatt, "cut", "--quiet", project, "-o", out], capture_output=True, text=True)
    took = time.time() - start
    if run.returncode:
        return None, " ".join(run.stderr.split()), took
    found = {}
    page = json.load(open(os.path.join(out, "cells.json")))[0]
    said = " ".join(w["message"] for w in page["warnings"])
    for cell in page["cells"]:
        ink = np.asarray(Image.open(os.path.join(out, cell["picture"]))) < 128
        y, x = np.nonzero(ink)
        a, b, c, d, e, f = cell["to_sheet"]
        x, y = x + 0.5, y + 0.5
        place = named[cell["cell"] - 1][1]
        if place is None:
            continue
        pixels = np.floor([a * x + c * y + e, b * x + d * y + f]).astype(int)
        dx, dy = np.array(truth["cells"][place]["origin_px"]) - [c * cell["baseline_px"] + e, d * cell["baseline_px"] + f]
        drop = (dx * b - dy * a) / np.hypot(a, b) / truth["ppem"] * 1000
        found[place] = pixels, (drop, size(truth["cells"][place], cell["to_sheet"]))
    return found, said, took


def size(cell, to_sheet):
    """The logarithm of a letter's size in its cell, of the page's own px."""
    (x, y), (a, b, c, d, _, _) = cell["origin_px"], to_sheet
    g, middle, _ = cell.get("tilt", [0, 0, 0])
    # a place of the picture lies where the page is so much nearer
    return np.log(1 - g * (x - middle)) * 1.5 - np.log(abs(a * d - b * c)) / 2


def judge(found, truth, page):
    """Letters in order, letters with just their pieces, pieces lost, pieces of others, dust; which are wrong; scatter and worst of the
    baselines, and scatter of the sizes."""
    of, letters, areas = page
    height, width = of.shape
    sums, bad, drops = np.zeros(5, int), [], []
    for i in range(len(truth["cells"])):
        own = np.flatnonzero(letters == i)
        (x, y), drop = found.get(i, (np.zeros((2, 0), int), (0, 0)))
        inside = (x >= 0) & (y >= 0) & (x < width) & (y < height)
        x, y = x[inside], y[inside]
        ids = of[y, x]
        seen = np.bincount(ids, minlength=len(areas))
        has = seen >= 0.5 * np.maximum(areas, 1)
        has[0] = False
        lost, foreign = own[~has[own]], np.flatnonzero(has & (letters != i))
        largest = own[areas[own].argmax()] if len(own) else 0
        lost = lost[areas[lost] >= NEEDLE * truth["ppem"] ** 2]
        foreign = foreign[areas[foreign] >= NEEDLE * truth["ppem"] ** 2]
        right = largest > 0 and has[largest]
        dusty = right and dust(x, y, ids, of, own) >= DUST
        whole = right and not len(lost) and not len(foreign)
        sums += [right, whole, len(lost), len(foreign), dusty]
        if right:
            drops.append(drop)
        if not whole:
            bad.append(f"{i}:{truth['cells'][i]['name']}" + (f"-{len(lost)}" if len(lost) else "") + (f"+{len(foreign)}" if len(foreign) else ""))
    drops, sizes = np.array(drops or [(0, 0)]).T
    return sums, bad, (drops.std(), abs(drops - np.median(drops)).max(), sizes.std())


def dust(x, y, ids, of, own):
    """Pixels of a cell's ink that lie apart from all of the letter's own."""
    if not len(x) or not (ids == 0).any():
        return 0
    left, top = x.min() - EDGE, y.min() - EDGE
    mine = np.isin(of[max(0, top) : y.max() + EDGE + 1, max(0, left) : x.max() + EDGE + 1], own)
    near = binary_dilation(mine, iterations=EDGE)
    return int((~near[y - max(0, top), x - max(0, left)] & (ids == 0)).sum())


def nameless(said, lengths):
    """The letters that a message says have no name, by their first and last places on the page, from 0."""
    place = lambda row, letter: sum(lengths[: int(row) - 1]) + int(letter) - 1
    for a, b, row in re.findall(r"letters? (\d+)(?: to (\d+))? of row (\d+) seems? to have no name", said):
        yield place(row, a), place(row, b or a)
    for a, row, b, other in re.findall(r"from letter (\d+) of row (\d+) to letter (\d+) of row (\d+) seems to have no name", said):
        yield place(row, a), place(other, b)


def forgotten(khatt, truth, forms, folder, times):
    """How often a page is refused where one name of its list is left out, and how often its letter is among those told; how often where the
    names stand in lines, a row each; how often as a grid, and as one in lines; and where a name has no letter, how often it is refused, that is one
    of the names told then, and how often letters are warned of for their signs."""
    count = len(truth["cells"])
    told = near = many = spare = signs = 0
    refused = [0, 0, 0]
    for k in range(times):
        at = (2 * k + 1) * count // (2 * times)
        grid = f"{{ grid = [{truth['rows']}, {truth['cols']}] }}"
        for k, more in enumerate([('"free"', truth["cols"]), (grid, 10**9), (grid, truth["cols"])]):
            refused[k] += cut(khatt, truth, more[0], forms, folder, at, more[1])[0] is None
        found, said, _ = cut(khatt, truth, '"free"', forms, folder, more=at)
        many += found is None
        signs += found is not None and SIGNS in said
        place = [int(number) - 1 for number in re.findall(r"number (\d+)", said)]
        spare += bool(place) and place[0] <= at <= place[-1]
        found, said, _ = cut(khatt, truth, '"free"', forms, folder, at)
        if found is not None:
            continue
        told += 1
        lengths = [min(truth["cols"], count - r * truth["cols"]) for r in range(truth["rows"])]
        near += any(first <= at <= last for first, last in nameless(said, lengths))
    return f" | {told}, {near}, {refused[0]} of {times} | {refused[1]}, {refused[2]} of {times} | {many}, {spare}, {signs} of {times}"


def font_row(args, original, folder):
    """The font that khatt builds of a bare page, beside the one it was drawn from: glyphs missing and wrong, mean and worst distance, and
    the scatter of its baselines."""
    project, built, result = (os.path.join(folder, name) for name in ("font.toml", "font.ttf", "font.json"))
    with open(os.path.join(folder, "free.toml")) as cut, open(project, "w") as file:
        file.write(cut.read() + '[output]\nttf = "font.ttf"\n')
    if os.path.exists(result):
        os.remove(result)
    run = subprocess.run([args.khatt, "build", "--quiet", project], capture_output=True, text=True)
    if run.returncode:
        return f" | {' '.join(run.stderr.split())[:args.say]} | |"
    referee = [sys.executable, os.path.join(args.bench, "font_bench.py"), "--truth", os.path.join(folder, "page.png.json")]
    subprocess.run(referee + ["--original", original, "--built", built, "--json", result], capture_output=True)
    got = json.load(open(result))
    return f" | {len(got['missing'])}, {len(got['wrong'])} | {got['mean']:.2f}, {got['worst']:.1f} | {got['baseline_scatter']:.2f}"


def row(args, text, folder):
    name, *options = shlex.split(text)
    fonts = [name] if os.path.exists(name) else sorted(glob.glob(os.path.join(args.fonts, "**", glob.escape(name)), recursive=True))
    if not fonts:
        return f"| {text} | no such font below {args.fonts} |"
    truth, forms = draw(args.bench, fonts[0], options, folder), "--forms" in options
    kept = os.path.join(folder, "pieces.npz")
    if os.path.exists(kept):
        page = tuple(np.load(kept)[k] for k in ("of", "letters", "areas"))
    else:
        page = pieces(fonts[0], truth)
        np.savez_compressed(kept, of=page[0], letters=page[1], areas=page[2])
    cells = f"| {text} | {len(truth['cells'])}"
    for layout in args.layouts:
        layout = f"{{ grid = [{truth['rows']}, {truth['cols']}] }}" if layout == "grid" else '"free"'
        found, said, took = cut(args.khatt, truth, layout, forms, folder)
        if found is None:
            cells += f" | refused | | | {said[:args.say]} | | {took:.1f}"
            continue
        sums, bad, drops = judge(found, truth, page)
        shown = f" ({' '.join(bad[:args.show])})" if bad and args.show else ""
        cells += f" | {sums[0]} | {sums[1]}{shown} | {sums[2]}, {sums[3]} | {sums[4]} | {drops[0]:.1f}, {drops[1]:.1f}"
        cells += (f", ±{100 * drops[2]:.1f} %" if "--tilt" in options else "") + f" | {took:.1f}"
    if args.build and "free" in args.layouts:
        cells += font_row(args, fonts[0], folder)
    if args.forget:
        cells += forgotten(args.khatt, truth, forms, folder, args.forget)
    return cells + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py and outline_bench.py")
    parser.add_argument("--fonts", default="/usr/share/fonts", help="folder of the fonts")
    parser.add_argument("--keep", help="folder where pages and cells stay")
    parser.add_argument("--pages", help="file with a page a line")
    parser.add_argument("--only", choices=["free", "grid"], help="cut pages with one layout instead of both")
    parser.add_argument("--show", type=int, default=0, help="so many letters that lack pieces or have others' are named")
    parser.add_argument("--forget", type=int, default=0, help="cut each page so often again with one name left out")
    parser.add_argument("--build", action="store_true", help="build a font of each bare page and compare it by font_bench.py")
    parser.add_argument("--say", type=int, default=160, help="so much of why a page is refused")
    parser.add_argument("page", nargs="*", metavar="PAGE")
    args = parser.parse_args()
    args.layouts = [args.only] if args.only else ["free", "grid"]
    sys.path.insert(0, os.path.abspath(args.bench))
    listed = open(args.pages).read().splitlines() if args.pages else []
    more = " in order | whole | pieces lost, others' | dusty | baselines | s |"
    build = " font: missing, wrong | mean, worst | baselines |" if args.build else ""
    forget = " a name forgotten: told, among those told, in lines | as a grid, in lines | a name too many: refused, among those told, signs warned of |" if args.forget else ""
    print("| page | letters |" + "".join(more.replace(" in", f" {name}: in", 1) for name in args.layouts) + build + forget)
    print("|---|---|" + "---|" * (6 * len(args.layouts) + 3 * bool(build) + 2 * bool(forget)))
    for text in args.page + [line for line in listed if line.strip()]:
        with tempfile.TemporaryDirectory() as spare:
            folder = os.path.join(args.keep, "".join(text.split()).replace("'", "").replace("--", "-").replace("/", "_")) if args.keep else spare
            os.makedirs(folder, exist_ok=True)
            print(row(args, text, folder), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Fonts built from pages of any fonts beside those fonts: a row of docs/pages.md for each page.

    python3 tests/bench/untried.py --khatt target/release/khatt --bench ../shared/bench --fonts /usr/share/fonts \\
        'FreeSans.ttf --rows 8 --cols 9 --skew 2' 'KacstBook.ttf --forms --rows 12 --cols 10 --condition rough'

A page is a font's file, found below one of --fonts, and options of make_sheet.py; --pages FILE reads one a line, as untried.txt has them. What stands behind `::` goes to the project's end, as in
`:: [spacing.joining] method = "cursive"`. Of Arabic pages the last column counts the words of words.txt, shaped by HarfBuzz in the
built font, in which two letters that join share no ink. --keep FOLDER keeps pages, projects and fonts.
"""
import argparse, glob, json, os, shlex, subprocess, sys, tempfile

WORDS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "words.txt")
RIGHT = set("اأإآدذرزوؤةىء")


def page(bench, path, options, more, folder):
    """The truth of a page that is drawn unless it is kept already, and its project's file."""
    picture = os.path.join(folder, "page.png")
    if not os.path.exists(picture + ".json"):
        command = [sys.executable, os.path.join(bench, "make_sheet.py"), "--font-file", path, "--chars", "latin"]
        subprocess.run(command + options + ["--out", picture], check=True, capture_output=True)
    truth = json.load(open(picture + ".json"))
    forms = "--forms" in options
    glyphs = [cell["name"] if forms else cell["text"] for cell in truth["cells"]]
    glyphs += ["_"] * (truth["rows"] * truth["cols"] - len(glyphs))
    project = os.path.join(folder, "font.toml")
    with open(project, "w") as file:
        file.write(
            f'[font]\nfamily = "Untried"\n[[sheet]]\nimage = "page.png"\n'
            f"layout = {{ grid = [{truth['rows']}, {truth['cols']}] }}\nglyphs = '''{' '.join(glyphs)}'''\n"
            f"pixels_per_em = {truth['ppem']}\n[output]\nttf = \"out.ttf\"\nreport = \"out.json\"\n{more}\n"
        )
    return picture + ".json", project


def parted(path):
    """Words of which two letters that join share no ink, of all that the font can set."""
    import pathops
    import uharfbuzz as hb
    from fontTools.pens.transformPen import TransformPen
    from fontTools.ttLib import TTFont

    font = TTFont(path)
    glyphs, order, known = font.getGlyphSet(), font.getGlyphOrder(), font.getBestCmap()
    shaper = hb.Font(hb.Face(hb.Blob.from_file_path(path)))
    apart, seen = [], 0
    for word in open(WORDS, encoding="utf-8").read().split():
        if not all(ord(letter) in known for letter in word):
            continue
        buffer = hb.Buffer()
        buffer.add_str(word)
        buffer.guess_segment_properties()
        hb.shape(shaper, buffer)
        x, drawn = 0, {}
        for info, place in zip(buffer.glyph_infos, buffer.glyph_positions):
            pen = drawn.setdefault(info.cluster, pathops.Path()).getPen(glyphSet=glyphs)
            at = (1, 0, 0, 1, x + place.x_offset, place.y_offset)
            glyphs[order[info.codepoint]].draw(TransformPen(pen, at))
            x += place.x_advance
        seen += 1
        letters = [i for i in range(len(word)) if i in drawn]
        pairs = [(a, b) for a, b in zip(letters, letters[1:]) if word[b - 1] not in RIGHT and word[b] != "ء"]
        if not all(pathops.op(drawn[a], drawn[b], pathops.PathOp.INTERSECTION).area for a, b in pairs):
            apart.append(word)
    return f"{len(apart)} of {seen}" + (f" ({' '.join(apart[:4])})" if apart else "")


def found(name, folders):
    """The font's file: the name itself, or the first of that name below a folder; none where there is none."""
    below = [sorted(glob.glob(os.path.join(folder, "**", name), recursive=True)) for folder in folders]
    files = [name] if os.path.exists(name) else sum(below, [])
    return files[0] if files else None


def row(args, text, folder):
    text, _, more = text.partition("::")
    name, *options = shlex.split(text)
    path = found(name, args.fonts)
    if not path:
        return f"| {text} | no such font below {', '.join(args.fonts)} |"
    truth, project = page(args.bench, path, options, more.strip().replace("] ", "]\n"), folder)
    build = subprocess.run([args.khatt, "build", "--no-cache", "--quiet", project], capture_output=True, text=True)
    if build.returncode:
        return f"| {text} | {' '.join(build.stderr.split())[:300]} |"
    built = os.path.join(folder, "out.ttf")
    command = [sys.executable, os.path.join(args.bench, "font_bench.py"), "--truth", truth, "--per-glyph"]
    run = subprocess.run(command + ["--original", path, "--built", built], capture_output=True, text=True)
    with open(os.path.join(folder, "glyphs.txt"), "w") as file:
        file.write(run.stdout + run.stderr)
    if "\n{" not in run.stdout:
        return f"| {text} | {run.stderr.splitlines()[-1]} |"
    got = json.loads(run.stdout[run.stdout.index("\n{") :])
    joins = parted(built) if "--forms" in options else ""
    return (
        f"| {text} | {got['cells']} | {len(got['missing'])}, {len(got['wrong'])} | {got['mean']:.2f}"
        f" | {got['median_max']:.2f} | {got['worst']:.2f} | {got['baseline']:.1f}, {got['baseline_scatter']:.2f}"
        f" | {got['advance_error']:.1f} | {got['ots']} | {joins} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py and font_bench.py")
    parser.add_argument("--fonts", nargs="+", default=["/usr/share/fonts"], help="folders of the fonts")
    parser.add_argument("--keep", help="folder where pages and fonts stay")
    parser.add_argument("--pages", metavar="FILE", help="file with a page a line")
    parser.add_argument("page", nargs="*", metavar="PAGE")
    args = parser.parse_args()
    pages = args.page + (open(args.pages, encoding="utf-8").read().splitlines() if args.pages else [])
    print("| page | cells | missing, wrong | mean | median max | worst | baseline, its scatter | advance error | OTS | parted |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for text in pages:
        with tempfile.TemporaryDirectory() as spare:
            folder = os.path.join(args.keep, "".join(text.split()).replace("--", "-").replace("/", "_").partition("::")[0]) if args.keep else spare
            os.makedirs(folder, exist_ok=True)
            print(row(args, text, folder), flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Advances of fonts built from pages beside those of the fonts that the pages were drawn from, with the optical rule and
with one sidebearing for all.

    python3 tests/bench/spacing.py --khatt target/release/khatt --bench ../shared/bench garamond cantarell

Draws a page of each font with make_sheet.py (Arabic ones with all joining forms), and a page of words in the font's own
spacing, builds from the letters with the rule and with constant sidebearings of 0.02 to 0.09 em, and from letters and words,
and prints the median errors of the advances that font_bench.py finds, thousandths of the em.
FONT is a name that make_sheet.py knows, or NAME=PATH of another font.
"""
import argparse, json, os, subprocess, sys, tempfile

CONSTANTS = [0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09]
# written in each font's own spacing
LATIN_WORDS = (
    "hamburg minimum onion vivid quilt jacket zebra fixed shadow kettle pyjama woven cycle extra lazy brown "
    "judge quick vowel fresh milk bird cloud Paris Orion Naples Kyoto Vienna Quito Lagos Tunis Hamburg Dublin Fes Yemen "
    "Warsaw Zagreb Java Madrid Izmir Boston Cairo Granada Utrecht Xenia Riga Lima Oslo"
).split()
# make_sheet.py with words in the place of forms
DRAW_WORDS = (
    "import sys; sys.path.insert(0, sys.argv.pop(1)); words = sys.argv.pop(1).split(); import make_sheet; "
    "make_sheet.arabic_forms = lambda: [(word, word) for word in words]; make_sheet.main()"
)
ARABIC = ("amiri", "notonaskh", "scheherazade", "dejavu-arabic")


def page(bench, font, folder):
    """The project of a page of the font without its spacing, and the font's file."""
    name, _, path = font.partition("=")
    command = [sys.executable, os.path.join(bench, "make_sheet.py"), "--rows", "12", "--cols", "10", "--dpi", "400"]
    command += ["--font-file", path, "--chars", "latin"] if path else ["--font", name]
    command += ["--forms", "--lines", "light"] if name in ARABIC else []
    picture = os.path.join(folder, name + ".png")
    subprocess.run(command + ["--out", picture], check=True, capture_output=True)
    truth = json.load(open(picture + ".json"))
    glyphs = [cell["name"] if name in ARABIC else cell["text"] for cell in truth["cells"]]
    rows, cols = truth["rows"], truth["cols"]
    glyphs += ["_"] * (rows * cols - len(glyphs))
    text = (
        f'[font]\nfamily = "Spacing"\n[[sheet]]\nimage = "{name}.png"\nlayout = {{ grid = [{rows}, {cols}] }}\n'
        f"glyphs = '''{' '.join(glyphs)}'''\npixels_per_em = {truth['ppem']}\n[output]\nttf = \"out.ttf\"\n"
    )
    if path:
        return text, path, picture
    sys.path.insert(0, bench)
    import outline_bench

    return text, outline_bench.FONTS[name][0], picture


def words(bench, font, folder):
    """The table of a page of words."""
    name, _, path = font.partition("=")
    known = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "words.txt")
    text = " ".join(open(known, encoding="utf-8").read().split()[:48] if name in ARABIC else LATIN_WORDS)
    picture = os.path.join(folder, name + "-words.png")
    command = [sys.executable, "-c", DRAW_WORDS, bench, text, "--forms", "--rows", "12", "--cols", "4", "--dpi", "400"]
    command += ["--ppem", "150", "--out", picture] + (["--font-file", path] if path else ["--font", name])
    subprocess.run(command, check=True, capture_output=True)
    return (
        f'[[sheet]]\nimage = "{name}-words.png"\ncontent = "words"\nlayout = {{ grid = [12, 4] }}\n'
        f"glyphs = '''{text}'''\npixels_per_em = 150\n"
    )


def error(args, text, original, picture, spacing):
    folder = os.path.dirname(picture)
    project = os.path.join(folder, "font.toml")
    with open(project, "w") as file:
        file.write(text + spacing)
    subprocess.run([args.khatt, "build", "--quiet", project], check=True)
    command = [sys.executable, os.path.join(args.bench, "font_bench.py"), "--truth", picture + ".json"]
    command += ["--original", original, "--built", os.path.join(folder, "out.ttf")]
    run = subprocess.run(command, capture_output=True, text=True)
    return json.loads(run.stdout[run.stdout.index("{") :])["advance_error"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--bench", required=True, help="folder of make_sheet.py and font_bench.py")
    parser.add_argument("fonts", nargs="+", metavar="FONT")
    args = parser.parse_args()
    print("| font | khatt | with words | 0.05 em | best constant | khatt ÷ 0.05 em | with words ÷ 0.05 em | ÷ best |")
    print("|---|---|---|---|---|---|---|---|")
    for font in args.fonts:
        with tempfile.TemporaryDirectory() as folder:
            one = page(args.bench, font, folder)
            rule = error(args, *one, "")
            learnt = error(args, *one, words(args.bench, font, folder))
            constant = {c: error(args, *one, f"[spacing.letters]\nsidebearing = {c}\n") for c in CONSTANTS}
            best = min(constant, key=constant.get)
            usual = constant[0.05]
            print(
                f"| {font.partition('=')[0]} | {rule:.1f} | {learnt:.1f} | {usual:.1f} | {constant[best]:.1f} ({best} em)"
                f" | {rule / usual:.2f} | {learnt / usual:.2f} | {learnt / constant[best]:.2f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()

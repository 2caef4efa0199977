#!/usr/bin/env python3
"""Advances of fonts built from pages beside those of the fonts that the pages were drawn from, with the optical rule and
with one sidebearing for all.

    python3 tests/bench/spacing.py --khatt target/release/khatt --bench ../shared/bench garamond cantarell

Draws a page of each font with make_sheet.py (Arabic ones with all joining forms), builds it with the rule and with constant
sidebearings of 0.02 to 0.09 em, and prints the median errors of the advances that font_bench.py finds, thousandths of the em.
FONT is a name that make_sheet.py knows, or NAME=PATH of another font.
"""
import argparse, json, os, subprocess, sys, tempfile

CONSTANTS = [0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09]
ARABIC = ("amiri", "notonaskh", "scheherazade", "dejavu-arabic")


def page(bench, font, folder):
    """The project of a page of the font without its spacing, and the font's file."""
    name, _, path = font.partition("=")
    command = [sys.executable, os.path.join(bench, "make_sheet.py"), "--rows", "10", "--cols", "8", "--dpi", "400"]
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
    print("| font | khatt | 0.05 em | best constant | khatt ÷ 0.05 em | khatt ÷ best |\n|---|---|---|---|---|---|")
    for font in args.fonts:
        with tempfile.TemporaryDirectory() as folder:
            one = page(args.bench, font, folder)
            rule = error(args, *one, "")
            constant = {c: error(args, *one, f"[spacing.letters]\nsidebearing = {c}\n") for c in CONSTANTS}
            best = min(constant, key=constant.get)
            usual = constant[0.05]
            print(
                f"| {font.partition('=')[0]} | {rule:.1f} | {usual:.1f} | {constant[best]:.1f} ({best} em)"
                f" | {rule / usual:.2f} | {rule / constant[best]:.2f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()

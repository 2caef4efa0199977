#!/usr/bin/env python3
"""What the field's own tools say of built fonts: each is named with what it found, and one failure fails the run.

    python3 tests/bench/checks.py build/KhattArabic.* [--text 'بسم الله لا خط']

TTF, OTF and WOFF2: ots-sanitize accepts it, FontTools reads every table, HarfBuzz shapes the text without .notdef.
UFO: ufoLib2
opens it and reads every glyph. Needs `pip install opentype-sanitizer fonttools[woff] uharfbuzz ufoLib2`.
"""
import argparse, io, os, sys
import ots
import ufoLib2
import uharfbuzz
from fontTools.ttLib import TTFont


def sanitized(path):
    run = ots.sanitize(path, capture_output=True)
    return None if run.returncode == 0 else (run.stderr or run.stdout).decode().strip()


def tables(path):
    font = TTFont(path)
    return [tag for tag in font.keys() if font[tag] is None]


def shaped(path, text):
    """Glyph names of a text in visual order."""
    font = TTFont(path)
    font.flavor = None
    plain = io.BytesIO()
    font.save(plain)
    buffer = uharfbuzz.Buffer()
    buffer.add_str(text)
    buffer.guess_segment_properties()
    uharfbuzz.shape(uharfbuzz.Font(uharfbuzz.Face(plain.getvalue())), buffer)
    return [font.getGlyphName(info.codepoint) for info in buffer.glyph_infos]


def check_font(path, text):
    problems = [f"ots-sanitize: {said}" for said in [sanitized(path)] if said]
    problems += [f"table {tag} does not read" for tag in tables(path)]
    characters = TTFont(path).getBestCmap()
    if not all(ord(c) in characters for c in text):
        return problems, "text not covered"
    names = shaped(path, text)
    if ".notdef" in names:
        problems.append(f"HarfBuzz: {names}")
    return problems, " ".join(names)


def check_ufo(path, _):
    font = ufoLib2.Font.open(path, lazy=False, validate=True)
    points = sum(len(contour) for glyph in font for contour in glyph)
    return [], f"{len(font)} glyphs, {points} points"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("outputs", nargs="+", help=".ttf, .otf, .woff2 and .ufo; others are passed over")
    parser.add_argument("--text", default="بسم الله لا خط")
    args = parser.parse_args()
    checks = {".ttf": check_font, ".otf": check_font, ".woff2": check_font, ".ufo": check_ufo}
    failed = seen = 0
    for path in args.outputs:
        check = checks.get(os.path.splitext(path.rstrip("/"))[1])
        if not check:
            continue
        problems, found = check(path, args.text)
        print(f"{path}: {'; '.join(problems) or 'ok'}\n    {found}")
        seen, failed = seen + 1, failed + bool(problems)
    if not seen:
        sys.exit("no .ttf, .otf, .woff2 or .ufo among the arguments")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()

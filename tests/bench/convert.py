"""Whether a converted font is the same font: convert.py BEFORE AFTER [AXIS=VALUE...].

Says whether OTS takes it, how many of ten words HarfBuzz shapes alike (glyphs, advances, offsets), which part of the
ink's pixels differ at 100 px an em, and how many glyphs of 301 texts of all characters are others or stand otherwise. A variable font is taken at the given location, by fontTools' instancer.
Needs fonttools, numpy, uharfbuzz, freetype-py, opentype-sanitizer.
"""
import random
import sys
import tempfile

import freetype
import numpy as np
import ots
import uharfbuzz as hb
from fontTools.ttLib import TTFont
from fontTools.varLib import instancer

LATIN = "Office affluent Water AVATAR fjord quick Zephyr 1234 To. ffi".split()
ARABIC = "بسم الله الرحمن السلام عليكم كتاب لا إلى مدرسة قلم".split()


def shaped(path, words):
    font = hb.Font(hb.Face(hb.Blob.from_file_path(path)))
    out = []
    for word in words:
        buffer = hb.Buffer()
        buffer.add_str(word)
        buffer.guess_segment_properties()
        hb.shape(font, buffer)
        pairs = zip(buffer.glyph_infos, buffer.glyph_positions)
        out.append([(i.codepoint, p.x_advance, p.x_offset, p.y_offset) for i, p in pairs])
    return out


def unpacked(path):
    """The font itself, or a copy that is no WOFF2, which neither HarfBuzz nor FreeType need read."""
    font = TTFont(path)
    if not font.flavor:
        return path
    font.flavor, copy = None, tempfile.mktemp(suffix=".ttf")
    font.save(copy)
    return copy


def ink(path, chars):
    face = freetype.Face(path)
    face.set_pixel_sizes(0, 100)
    out = []
    for char in chars:
        face.load_char(char, freetype.FT_LOAD_NO_HINTING | freetype.FT_LOAD_RENDER)
        bitmap, page = face.glyph.bitmap, np.zeros((600, 800))
        top, left = 300 - face.glyph.bitmap_top, 300 + face.glyph.bitmap_left
        if bitmap.width:
            rows = np.array(bitmap.buffer).reshape(bitmap.rows, bitmap.pitch)[:, : bitmap.width]
            page[top : top + bitmap.rows, left : left + bitmap.width] = rows
        out.append(page)
    return np.array(out)


before, after = sys.argv[1:3]
taken = ots.sanitize(after, capture_output=True).returncode == 0
place = {tag: float(value) for tag, value in (a.split("=") for a in sys.argv[3:])}
if place:
    font = TTFont(before)
    whole = {a.axisTag: place.get(a.axisTag, a.defaultValue) for a in font["fvar"].axes}
    before = tempfile.mktemp(suffix=".ttf")
    instancer.instantiateVariableFont(font, whole).save(before)
before, after = (unpacked(path) for path in (before, after))
words = ARABIC if 0x628 in TTFont(before).getBestCmap() else LATIN
a, b = shaped(before, words), shaped(after, words)
chars = "".join(dict.fromkeys("".join(words)))
i, j = ink(before, chars), ink(after, chars)
alike = sum(p == q for p, q in zip(a, b))
known = [chr(c) for c in TTFont(before).getBestCmap() if c > 32]
draw = random.Random(1)
texts = ["".join(known)] + ["".join(draw.choices(known, k=60)) for _ in range(300)]
c, d = sum(shaped(before, texts), []), sum(shaped(after, texts), [])
apart = abs(len(c) - len(d)) + sum(p != q for p, q in zip(c, d))
half = 100 * (np.abs(i - j) > 127).sum() / (i > 127).sum()
grey = 100 * np.abs(i - j).sum() / i.sum()
print(f"{sys.argv[2]}: OTS {'ok' if taken else 'refuses'}, {alike} of {len(words)} words alike, {half:.3f} % of ink pixels differ by half, {grey:.3f} % of the grey; of {len(c)} glyphs of all characters {apart} otherwise")
sys.exit(not (taken and alike == len(words) and half < 0.5))

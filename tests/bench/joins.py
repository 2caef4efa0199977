#!/usr/bin/env python3
"""Smooth joins that whole units bend: of an OTF's joins that touch a curve and turn by less than 25°, the part that
turns by less than 1°.

    joins.py build/KhattArabic.otf build/KhattLatin.otf

Needs fonttools.
"""
import math, sys
from fontTools.pens.recordingPen import DecomposingRecordingPen
from fontTools.ttLib import TTFont


def contours(font):
    """The segments of each contour, as tuples of points."""
    glyphs = font.getGlyphSet()
    for name in font.getGlyphOrder():
        pen = DecomposingRecordingPen(glyphs)
        glyphs[name].draw(pen)
        segments, at = [], None
        for step, points in pen.value:
            if step == "moveTo":
                segments, at = [], points[0]
            elif step in ("lineTo", "curveTo"):
                if points[-1] != at or step == "curveTo":
                    segments.append((at, *points))
                at = points[-1]
            elif step == "closePath" and segments:
                if segments[0][0] != at:
                    segments.append((at, segments[0][0]))
                yield segments


def leaving(points):
    """The direction from the first point to the next that differs."""
    for p in points[1:]:
        if p != points[0]:
            return p[0] - points[0][0], p[1] - points[0][1]


def turns(font):
    for segments in contours(font):
        for before, after in zip([segments[-1], *segments], segments):
            back, ahead = leaving(before[::-1]), leaving(after)
            if back and ahead and len(before) + len(after) > 4:
                cross = back[1] * ahead[0] - back[0] * ahead[1]
                yield abs(math.degrees(math.atan2(cross, -back[0] * ahead[0] - back[1] * ahead[1])))


for path in sys.argv[1:]:
    smooth = [turn for turn in turns(TTFont(path)) if turn < 25]
    print(f"{path}: {sum(turn < 1 for turn in smooth) / len(smooth):.3f} of {len(smooth)}")

"""Puts the silhouettes of `make bench` into a folder: shapes.py SOURCE FONT_ARABIC FONT_LATIN OUT.

SOURCE holds africa_50m.geojson (Natural Earth), mpeg7/ and the BMP silhouettes. Needs Pillow with Raqm.
"""
import json
import math
import sys
from pathlib import Path

from PIL import Image, ImageDraw, ImageFilter, ImageFont

source, arabic, latin, out = (Path(a) for a in sys.argv[1:])
out.mkdir(parents=True, exist_ok=True)


def coast():
    """Mainland Africa's outline, degrees."""
    rings = []

    def walk(c):
        if c and isinstance(c[0][0], (int, float)):
            rings.append(c)
        else:
            for d in c:
                walk(d)

    data = json.loads((source / "africa_50m.geojson").read_text())
    for f in data["features"] if "features" in data else [data]:
        walk(f.get("geometry", f)["coordinates"])
    return max(rings, key=len)


def equal_area(longitude, latitude):
    """Lambert's azimuthal projection around 0° N 20° E, the usual one of a map of Africa."""
    x, y = math.radians(longitude - 20.0), math.radians(latitude)
    k = math.sqrt(2.0 / (1.0 + math.cos(y) * math.cos(x)))
    return k * math.cos(y) * math.sin(x), k * math.sin(y)


def boxed(points, width, height):
    """Points, y up, with their box brought to 0…width x 0…height, y down."""
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    sx, sy = width / (max(xs) - min(xs)), height / (max(ys) - min(ys))
    return [((p[0] - min(xs)) * sx, (max(ys) - p[1]) * sy) for p in points]


def africa(width=164, height=175):
    """The coast by longitude and latitude, and as a map shows it; the latter also smoothed, to the paper's 507 points
    and on the way there."""
    image = Image.new("L", (width, height), 255)
    ImageDraw.Draw(image).polygon(boxed(coast(), width - 1, height - 1), fill=0)
    image.save(out / "africa.png")
    fine, margin = 16, 12
    outline = boxed([equal_area(*p) for p in coast()], width * fine, height * fine)
    image = Image.new("L", ((width + 2 * margin) * fine, (height + 2 * margin) * fine), 255)
    ImageDraw.Draw(image).polygon([(x + margin * fine, y + margin * fine) for x, y in outline], fill=0)
    land = image.reduce(fine)
    blurred(land, 0.0).save(out / "africa-map.png")
    for points in (520, 511, 507):
        smoothed(land, points).save(out / f"africa-{points}.png")


def smoothed(image, points):
    """Smoothed just enough that its boundary has so many points, or the next fewer."""
    low, high = 0.0, 8.0
    for _ in range(24):
        middle = (low + high) / 2
        if length(blurred(image, middle)) > points:
            low = middle
        else:
            high = middle
    print(f"smoothed by {high:.3f} px: {length(blurred(image, high))} points")
    return blurred(image, high)


def blurred(image, radius):
    soft = image.filter(ImageFilter.GaussianBlur(radius))
    return soft.point(lambda v: 255 if v > 127 else 0)


def length(image):
    """Steps around the outer boundary of the shape met first from the top: pixels, 8-connected, counter-clockwise."""
    around = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
    size, pixels = image.size, image.load()

    def ink(x, y):
        return 0 <= x < size[0] and 0 <= y < size[1] and pixels[x, y] < 128

    start = next((x, y) for y in range(size[1]) for x in range(size[0]) if ink(x, y))
    at, back, count, first = start, 4, 0, None
    while True:
        turns = [(back + k) % 8 for k in range(1, 9)]
        way = next(k for k in turns if ink(at[0] + around[k][0], at[1] + around[k][1]))
        if (at, way) == first:
            return count
        first = first or (at, way)
        at, back, count = (at[0] + around[way][0], at[1] + around[way][1]), (way + 4) % 8, count + 1


def drawn(name, width, height):
    """A silhouette given by its outline, filled, its box brought to width x height pixels."""
    outline = Image.open(source / name).convert("L")
    ground = Image.new("L", (outline.width + 2, outline.height + 2), 255)
    # the outline is the rarer of the two colours
    dark = sum(outline.histogram()[:128]) * 2 < outline.width * outline.height
    ground.paste(outline if dark else outline.point(lambda v: 255 - v), (1, 1))
    ImageDraw.floodfill(ground, (0, 0), 128)
    shape = ground.point(lambda v: 0 if v == 128 else 255)
    shape = shape.crop(shape.getbbox()).point(lambda v: 255 - v)
    return shape.resize((width, height), Image.LANCZOS).point(lambda v: 255 if v > 127 else 0)


def word(text, font, size, name):
    """A word in black on white, on a pixel grid of that size."""
    face = ImageFont.truetype(str(font), size)
    box = face.getbbox(text)
    image = Image.new("L", (box[2] - box[0] + 20, box[3] - box[1] + 20), 255)
    ImageDraw.Draw(image).text((10 - box[0], 10 - box[1]), text, font=face, fill=0)
    image.point(lambda v: 255 if v > 127 else 0).save(out / name)


africa()
drawn("Africa.bmp", 164, 175).save(out / "africa-drawn.png")
word("علي", arabic, 274, "ali.png")
word("D", latin, 212, "d.png")
word("س", arabic, 200, "seen.png")
for name, file, factor in [
    ("leaf.png", "Maple_leaf.bmp", 1.0),
    ("plane.png", "Plane4.bmp", 3.0),
    ("plane-1.png", "Plane1.bmp", 3.0),
    ("plane-3.png", "Plane3.bmp", 3.0),
    ("apple.png", "mpeg7/apple-1.png", 1.7),
    ("key-1.png", "mpeg7/key-1.png", 0.36),
    ("key-2.png", "mpeg7/key-2.png", 0.36),
    ("key-3.png", "mpeg7/key-3.png", 0.36),
]:
    # as large as the papers' own, by the number of boundary points
    image = Image.open(source / file).convert("L")
    size = (round(image.width * factor), round(image.height * factor))
    image.resize(size, Image.LANCZOS).point(lambda v: 255 if v > 127 else 0).save(out / name)

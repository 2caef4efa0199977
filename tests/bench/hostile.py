#!/usr/bin/env python3
"""Gives khatt bad inputs and prints what each got: exit status, processor seconds, peak memory, the first line of the answer.

    python3 tests/bench/hostile.py --khatt target/release/khatt [NAME…]

An input passes when the program answers it within 100 seconds of one processor and 6 GB (the largest
page allowed, 300 Mpx, takes as much), with status 0, 1 or 2, without a panic, and leaves
no output where it failed. Nothing but Python is needed.
"""
import argparse, os, pathlib, random, resource, struct, subprocess, sys, tempfile, threading, zlib

LONGEST, MOST = 100, 6 << 30
# Seconds by the clock after which a program that only waits is stopped.
PATIENCE = 900
# The same noise in each run.
NOISE = random.Random(5)


def png(width, height, rows, bits=8):
    """A grey PNG; `rows` gives the bytes of each row."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    packer = zlib.compressobj(6)
    body = b"".join(packer.compress(b"\0" + row) for row in rows) + packer.flush()
    head = struct.pack(">IIBBBBB", width, height, bits, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def pattern(side, ink):
    return png(side, side, (bytes(0 if ink(x, y) else 255 for x in range(side)) for y in range(side)))


def pdf(objects):
    out, places = b"%PDF-1.4\n", []
    for number, body in enumerate(objects, 1):
        places.append(len(out))
        out += b"%d 0 obj\n" % number + body + b"\nendobj\n"
    table = len(out)
    out += b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1) + b"".join(b"%010d 00000 n \n" % p for p in places)
    return out + b"trailer\n<</Size %d/Root 1 0 R>>\nstartxref\n%d\n%%%%EOF\n" % (len(objects) + 1, table)


def pdf_image(width, height, data):
    page = b"<</Type/Page/Parent 2 0 R/MediaBox[0 0 99 99]/Resources<</XObject<</I 5 0 R>>>>/Contents 4 0 R>>"
    draw = b"q 99 0 0 99 0 0 cm /I Do Q"
    head = b"<</Type/XObject/Subtype/Image/Width %d/Height %d/BitsPerComponent 8/ColorSpace/DeviceGray" % (width, height)
    return pdf([b"<</Type/Catalog/Pages 2 0 R>>", b"<</Type/Pages/Kids[3 0 R]/Count 1>>", page,
                b"<</Length %d>>stream\n%s\nendstream" % (len(draw), draw),
                head + b"/Filter/FlateDecode/Length %d>>stream\n" % len(data) + data + b"\nendstream"])


def zeros(count):
    packer = zlib.compressobj(9)
    block = bytes(1 << 20)
    return b"".join(packer.compress(block) for _ in range(count >> 20)) + packer.flush()


def letters(side=160):
    """A page of four letters in a row."""
    def ink(x, y):
        n, u, v = x // 40, x % 40, y - 10
        bars = [(10 <= u < 15), (25 <= u < 30), (8 <= u < 13 and n > 0), (n > 1 and v > 30)]
        return 0 <= v < 40 and 5 <= u < 33 and (bars[n] or v < 5 * (n + 1) % 17)
    return png(side, 60, (bytes(0 if ink(x, y) else 255 for x in range(side)) for y in range(60)))


def lzw_bomb():
    """A GIF that claims 65535 × 65535 px."""
    return b"GIF89a" + struct.pack("<HHBBB", 65535, 65535, 0x80, 0, 0) + b"\0\0\0\xff\xff\xff," + \
        struct.pack("<HHHHB", 0, 0, 65535, 65535, 0) + b"\x02\x02\x44\x01\0;"


def tiff_loop():
    """A TIFF whose directory is its own successor."""
    entries = [(256, 3, 1, 2), (257, 3, 1, 2), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, 4), (279, 4, 1, 4)]
    return b"II*\0" + struct.pack("<I", 8) + struct.pack("<H", len(entries)) + \
        b"".join(struct.pack("<HHII", *e) for e in entries) + struct.pack("<I", 8)


PROJECT = """[font]
family = "A"

[[sheet]]
image = "page.png"
layout = { grid = [1, 4] }
glyphs = "A B C D"
pixels_per_em = 60

[output]
ttf = "out.ttf"
proof = "out.html"
"""
SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100">%s</svg>'


def pictures():
    yield "empty file", b""
    yield "text", b"not a picture\n" * 100
    yield "PNG cut off", pattern(40, lambda x, y: x > y)[:80]
    yield "PNG of 60 000 × 60 000 px by its head", png(60000, 60000, [])
    yield "PNG bomb: 280 Mpx of paper in 34 kB", png(20000, 14000, (b"\xff" * 2500 for _ in range(14000)), bits=1)
    yield "GIF of 65 535 × 65 535 px by its head", lzw_bomb()
    yield "TIFF whose pages go round in a loop", tiff_loop()
    yield "PDF bomb: 1 GB of zeros in 1 MB", pdf_image(30000, 30000, zeros(1 << 30))
    yield "PDF whose pages are their own parents", pdf([b"<</Type/Catalog/Pages 2 0 R>>", b"<</Type/Pages/Kids[2 0 R]/Count 1>>"])
    yield "10⁶ specks", pattern(2000, lambda x, y: x % 2 == 0 and y % 2 == 0)
    yield "10⁵ contours", pattern(1600, lambda x, y: x % 5 < 3 and y % 5 < 3)
    yield "comb of 500 teeth, 900 px long and 1 px thick", pattern(1000, lambda x, y: x % 2 == 0 or y > 900)
    yield "one pixel", pattern(1, lambda x, y: True)
    yield "all ink", pattern(1000, lambda x, y: True)
    yield "noise", png(1000, 1000, (NOISE.randbytes(1000) for _ in range(1000)))


def projects(folder):
    def changed(old, new):
        assert old in PROJECT
        return PROJECT.replace(old, new)
    last = "pixels_per_em = 60\n"
    for value in ("nan", "inf", "-1", "0", "1e308", "1e-300"):
        yield f"tolerance_px = {value}", changed(last, f"{last}[trace]\ntolerance_px = {value}\n")
    yield "pixels_per_em = 1e-300", changed("= 60", "= 1e-300")
    yield "tolerance_em = nan", changed(last, f"{last}[quadratic]\ntolerance_em = nan\n")
    yield "space = nan", changed(last, f"{last}[spacing]\nspace = nan\n")
    yield "grid of 10⁹ × 10⁹", changed("[1, 4]", "[1000000000, 1000000000]")
    yield "10⁵ labels", changed("A B C D", "A " * 100000)
    yield "the same letter twice", changed("A B C D", "A B C A")
    yield "picture is a folder", changed("page.png", ".")
    yield "picture is /dev/zero", changed("page.png", "/dev/zero")
    yield "picture is a pipe that nobody writes to", changed("page.png", "pipe")
    yield "picture is a link to itself", changed("page.png", "loop.png")
    yield "picture in the parent folder", changed("page.png", "../project/page.png")
    yield "output over the picture", changed("out.ttf", "page.png")
    yield "output over the project file", changed("out.ttf", "project.toml")
    yield "two outputs of one name", changed("out.html", "./out.ttf")
    yield "output is a folder that holds files", changed("out.ttf", "full")
    yield "output in a folder that cannot be made", changed("out.ttf", "page.png/out.ttf")
    yield "output into /proc", changed("out.ttf", "/proc/out.ttf")
    yield "family name with a script in it", changed('"A"', '"</title><script>alert(1)</script>"')
    yield "family name of 10⁵ letters", changed('"A"', '"' + "x" * 100000 + '"')
    yield "tables nested 10⁵ deep", "a=" + "[" * 100000
    yield "not UTF-8", b"[font]\nfamily = \"\xff\"\n"
    yield "reference is no font", changed(last, f'{last}[match]\nreference = "page.png"\n')


def drawings():
    lol = "".join(f'<!ENTITY l{i} "' + f"&l{i - 1};" * 10 + '">' for i in range(1, 10))
    yield "entities that grow to 10⁹", f'<!DOCTYPE svg [<!ENTITY l0 "lol">{lol}]>' + SVG % "<text>&l9;</text>"
    yield "entity from a file", '<!DOCTYPE svg [<!ENTITY f SYSTEM "file:///etc/hostname">]>' + SVG % "<text>&f;</text>"
    yield "picture from a file", SVG % '<image xlink:href="file:///etc/hostname" width="9" height="9"/><path d="M0 0h9v9z"/>'
    yield "groups nested 10⁵ deep", SVG % ("<g>" * 100000 + '<path d="M0 0h9v9z"/>' + "</g>" * 100000)
    yield "use of itself", SVG % '<g id="a"><use xlink:href="#a"/><path d="M0 0h9v9z"/></g>'
    use = "<use xlink:href='#a%d'/>"
    uses = "".join(f'<g id="a{i}">{(use % (i - 1)) * 10}</g>' for i in range(1, 10))
    yield "uses that grow to 10⁹", SVG % f'<defs><path id="a0" d="M0 0h9v9z"/>{uses}</defs><use xlink:href="#a9"/>'
    yield "path of 10⁶ points", SVG % f'<path d="M0 0{"l1 1 1 -1" * 500000}z"/>'
    yield "numbers beyond all bounds", SVG % '<path d="M0 0L1e39 1e39 -1e39 NaN z"/>'
    yield "view box without size", SVG.replace("100 100", "0 0") % '<path d="M0 0h9v9z"/>'
    yield "stroke of 10⁷ dashes", SVG % '<path d="M0 50h100" stroke="#000" stroke-width="9" stroke-dasharray="0.00001"/>'


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (2 * MOST, 2 * MOST))
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))


def run(command, folder):
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, preexec_fn=limits)
    late = threading.Event()
    timer = threading.Timer(PATIENCE, lambda: (late.set(), process.kill()))
    timer.start()
    said = []
    reader = threading.Thread(target=lambda: said.append(process.stdout.read()))
    reader.start()
    error = process.stderr.read()
    reader.join()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    text = (error + said[0]).decode(errors="replace")
    return process.returncode, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text, late.is_set()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--khatt", required=True)
    parser.add_argument("only", nargs="*")
    args = parser.parse_args()
    khatt, bad = os.path.abspath(args.khatt), 0
    print("| input | status | s | MB | answer |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as top:
        folder = pathlib.Path(top) / "project"
        folder.mkdir()
        (folder / "page.png").write_bytes(letters())
        (folder / "full").mkdir()
        (folder / "full" / "kept.txt").write_text("kept")
        os.mkfifo(folder / "pipe")
        os.symlink("loop.png", folder / "loop.png")
        cases = [("trace", "in.png", c, ["trace", "in.png", "-o", "out.svg"]) for c in pictures()]
        cases += [("build", "project.toml", c, ["build", "--no-cache", "project.toml"]) for c in projects(folder)]
        cases += [("convert", "in.svg", c, ["convert", "in.svg", "-o", "out.otf"]) for c in drawings()]
        for verb, name, (what, content), command in cases:
            if args.only and not any(o in what for o in args.only):
                continue
            (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
            before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
            status, seconds, megabytes, text, late = run([khatt, *command], folder)
            after = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
            lines = [l.strip(" │×╰─▶·╭╮╯") for l in text.splitlines()]
            answer = next((l for l in lines if l), "")[:110].replace(str(top), "").replace("|", "\\|")
            wrong = late or status not in (0, 1, 2) or megabytes > MOST >> 20 or "panicked" in text
            if status and after != before:
                wrong, answer = True, f"left {sorted(p.name for p in after if after[p] != before.get(p))}: {answer}"
            bad += wrong
            mark = " **wrong**" if wrong else ""
            print(f"| {verb}: {what} | {status}{mark} | {seconds:.1f} | {megabytes:.0f} | {answer} |", flush=True)
            for path in after.keys() - before.keys():
                path.unlink()
            for path in before:
                path.write_bytes(before[path])
    print(f"\n{bad} wrong")
    sys.exit(bool(bad))


if __name__ == "__main__":
    main()

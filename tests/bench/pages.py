#!/usr/bin/env python3
"""A font of many pages: built cold with one job and with two, again with nothing changed, again with one page changed, and by pages.

    python3 tests/bench/pages.py --khatt target/release/khatt PROJECT.toml [--pages 24] [--snakemake]

PROJECT.toml names one page, a PNG; the font repeats it under other glyph names and with
another comment, so that no page is another's copy.
With --snakemake (PyPI) the pages are done one by one by its workers and merged; the font must be the same to the byte.
"""
import argparse, hashlib, os, struct, subprocess, sys, tempfile, time, tomllib, zlib

SNAKEFILE = """
rule font:
    input: expand("results/{{n}}", n=range(1, {pages} + 1))
    output: "{merged}"
    shell: "{khatt} merge --quiet font.toml {{input}}"

rule page:
    output: "results/{{n}}"
    threads: 1
    shell: "{khatt} page --quiet --jobs 1 font.toml --sheet {{wildcards.n}} -o {{output}}"
"""


def measure(command, cwd):
    """Seconds and megabytes at most of a command, the largest of its processes."""
    start = time.perf_counter()
    child = subprocess.Popen(command, cwd=cwd, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    stderr = child.stderr.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"{' '.join(command)} failed:\n{stderr[:2000]}")
    return time.perf_counter() - start, usage.ru_maxrss / 1024


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return repr(value) if isinstance(value, (int, float)) else "'''" + value + "'''"


def commented(png, comment):
    """A PNG with a comment after its head: other bytes, the same picture."""
    body = b"tEXtComment\0" + comment.encode()
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    return png[:33] + chunk + png[33:]


def glyph_name(written):
    """The name of a glyph that a project file names or writes as a character."""
    return written if len(written) > 1 else f"uni{ord(written):04X}"


def project(folder, source, pages):
    """The project file, and the pages' pictures."""
    with open(source, "rb") as file:
        table = tomllib.load(file)["sheet"][0]
    with open(os.path.join(os.path.dirname(source), table["image"]), "rb") as file:
        picture = file.read()
    names = table["glyphs"].split()
    text = ['[font]\nfamily = "Pages"\n']
    for n in range(1, pages + 1):
        with open(os.path.join(folder, f"{n}.png"), "wb") as file:
            file.write(commented(picture, str(n)))
        glyphs = " ".join(names if n == 1 else [f"{glyph_name(name)}.p{n}" for name in names])
        sheet = table | {"image": f"{n}.png", "glyphs": glyphs}
        text.append("[[sheet]]\n" + "".join(f"{k} = {toml(v)}\n" for k, v in sheet.items()))
    text.append('[output]\nttf = "font.ttf"\n')
    with open(os.path.join(folder, "font.toml"), "w") as file:
        file.write("".join(text))


def hashing(folder):
    """Seconds that reading and hashing the inputs takes, SHA-256."""
    start = time.perf_counter()
    for name in sorted(os.listdir(folder)):
        if name.endswith((".png", ".toml")):
            with open(os.path.join(folder, name), "rb") as file:
                hashlib.file_digest(file, "sha256")
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project")
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--pages", type=int, default=24)
    parser.add_argument("--snakemake", action="store_true")
    args = parser.parse_args()
    khatt = os.path.abspath(args.khatt)
    with tempfile.TemporaryDirectory() as folder:
        project(folder, args.project, args.pages)
        font = os.path.join(folder, "font.ttf")

        def built():
            with open(font, "rb") as file:
                return hashlib.file_digest(file, "sha256").hexdigest()

        def build(*more):
            return measure([khatt, "build", "--quiet", "font.toml", *more], folder)

        def say(what, figures):
            print(f"{what}: {figures[0]:.2f} s, {figures[1]:.0f} MB", flush=True)

        one, two = build("--no-cache", "--jobs", "1"), build("--no-cache", "--jobs", "2")
        say(f"{args.pages} pages, 1 job", one)
        say(f"{args.pages} pages, 2 jobs", two)
        print(f"speed-up {one[0] / two[0]:.2f}")
        whole = built()
        say("first build with a cache", build("--cache-dir", "kept"))
        assert built() == whole
        again = min(build("--cache-dir", "kept") for _ in range(3))
        say("nothing changed", again)
        print(f"of which hashing the inputs (Python's SHA-256): {hashing(folder):.2f} s")
        page = measure([khatt, "page", "--quiet", "font.toml", "--sheet", "1", "-o", "first"], folder)
        say("one page alone", page)
        with open(os.path.join(folder, f"{args.pages}.png"), "r+b") as file:
            picture = commented(file.read(), "scanned again")
            file.seek(0)
            file.write(picture)
        changed = build("--cache-dir", "kept")
        say("one page changed", changed)
        print(f"one page changed ÷ one page alone {changed[0] / page[0]:.2f}")
        if args.snakemake:
            whole = built()
            os.remove(font)
            with open(os.path.join(folder, "Snakefile"), "w") as file:
                file.write(SNAKEFILE.format(pages=args.pages, merged="font.ttf", khatt=khatt))
            say("snakemake --cores 2", measure(["snakemake", "--cores", "2", "--quiet"], folder))
            assert built() == whole, "merged pages give another font"
            print("merged: the same bytes")


if __name__ == "__main__":
    main()

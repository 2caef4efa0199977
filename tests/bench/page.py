#!/usr/bin/env python3
"""Time and memory from a page to a font, beside potrace on the same page thresholded at its middle level.

    python3 tests/bench/page.py --khatt target/release/khatt PROJECT.toml [--jobs 2] [--runs 3]

The project names one page. Needs potrace and Pillow. Each figure is the best of the runs.
"""
import argparse, os, subprocess, sys, tempfile, time, tomllib
from PIL import Image

Image.MAX_IMAGE_PIXELS = None


def measure(command):
    """Seconds, processor seconds, megabytes at most and messages of a command."""
    start = time.perf_counter()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    stderr = child.stderr.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    if status:
        sys.exit(f"{command[0]} failed:\n{stderr}")
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, stderr


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project")
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--runs", type=int, default=3)
    args = parser.parse_args()
    with open(args.project, "rb") as file:
        page = tomllib.load(file)["sheet"][0]["image"]
    page = os.path.join(os.path.dirname(args.project), page)
    with tempfile.TemporaryDirectory() as folder:
        bitmap, svg = os.path.join(folder, "page.pbm"), os.path.join(folder, "page.svg")
        gray = Image.open(page).convert("L")
        low, high = gray.getextrema()
        gray.point(lambda v: 255 * (v > (low + high) / 2)).convert("1").save(bitmap)
        rows = {
            f"khatt build --jobs {args.jobs}": [args.khatt, "build", args.project, "--no-cache", "--jobs", str(args.jobs)],
            "potrace -s (thresholded before)": ["potrace", "-s", bitmap, "-o", svg],
        }
        print(f"{page}: {gray.width * gray.height / 1e6:.1f} Mpx")
        for name, command in rows.items():
            runs = [measure(command) for _ in range(args.runs)]
            seconds, processor, megabytes, stderr = min(runs)
            print(f"{name}: {seconds:.2f} s, {processor:.2f} s of processor, {megabytes:.0f} MB")
            print("".join(f"    {line}\n" for line in stderr.splitlines() if "glyphs in" in line), end="")


if __name__ == "__main__":
    main()

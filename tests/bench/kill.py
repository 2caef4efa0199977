#!/usr/bin/env python3
"""Kills builds at random moments and looks at what is left: every output must be whole, old or new.

    python3 tests/bench/kill.py --khatt target/release/khatt PROJECT.toml [--times 20]

Works on a copy of the project's folder. The builds alternate between two versions of the font, so that old and
new differ; after each kill every output must be byte for byte one of the two, and after the next whole build no
temporary file may be left.
"""
import argparse, os, pathlib, random, re, shutil, signal, subprocess, sys, tempfile, time


def outputs(folder):
    """Content of every file of the outputs; temporary names apart."""
    found, stray = {}, []
    for path in sorted(folder.rglob("*")):
        if ".khatt-" in str(path):
            stray.append(str(path))
        elif path.is_file():
            found[str(path.relative_to(folder))] = path.read_bytes()
    return found, stray


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("project")
    parser.add_argument("--khatt", required=True)
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    dice = random.Random(args.seed)
    khatt, source = os.path.abspath(args.khatt), pathlib.Path(args.project)
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder) / "project"
        shutil.copytree(source.parent, work)
        text = (work / source.name).read_text().replace('"../build/', '"out/')
        versions = []
        for number in ("1.000", "2.000"):
            (work / f"{number}.toml").write_text(re.sub(r"\[font\]", f'[font]\nversion = "{number}"', text))
            start = time.perf_counter()
            subprocess.run([khatt, "build", "-q", "--no-cache", f"{number}.toml"], cwd=work, check=True)
            versions.append(outputs(work / "out")[0])
            span = time.perf_counter() - start
        bad = 0
        for i in range(args.times):
            # half of the kills fall into the last tenth, where files are written
            moment = span * (dice.random() if i % 2 else 0.9 + 0.15 * dice.random())
            child = subprocess.Popen([khatt, "build", "-q", "--no-cache", f"{1 + i % 2}.000.toml"], cwd=work)
            time.sleep(moment)
            child.send_signal(signal.SIGKILL)
            status = child.wait()
            found, stray = outputs(work / "out")
            mixed = [n for n, b in found.items() if b not in (versions[0].get(n), versions[1].get(n))]
            lost = [n for n in versions[0] if n not in found]
            bad += bool(mixed or lost)
            end = "ended before" if status == 0 else "killed"
            print(f"{i + 1:2} at {moment:.2f} s: {end}, {len(found)} files whole, {len(mixed)} broken, {len(lost)} lost, {len(stray)} temporary")
        subprocess.run([khatt, "build", "-q", "--no-cache", "1.000.toml"], cwd=work, check=True)
        found, stray = outputs(work / "out")
        print(f"after the next build: {'the same bytes' if found == versions[0] else 'OTHER BYTES'}, {len(stray)} temporary")
        sys.exit(bool(bad or stray or found != versions[0]))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Builds fonts from pages in other people's repositories: what khatt says, how many letters, and a font to look at.

    strangers.py --khatt target/release/khatt --clones CLONES --out OUT

CLONES holds each repository as owner/name, as `git clone https://github.com/owner/name owner/name` there makes it.
The fonts, proofs and project files come to OUT; whether each letter is the one that its name says, whole and without
print, a person has to see. Needs nothing but Python.
"""
import argparse, json, os, re, subprocess, time

AB = "a b c d e f g|h i j k l m n o|p q r s t u v|w x y z A B C|D E F G H I|J K L M N O|P Q R S T U V|W X Y Z 1 2 3 4 5|6 7 8 9 0"
MS = "a b c d e f g h i|j k l m n o p q r s|t u v w x y z|A B C D E F G H I|J K L M N O P Q R|S T U V W X Y Z"
EXCLAM = "! \" % & ' (|) + , - . /|: ; = ? @ A B C|D E F G H I J K|L M N O P Q R S|T U V W X Y Z a|b c d e f g h i|j k l m n o p q"
LETTERS = "! \" ' , . :|; ? A B C D|E F G H I J K L|M N O P Q R S T|U V W X Y Z a b|c d e f g h i j|k l m n o p q r|s t u v w x y z"
ROUND = "! \" & ' ( )|+ , - . / 0|1 2 3 4 5 6 7 8|9 : ? A B C D E|F G H I J K L M|N O P Q R S T U|V W X Y Z a b c|d e f g h i j k"
FONT = ("A B C D E F G H I J|K L M N O P Q R S T|U V W X Y Z 0 1 2 3|4 5 6 7 8 9 a b c d|e f g h i j k l m n|o p q r s t u v w x|"
        "y z ! @ # $ % ^ & *|( ) - underscore + = { } bar bracketleft|bracketright backslash : \" ; ' < > ? ,|. /")
ALL = ("_ _ _ _ _ _ _ _ _ _ _ _ _ _|_ _ _ _ _ _ _ _ _ _ _ _|A B C D E F G H I J K L M N O P Q R S|"
       "T U V W X Y Z 0 1 2 3 4 5 6 7 8 9 a b|c d e f g h i j k l m n o p q r s t u v|"
       "w x _ y z ! @ # $ % ^ & _ * ( ) - underscore +|= { } bar bracketleft bracketright backslash : \" ; ' < > ? , . /")
DIGITS = "۰ ۱ ۲ ۳ ۴ ۵ ۶ ۷ ۸ ۹".split()
TEN, FOURTEEN = (lambda c: "_ _ " + f"{c} " * 10 + "_ _"), (lambda c: " ".join([c] * 14))
PERSIAN = ["|".join([*map(TEN, DIGITS[:2]), *map(FOURTEEN, "ابپتثجچحخدذرزژسشص"), *map(TEN, DIGITS[2:4])]),
           "|".join([*map(TEN, DIGITS[4:6]), *map(FOURTEEN, "ضطظعغفقکگلمنوهی" + "۶۷"), *map(TEN, DIGITS[8:])])]
EEZYCADE = "EEzycade/handwriting-font-software/test-images/full-handwriting/"
MANISH = "manishgun/hand-written-font-maker/public/"
# page, layout ("boxes", "free", or the columns of a grid), names of each row
PAGES = [
    (EEZYCADE + "ab-2-photo/PXL_20211022_233908920.jpg", "free", AB),
    (EEZYCADE + "ms-photo/PXL_20211022_233919447.jpg", "free", MS),
    (EEZYCADE + "ms-phone-scan/202110221632490000.jpg", "free", MS),
    (MANISH + "scan.jpg", "boxes", EXCLAM),
    (MANISH + "scan.jpg", 8, EXCLAM),
    (MANISH + "IMG_20260228_020759.jpg.jpeg", "boxes", EXCLAM),
    ("ishawakankar/handwrittenFont/letters.jpeg", "boxes", LETTERS),
    ("ishawakankar/handwrittenFont/letters.jpeg", 8, LETTERS),
    ("TaAils1440p/taails-handwrite-font/Calligraphr-Template_1.jpeg", "boxes", EXCLAM),
    ("TaAils1440p/taails-handwrite-font/Calligraphr-Template_1.jpeg", 8, EXCLAM),
    ("GintarasDev/RoundFont/RoundFont_page_0.png", "boxes", ROUND),
    ("GintarasDev/RoundFont/RoundFont_page_0.png", 8, ROUND),
    ("SettSatyaki98/handwritten-image-from-text-file/font.jpg", "boxes", FONT),
    ("SettSatyaki98/handwritten-image-from-text-file/font.jpg", 10, FONT),
    ("SettSatyaki98/handwritten-image-from-text-file/all.jpg", "free", ALL),
    ("sadafnazari/Persian_handwriting_recognition/assets/dataset_sample1.jpg", 14, PERSIAN[0]),
    ("sadafnazari/Persian_handwriting_recognition/assets/dataset_sample2.jpg", 14, PERSIAN[1]),
    ("jsamaviciusstudent/IS-Lab4/letters.jpg", "free", "|".join(["A B C D E F G H I J K"] * 8)),
]


def project(image, layout, rows, name):
    """A page's project file, as README has it."""
    rows = [row.split() for row in rows.split("|")]
    if isinstance(layout, int):
        rows = [row + ["_"] * (layout - len(row)) for row in rows]
        layout = f"{{ grid = [{len(rows)}, {layout}] }}"
    else:
        layout = json.dumps(layout)
    names = "\n".join(" ".join(row) for row in rows)
    arabic = any("\u0600" <= c < "\u0700" for c in names)
    scale = 'direction = "rtl"\npixels_per_em = 50' if arabic else "cap_height = 700"
    return (f'[font]\nfamily = {json.dumps(name)}\n\n[[sheet]]\nimage = {json.dumps(image)}\nlayout = {layout}\n'
            f"glyphs = '''\n{names}\n'''\n{scale}\n\n[output]\nttf = \"{name}.ttf\"\nproof = \"{name}.html\"\n")


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--khatt", required=True)
    p.add_argument("--clones", required=True)
    p.add_argument("--out", required=True)
    a = p.parse_args()
    os.makedirs(a.out, exist_ok=True)
    print("| page | layout | exit | letters | warnings | cut, s | all, s |\n|---|---|---:|---:|---:|---:|---:|")
    for page, layout, rows in PAGES:
        image = os.path.abspath(os.path.join(a.clones, page))
        if not os.path.exists(image):
            print(f"| {page} | {layout} | no such file |")
            continue
        name = re.sub(r"\W+", "-", f"{page.split('/')[0]}-{page.split('/')[-1].rsplit('.', 1)[0]}-{layout}")
        file = os.path.join(a.out, name + ".toml")
        with open(file, "w") as f:
            f.write(project(image, layout, rows, name))
        begun = time.monotonic()
        done = subprocess.run([a.khatt, "build", file, "--no-cache"], capture_output=True, text=True)
        took = time.monotonic() - begun
        said = done.stdout + done.stderr
        letters, cut = re.search(r"(\d+) glyphs", said), re.search(r"cut ([\d.]+)", said)
        found = [m.group(1) if m else "" for m in (letters, cut)]
        warnings = len(re.findall(r"^warning", said, re.M))
        print(f"| {page} | {layout} | {done.returncode} | {found[0]} | {warnings} | {found[1]} | {took:.1f} |", flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Tries a proof in a real browser: it opens from file:// without network, layers switch, text types, no error.

    python3 tests/bench/proof.py build/KhattArabic.html [--chromium /usr/bin/chromium] [--picture out.png]

Needs playwright (PyPI) and a Chromium.
"""
import argparse, pathlib, sys
from playwright.sync_api import sync_playwright

# Without these a redrawn picture differs in a few edge pixels.
STEADY = ["--no-sandbox", "--disable-gpu", "--disable-partial-raster", "--disable-lcd-text"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("proof")
    parser.add_argument("--chromium", default="/usr/bin/chromium")
    parser.add_argument("--picture")
    args = parser.parse_args()
    failed = []

    def check(what, fine):
        print(("ok    " if fine else "FAIL  ") + what)
        if not fine:
            failed.append(what)

    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=args.chromium, args=STEADY)
        context = browser.new_context(viewport={"width": 1400, "height": 1500}, offline=True)
        page = context.new_page()
        errors, requests = [], []
        page.on("console", lambda m: errors.append(m.text) if m.type == "error" else None)
        page.on("pageerror", lambda e: errors.append(str(e)))
        page.on("request", lambda r: requests.append(r.url))
        page.goto(pathlib.Path(args.proof).resolve().as_uri())
        page.evaluate("document.fonts.ready")
        check("the font loads", page.evaluate("document.fonts.check('20px proofed')"))
        glyphs = page.locator("figure").count()
        check(f"{glyphs} glyphs are shown", glyphs > 0)
        for box in page.locator("[data-layer]").all():
            key = box.get_attribute("data-layer")
            shows = page.locator(f"figure:has(.{key}[d]:not([d=''])), figure:has(.{key} image)")
            check(f"some glyph has something in layer {key}", shows.count() > 0)
            if shows.count() == 0:
                continue
            drawing = shows.first.locator("svg").first
            drawing.scroll_into_view_if_needed()
            drawing.screenshot()  # pictures are decoded when they are first drawn
            state, before = box.is_checked(), drawing.screenshot()
            box.click()
            after = drawing.screenshot()
            check(f"layer {key} changes what is drawn", before != after)
            check(f"body says so for {key}", page.evaluate("k => document.body.classList.contains('no-' + k)", key) == state)
            box.click()
            check(f"layer {key} comes back as it was", drawing.screenshot() == before)
        page.keyboard.press("1")
        check("key 1 switches the scan", page.evaluate("document.body.classList.contains('no-scan')"))
        page.keyboard.press("1")
        page.locator("#order").select_option("worst")
        worst = page.eval_on_selector_all("figure", "all => all.map(f => Number(f.dataset.worst))")
        check("worst first", worst == sorted(worst, reverse=True))
        page.locator("#order").select_option("page")
        typed = page.locator("#typed")
        typed.fill("بسم الله" if "Arabic" in page.title() else "Hamburg")
        text = page.locator("#waterfall span").first.text_content()
        check("the waterfall follows what is typed", text == typed.text_content())
        page.locator("figure").first.locator("svg").click()
        check("a click makes a glyph large", page.locator("figure.large").count() == 1)
        page.emulate_media(color_scheme="dark")
        check("dark", page.evaluate("getComputedStyle(document.body).backgroundColor") != "rgb(255, 255, 255)")
        check("nothing is asked of the network", all(u.startswith(("file:", "data:")) for u in requests))
        check("no error in the console", not errors)
        if args.picture:
            page.emulate_media(color_scheme="light")
            page.locator("figure.large svg").click()
            page.evaluate("scrollTo(0, 0)")
            page.screenshot(path=args.picture)
        browser.close()
    print("\n".join(errors))
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()

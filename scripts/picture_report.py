#!/usr/bin/env python3
"""Picture of a report's page, down to the end of its first damage: the one of the README.

    scripts/demo.sh
    scripts/picture_report.py demo/result/report.html docs/images/report.jpg

Needs Chromium and Debian's python3-selenium and chromium-driver."""
import base64
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests/browser"))
from browser import start_browser

WIDTH = 960  # CSS pixels, so that the table has all its columns
SCALE = 5 / 6


def first_page(browser, page):
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                            {"width": WIDTH, "height": 1000, "deviceScaleFactor": 1, "mobile": False})
    browser.get(page.resolve().as_uri())
    end = browser.execute_script(
        "const second = document.getElementById('damage-2');"
        "return second ? second.getBoundingClientRect().top - 2 : document.documentElement.scrollHeight;")
    clip = {"x": 0, "y": 0, "width": WIDTH, "height": end, "scale": SCALE}
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "jpeg", "quality": 85, "clip": clip,
                                                              "captureBeyondViewport": True})
    return base64.b64decode(shot["data"])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    report, picture = map(pathlib.Path, sys.argv[1:])
    if not report.is_file():
        sys.exit(f"{report}: there is no such file")
    with tempfile.TemporaryDirectory() as profile:
        browser = start_browser(profile)
        try:
            picture.write_bytes(first_page(browser, report))
        finally:
            browser.quit()


if __name__ == "__main__":
    main()

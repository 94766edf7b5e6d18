#!/usr/bin/env python3
"""Watches the page of `roadstereo live` in headless Chromium while a sequence is played back: live_browser.py LIVE_PLAYER.

LIVE_PLAYER is the program that plays it. Exits with 77 (skipped) where Chromium or selenium is missing.
"""
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.parse

sys.dont_write_bytecode = True  # the folder of the sources stays as it is

from browser import start_browser  # before selenium: skips without it
from selenium.webdriver.common.by import By

PLAYER = None
FOLDER = None
PATIENCE_S = 60  # for a machine that does other things, too


class Player:
    """`live` on so many pairs out of memory, and the address of its page."""

    def __init__(self, *arguments):
        calibration = FOLDER / "calibration.yaml"
        self.process = subprocess.Popen(
            [PLAYER, "320", "180", calibration, "live", "1000000", "--calibration", calibration, "--json",
             "--max-age", "5000", *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = None
        for line in self.process.stderr:
            found = re.search(r"http://\S+", line)
            if found:
                self.url = found.group()
                break

    def end(self):
        """Ctrl-C; returns the exit code and the summary."""
        self.process.send_signal(signal.SIGINT)
        out, _ = self.process.communicate(timeout=PATIENCE_S)
        return self.process.returncode, json.loads(out)

    def kill(self):
        self.process.kill()
        self.process.communicate()


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = start_browser(FOLDER / "profile")
        cls.browser.set_page_load_timeout(PATIENCE_S)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def open(self, *arguments):
        player = Player(*arguments)
        self.addCleanup(player.kill)
        self.browser.get("about:blank")  # what came before is not this page's
        for log in ("browser", "performance"):
            self.browser.get_log(log)
        self.browser.get(player.url)
        self.wait_until("live", lambda: self.state() == "live" and self.frame() > 0)
        return player

    def wait_until(self, what, holds):
        end = time.monotonic() + PATIENCE_S
        while not holds():
            self.assertLess(time.monotonic(), end, f"waited for: {what}")
            time.sleep(0.05)

    def state(self):
        return self.browser.execute_script("return document.body.dataset.state")

    def frame(self):
        return int(self.browser.execute_script("return document.body.dataset.frame"))

    def text(self, name):
        return self.browser.find_element(By.ID, name).text

    def errors(self):
        return [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]

    def hosts(self):
        found = set()
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                url = message["params"].get("request", message["params"])["url"]
                found.add(urllib.parse.urlsplit(url).netloc if not url.startswith("data:") else "data")
        return found - {"data"}

    def colours(self, canvas):
        """How many different colours the canvas shows, on a coarse grid."""
        return self.browser.execute_script("""
            const canvas = document.getElementById(arguments[0]), seen = new Set();
            const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
            for (let i = 0; i < data.length; i += 4 * 37) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
            return [canvas.width, canvas.height, seen.size];""", canvas)

    def test_shows_what_is_played(self):
        player = self.open("--serve", "0")
        first = self.frame()
        self.wait_until("newer pictures", lambda: self.frame() > first + 3)
        for canvas in ("left", "transformed"):
            width, height, colours = self.colours(canvas)
            self.assertEqual((width, height), (320, 180))
            self.assertGreater(colours, 20, canvas)
        self.wait_until("damages", lambda: self.browser.find_elements(By.CSS_SELECTOR, "#list tbody tr"))
        # At once: every frame draws the table anew.
        cells = self.browser.execute_script(
            "return [...document.querySelectorAll('#list tbody tr:first-child td')].map(cell => cell.innerText.trim())")
        self.assertRegex(cells[0], r"^\d\d:\d\d:\d\d$")
        self.assertRegex(cells[1], "^(depression|protrusion)")
        self.assertRegex(cells[2], r"^\+?[\d.]+\s*± [\d.]+ mm$")
        self.assertRegex(cells[3], r"^[\d.]+\s*± [\d.]+ cm²$")
        self.assertRegex(self.text("roll"), r"^−?\d+\.\d\d°$")
        self.assertRegex(self.text("height"), r"^\d\.\d\d m$")
        self.assertRegex(self.text("fps"), r"^\d+\.\d$")
        self.assertRegex(self.text("latency"), r"^\d+ ms$")
        self.assertRegex(self.text("age"), r"^\d+(\.\d)? m?s$")
        self.assertEqual(self.text("state"), "Live")
        turned = self.browser.find_element(By.CSS_SELECTOR, "#horizon .line").get_attribute("transform")
        self.assertRegex(turned, r"^rotate\(-?[\d.e-]+ 160 90\)$")
        self.assertEqual(self.errors(), [])
        self.assertEqual(self.hosts(), {urllib.parse.urlsplit(player.url).netloc})

    def test_nothing_sticks_out_of_a_phone(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": 360, "height": 780, "deviceScaleFactor": 2, "mobile": True})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        self.open("--serve", "0", "--record", str(FOLDER / "recording"))
        self.wait_until("damages", lambda: self.browser.find_elements(By.CSS_SELECTOR, "#list tbody tr"))
        self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 360)
        self.assertLessEqual(
            self.browser.execute_script("return document.querySelector('#list .scroll').scrollWidth"), 336)
        self.assertRegex(self.text("recorded"), r"^\d+ pairs$")

    def test_shows_path_of_camera(self):
        player = self.open("--serve", "0", "--trajectory")
        path = "return document.querySelector('#way_map .path').getAttribute('d')"
        self.wait_until("a path", lambda: (self.browser.execute_script(path) or "").count("L") >= 3)
        self.assertRegex(self.text("way_length"), r"^\d+\.\d m$")
        self.assertRegex(self.browser.find_element(By.CSS_SELECTOR, "#way_map .bar text").text, r"^[\d.]+ m$")
        inside = self.browser.execute_script("""
            const map = document.querySelector('#way_map'), box = document.querySelector('#way_map .path').getBBox();
            return box.x >= 0 && box.y >= 0 && box.x + box.width <= 640 && box.y + box.height <= 260;""")
        self.assertTrue(inside)
        self.assertEqual(self.errors(), [])
        _, summary = player.end()
        self.assertGreater(summary["path_m"], 0)

    def test_hides_path_that_nobody_asked_for(self):
        self.open("--serve", "0")
        self.assertFalse(self.browser.find_element(By.ID, "way").is_displayed())

    def test_works_with_a_token(self):
        player = self.open("--serve", "0.0.0.0:0")
        self.assertRegex(player.url, r"\?token=[0-9a-f]{32}$")
        self.assertEqual(self.colours("left")[:2], [320, 180])
        self.assertEqual(self.errors(), [])

    def test_says_when_nothing_comes_any_more(self):
        player = self.open("--serve", "0")
        code, summary = player.end()
        self.assertEqual(code, 0)
        self.assertGreaterEqual(summary["processed"], 1)
        self.wait_until("the end", lambda: self.state() == "ended")
        self.wait_until("dimmed pictures",
                        lambda: "old" in self.browser.find_element(By.TAG_NAME, "body").get_attribute("class"))
        notes = self.browser.find_elements(By.CSS_SELECTOR, ".overdue")
        self.assertEqual(len(notes), 2)
        for note in notes:
            self.assertRegex(note.text, r"^no new image for [\d.]+ s$")

    def test_a_killed_program_is_stale_not_live(self):
        player = self.open("--serve", "0")
        player.kill()
        self.wait_until("stale", lambda: self.state() == "stale")
        self.assertIn("No connection", self.text("message"))

    def test_everything_has_a_name(self):
        self.open("--serve", "0")
        nameless = self.browser.execute_script("""
            return [...document.querySelectorAll("canvas, img, section, [role=region], [role=img]")].filter((part) =>
                !part.getAttribute("aria-label") && part.getAttribute("alt") === null && !part.querySelector("h2"))
                .map((part) => part.outerHTML.slice(0, 80));""")
        self.assertEqual(nameless, [])


def main():
    global PLAYER, FOLDER
    if len(sys.argv) != 2:
        print("usage: live_browser.py LIVE_PLAYER", file=sys.stderr)
        return 2
    PLAYER = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="roadstereo_live_") as folder:
        FOLDER = pathlib.Path(folder)
        outcome = unittest.main(argv=[sys.argv[0]], exit=False, verbosity=2).result
    return 0 if outcome.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())

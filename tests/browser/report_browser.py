#!/usr/bin/env python3
"""Opens reports in headless Chromium, from file://, as a reader would: report_browser.py REPORT_SAMPLES.

REPORT_SAMPLES is the program that writes them. Exits with 77 (skipped) where Chromium or selenium is missing.
"""
import base64
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # the folder of the sources stays as it is

from browser import start_browser  # before selenium: skips without it
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

FOLDER = None


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = start_browser(FOLDER / "profile")
        cls.browser.set_page_load_timeout(60)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def open(self, name):
        for log in ("browser", "performance"):
            self.browser.get_log(log)  # what came before is not this report's
        self.browser.get((FOLDER / name / "report.html").as_uri())
        self.frames(3)

    def frames(self, count):
        """Waits until so many pictures have been drawn."""
        for _ in range(count):
            self.browser.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")

    def errors(self):
        return [entry["message"] for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]

    def requests(self):
        """The addresses that were asked for, beside the file itself and data inside it."""
        urls = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                urls.append(message["params"].get("request", message["params"])["url"])
        return [url for url in urls if not url.startswith("data:") and not url.endswith("/report.html")], urls

    def column(self, title):
        """The heads of the first table and the place of the one with that title."""
        heads = self.browser.find_element(By.CSS_SELECTOR, "table.sortable").find_elements(By.TAG_NAME, "th")
        titles = [head.text.split("\n")[0].strip() for head in heads]
        return heads[titles.index(title)], titles.index(title)

    def cells(self, place):
        rows = self.browser.find_element(By.CSS_SELECTOR, "table.sortable").find_elements(
            By.CSS_SELECTOR, "tbody tr")
        return [row.find_elements(By.TAG_NAME, "td")[place] for row in rows]

    def numbers(self, place):
        return [float(cell.text.split("±")[0]) for cell in self.cells(place)]

    def picture_of(self, canvas):
        return self.browser.execute_script("return arguments[0].toDataURL()", canvas)

    def test_opens_without_errors_and_without_the_network(self):
        for name in ("none", "one", "many", "uncalibrated", "no_image", "flight"):
            with self.subTest(name):
                self.open(name)
                self.assertEqual(self.errors(), [])
                foreign, every = self.requests()
                self.assertEqual(foreign, [])
                self.assertTrue(every, "the log of requests is empty: nothing was checked")
                broken = self.browser.execute_script(
                    "return [...document.images].filter((image) => !image.naturalWidth).length")
                self.assertEqual(broken, 0)

    def test_nothing_sticks_out_sideways(self):
        for width in (1280, 390):
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                         {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
            for name in ("none", "many", "uncalibrated", "flight"):
                with self.subTest(name=name, width=width):
                    self.open(name)
                    wide = self.browser.execute_script("return document.documentElement.scrollWidth")
                    self.assertLessEqual(wide, width)
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def show(self, width, height, media):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": media})

    def show_as_before(self):
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def test_phone_shows_depth_without_scrolling(self):
        self.show(390, 844, "screen")
        self.addCleanup(self.show_as_before)
        for name in ("many", "flight"):
            with self.subTest(name):
                self.open(name)
                head, place = self.column("Depth")
                for part in [head] + self.cells(place):
                    self.assertLessEqual(part.rect["x"] + part.rect["width"], 390)
                self.assertRegex(self.cells(place)[0].text, r"^[\d.]+\s±\s[\d.]+$")
                for number in self.browser.find_elements(By.CSS_SELECTOR, ".road-map text, .map text"):
                    self.assertGreaterEqual(number.rect["height"], 8)

    def test_page_of_a4_loses_nothing(self):
        """186 mm of text: 703 CSS pixels. Nothing is cut off in tables, figures and cards, and signs stay."""
        self.show(703, 1000, "print")
        self.addCleanup(self.show_as_before)
        for name in ("many", "flight"):
            with self.subTest(name):
                self.open(name)
                wide = self.browser.execute_script("""
                    return [...document.querySelectorAll("table, td, dd, .card .value, .card .more, h3, figcaption")]
                      .filter((part) => part.getBoundingClientRect().right > 703.5 ||
                              part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0)
                      .map((part) => part.textContent.trim().slice(0, 60))""")
                self.assertEqual(wide, [])
                pdf = FOLDER / (name + ".pdf")
                pdf.write_bytes(base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {
                    "printBackground": True, "preferCSSPageSize": True})["data"]))
                shown = self.browser.execute_script("return document.querySelector('main').innerText")
                if shutil.which("pdftotext"):
                    printed = subprocess.run(["pdftotext", "-layout", pdf, "-"], check=True, capture_output=True,
                                             text=True).stdout
                    for sign in ("m²", "±", "°" if name == "flight" else "×"):
                        self.assertGreaterEqual(printed.count(sign), shown.count(sign), sign)

    def test_recording_shows_map_and_details(self):
        self.open("flight")
        links = self.browser.find_elements(By.CSS_SELECTOR, ".road-map a")
        self.assertEqual(len(links), 11)
        for link in links:
            target = self.browser.execute_script("return arguments[0].href.baseVal", link)
            self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "section" + target)), 1, target)
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, ".relief canvas")), 11)
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#segments tbody tr")), 4)
        self.assertEqual(len(self.browser.find_elements(By.CSS_SELECTOR, "#candidates tbody tr")), 1)
        first = self.browser.find_element(By.ID, "summary").text
        for word in ("disparity", "Mde/s", "a1", "px"):
            self.assertNotIn(word, first)

    def test_title_is_text(self):
        self.open("one")
        self.assertEqual(self.browser.find_element(By.TAG_NAME, "h1").text, 'one <sample> & "quotes"')

    def test_heads_sort_both_ways(self):
        self.open("many")
        head, place = self.column("Area")
        self.assertEqual(len(self.cells(place)), 12)
        self.assertEqual(head.get_attribute("aria-sort"), "none")
        head.find_element(By.TAG_NAME, "button").click()
        ascending = self.numbers(place)
        self.assertEqual(head.get_attribute("aria-sort"), "ascending")
        self.assertEqual(ascending, sorted(ascending))
        self.assertLess(ascending[0], ascending[-1])
        head.find_element(By.TAG_NAME, "button").click()
        self.assertEqual(head.get_attribute("aria-sort"), "descending")
        self.assertEqual(self.numbers(place), ascending[::-1])

    def test_keyboard_sorts_words(self):
        self.open("many")
        head, place = self.column("Distress")
        head.find_element(By.TAG_NAME, "button").send_keys(Keys.ENTER)
        words = [cell.text for cell in self.cells(place)]
        self.assertEqual(words, ["bump"] * 2 + ["crack"] + ["pothole"] * 9)
        head.find_element(By.TAG_NAME, "button").send_keys(Keys.SPACE)
        self.assertEqual([cell.text for cell in self.cells(place)], words[::-1])
        others = [other.get_attribute("aria-sort")
                  for other in self.browser.find_elements(By.CSS_SELECTOR, "table.sortable th") if other != head]
        self.assertEqual(set(others), {"none"})

    def canvas(self, name):
        self.open(name)
        canvas = self.browser.find_element(By.CSS_SELECTOR, ".relief canvas")
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center', behavior: 'instant'})", canvas)
        self.frames(2)
        return canvas

    def test_arrow_keys_turn_the_view(self):
        canvas = self.canvas("one")
        start = seen = self.picture_of(canvas)
        for key in (Keys.ARROW_LEFT, Keys.ARROW_UP, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_DOWN):
            canvas.send_keys(key)
            self.frames(2)
            turned = self.picture_of(canvas)
            self.assertNotEqual(turned, seen)
            seen = turned
        canvas.send_keys(Keys.HOME)
        self.frames(2)
        self.assertEqual(self.picture_of(canvas), start)

    def test_dragging_turns_the_view(self):
        canvas = self.canvas("one")
        start = self.picture_of(canvas)
        ActionChains(self.browser).click_and_hold(canvas).move_by_offset(60, 25).release().perform()
        self.frames(2)
        turned = self.picture_of(canvas)
        self.assertNotEqual(turned, start)
        ActionChains(self.browser).move_by_offset(20, 0).perform()  # let go: the view stays
        self.frames(2)
        self.assertEqual(self.picture_of(canvas), turned)

    def test_a_finger_turns_the_view(self):
        canvas = self.canvas("uncalibrated")
        start = self.picture_of(canvas)
        box = self.browser.execute_script(
            "const r = arguments[0].getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]", canvas)

        def touch(kind, points):
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        touch("touchStart", [{"x": box[0], "y": box[1]}])
        for step in range(1, 9):
            touch("touchMove", [{"x": box[0] + 10 * step, "y": box[1]}])
        touch("touchEnd", [])
        self.frames(2)
        self.assertNotEqual(self.picture_of(canvas), start)

    def test_slider_exaggerates(self):
        canvas = self.canvas("one")
        start = self.picture_of(canvas)
        slider = self.browser.find_element(By.CSS_SELECTOR, ".relief input")
        before = float(slider.get_attribute("value"))
        slider.send_keys(Keys.ARROW_RIGHT)
        self.frames(2)
        self.assertEqual(float(slider.get_attribute("value")), before + 0.5)
        shown = self.browser.find_element(By.CSS_SELECTOR, ".relief output").text
        self.assertEqual(float(shown.split()[0]), before + 0.5)
        self.assertNotEqual(self.picture_of(canvas), start)

    def test_view_shows_the_pothole_in_red(self):
        canvas = self.canvas("one")
        red = self.browser.execute_script("""
            const c = arguments[0], p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
            let red = 0;
            for (let i = 0; i < p.length; i += 4) red += p[i] > 60 && p[i] > 2 * p[i + 1] && p[i] > 2 * p[i + 2];
            return red / (p.length / 4);""", canvas)
        self.assertGreater(red, 0.02)

    def test_no_damage_has_no_table(self):
        self.open("none")
        self.assertEqual(self.browser.find_elements(By.TAG_NAME, "table"), [])
        self.assertEqual(self.browser.find_elements(By.CSS_SELECTOR, ".damage"), [])
        self.assertIn("no damage", self.browser.find_element(By.TAG_NAME, "main").text.lower())

    def test_uncalibrated_says_why_and_has_no_metres(self):
        self.open("uncalibrated")
        text = self.browser.find_element(By.TAG_NAME, "main").text
        self.assertIn("no calibration was given", text)
        for part in self.browser.find_elements(By.CSS_SELECTOR, ".damage, table.sortable, .cards"):
            self.assertNotIn(" mm", part.text.replace("\u00a0", " "))
            self.assertNotIn("m²", part.text)

    def test_prints(self):
        self.open("many")
        pdf = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {
            "printBackground": True, "preferCSSPageSize": True})["data"])
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreater(len(pdf), 100000)
        self.assertEqual(self.errors(), [])


def main():
    global FOLDER
    if len(sys.argv) != 2:
        print("usage: report_browser.py REPORT_SAMPLES", file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory(prefix="roadstereo_report_") as folder:
        FOLDER = pathlib.Path(folder)
        subprocess.run([sys.argv[1], folder], check=True, timeout=200)
        outcome = unittest.main(argv=[sys.argv[0]], exit=False, verbosity=2).result
    return 0 if outcome.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())

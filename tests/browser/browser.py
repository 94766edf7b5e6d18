"""Headless Chromium for the tests of pages: a test is skipped, loudly and with 77, where it is missing."""
import shutil
import sys

SKIPPED = 77


def skip(reason):
    print(f"SKIPPED: nothing was opened in a browser: {reason}", file=sys.stderr)
    sys.exit(SKIPPED)


try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
except ImportError as error:
    skip(f"{error} (Debian's python3-selenium)")

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
DRIVER = shutil.which("chromedriver")
if CHROMIUM is None or DRIVER is None:
    skip("chromium or chromedriver is not installed (Debian's chromium and chromium-driver)")


def start_browser(profile):
    """A browser with a profile of its own, whose console and requests are logged."""
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--disable-background-networking", "--no-first-run", "--window-size=1280,1000",
                     f"--user-data-dir={profile}"):
        options.add_argument(argument)
    options.binary_location = CHROMIUM
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)

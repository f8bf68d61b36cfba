"""Headless Chromium for the tests of the page."""

import atexit
import json
import os
import pathlib
import shutil
import statistics
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "system"))
from programs import BIN, demand, skip  # noqa: E402

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select
except ImportError:
    skip("python3-selenium is missing")

SCREENSHOTS = BIN.parent / "screenshots"
LAPTOP = (1366, 768)
PHONE = (360, 740)

# Returns the number of inked rows in each column of a chart.  Only the curves are blue.
INK = """
const canvases = document.querySelectorAll(`#chart-${arguments[0]} canvas`);
const ink = [];
for (const canvas of canvases) {
    const { width, height } = canvas;
    const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const bytes = copy.getImageData(0, 0, width, height).data;
    for (let column = 0; column < width; ++column) {
        for (let row = 0; row < height; ++row) {
            const at = 4 * (row * width + column);
            if (bytes[at + 3] > 60 && bytes[at + 2] > bytes[at] + 60) ink[column] = (ink[column] ?? 0) + 1;
        }
    }
    ink.length = Math.max(ink.length, width);
}
return Array.from(ink, (rows) => rows ?? 0);
"""

# Returns [text, ratio] of visible texts with less contrast than required (WCAG 2.1, relative luminance).
FAINT = """
const luminance = (colour) => {
    const [r, g, b] = colour.match(/[0-9.]+/g).map(Number)
        .map((v) => v / 255).map((v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
};
const background = (element) => {
    for (let e = element; e; e = e.parentElement) {
        const colour = getComputedStyle(e).backgroundColor;
        if (!/^rgba.*, 0\\)$/.test(colour)) return colour;
    }
    return "rgb(255, 255, 255)";
};
const faint = [];
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || !element.checkVisibility() || element.closest("noscript,svg")) continue;
    const [a, b] = [luminance(getComputedStyle(element).color), luminance(background(element))].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < arguments[0]) faint.push([walker.currentNode.data.trim().slice(0, 40), ratio]);
}
return faint;
"""

# Returns [name, width, height] of controls that are smaller than required.
SMALL = """
const small = [];
for (const element of document.querySelectorAll("button, select, input:not([type=radio]), fieldset label")) {
    const { width, height } = element.getBoundingClientRect();
    if (element.checkVisibility() && (width < arguments[0] || height < arguments[0])) {
        small.push([element.id || element.textContent, width, height]);
    }
}
return small;
"""


class Browser:
    """Browser for a `with` block.  The end of the block demands a clean console and no requests outside loopback.

    The next block of the process uses the same Chromium, because its start takes four seconds.
    """

    idle = {}  # The Chromiums of ended blocks, by their rules.

    def __init__(self, allowed_errors=(), may_ask=(), rules="MAP * ~NOTFOUND, EXCLUDE 127.0.0.1", language="en"):
        """@param allowed_errors  parts of console messages that the test provokes
        @param may_ask  hosts besides 127.0.0.1 that the test itself opens
        @param rules  Chromium's rules for resolving names; default: none but loopback
        @param language  language that the browser asks for
        """
        self.allowed_errors, self.may_ask = allowed_errors, {"127.0.0.1", *may_ask}
        self.rules = rules
        self.driver = self.idle.pop(rules, None) or self.start(rules)
        self.set_language(language)
        self.set_zone("UTC")
        self.seen = []  # Console messages so far.
        SCREENSHOTS.mkdir(exist_ok=True)
        self.resize(LAPTOP)

    @staticmethod
    def start(rules):
        chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
        if not chromium or not driver:
            skip("chromium or chromium-driver is missing")
        options = webdriver.ChromeOptions()
        options.binary_location = chromium
        for argument in ("--headless=new", "--disable-gpu", "--hide-scrollbars", "--force-color-profile=srgb",
                         "--disable-background-networking", f"--host-resolver-rules={rules}"):
            options.add_argument(argument)
        if os.geteuid() == 0:
            options.add_argument("--disable-dev-shm-usage")  # In containers /dev/shm has only 64 MB.
            options.add_argument("--no-sandbox")  # Chromium does not start as root with its sandbox.
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        started = webdriver.Chrome(service=Service(driver), options=options)
        atexit.register(started.quit)
        return started

    def __enter__(self):
        return self

    def __exit__(self, kind, value, trace):
        if kind is None:
            self.demand_quiet()
            self.driver.get("about:blank")
            self.idle[self.rules] = self.driver
        elif kind is not SystemExit or value.code != 0:
            self.shot("failed")
            print("console:", self.console())

    def demand_quiet(self):
        hosts = self.hosts_asked()
        demand(f"no request went to other hosts: {hosts}", hosts <= self.may_ask)
        unexpected = [message for message in self.console() if not any(part in message for part in self.allowed_errors)]
        demand(f"the console has no unexpected messages: {unexpected[:3]}", not unexpected)

    def console(self):
        self.seen += [entry["message"] for entry in self.driver.get_log("browser")]
        return self.seen

    def hosts_asked(self):
        hosts = set()
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                url = message["params"]["request"]["url"]
            elif message["method"] == "Network.webSocketCreated":
                url = message["params"]["url"]
            else:
                continue
            if not url.startswith("data:"):  # Chromium's own arrow of a list.
                hosts.add(urllib.parse.urlsplit(url).hostname or url[:60])
        return hosts

    def resize(self, size):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size == PHONE})

    def set_language(self, language):
        agent = self.run("return navigator.userAgent")
        self.driver.execute_cdp_cmd("Emulation.setUserAgentOverride", {"userAgent": agent, "acceptLanguage": language})

    def set_zone(self, name):
        self.driver.execute_cdp_cmd("Emulation.setTimezoneOverride", {"timezoneId": name})

    def open(self, port):
        self.driver.get(f"http://127.0.0.1:{port}/")

    def open_details(self, is_open=True, identifier="details"):
        self.run("document.getElementById(arguments[1]).open = arguments[0]", is_open, identifier)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def find(self, css):
        return self.driver.find_element(By.CSS_SELECTOR, css)

    def text(self, identifier):
        """Returns the visible text of an element; empty while it is hidden."""
        return self.run("const e = document.getElementById(arguments[0]);"
                        "return e.checkVisibility() ? e.innerText : '';", identifier)

    def click(self, css):
        element = self.find(css)
        self.run("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def choose(self, identifier, value):
        Select(self.find(f"#{identifier}")).select_by_value(value)

    def press(self, *keys):
        webdriver.ActionChains(self.driver).send_keys(*keys).perform()

    def press_with_shift(self, *keys):
        webdriver.ActionChains(self.driver).key_down(Keys.SHIFT).send_keys(*keys).key_up(Keys.SHIFT).perform()

    def wait_for(self, claim, is_true, seconds=5.0):
        """Waits until `is_true` holds and returns the time it took in s."""
        begin = time.monotonic()
        while True:
            if is_true():
                took = time.monotonic() - begin
                print(f"holds: {claim} (after {took:.2f} s)")
                return took
            if time.monotonic() > begin + seconds:
                demand(f"{claim} within {seconds} s", False)
            time.sleep(0.05)

    def wait_for_text(self, identifier, part, seconds=5.0):
        return self.wait_for(f"#{identifier} says {part!r}", lambda: part in self.text(identifier), seconds)

    def shot(self, name, is_whole=False):
        """Saves a picture of the window or of the whole page under screenshots/, for inspection by eye."""
        if not is_whole:
            self.driver.save_screenshot(str(SCREENSHOTS / f"{name}.png"))
            return
        width = self.run("return innerWidth")
        height = self.run("return document.documentElement.scrollHeight")
        size = (width, self.run("return innerHeight"))
        self.resize((width, height))
        time.sleep(0.7)  # Time to draw charts that were out of view.
        self.driver.save_screenshot(str(SCREENSHOTS / f"{name}.png"))
        self.resize(size)

    def ink(self, chart):
        """Returns for each column of the chart whether it has ink."""
        return [rows > 0 for rows in self.run(INK, chart)]

    def ink_height(self, chart):
        """Returns the median number of inked rows in px, over the columns with ink."""
        return statistics.median(rows for rows in self.run(INK, chart) if rows)

    def demand_readable(self, name, target_px=44):
        """Demands sufficient contrast, control sizes and page width in the present state."""
        faint = self.run(FAINT, 7.0)
        demand(f"{name}: every text has a contrast of at least 7:1 {faint[:3] if faint else ''}", not faint)
        small = self.run(SMALL, target_px)
        demand(f"{name}: every control is at least {target_px} px wide and high {small[:3] if small else ''}", not small)
        wide = self.run("return document.documentElement.scrollWidth - innerWidth")
        demand(f"{name}: the page is not wider than the window ({wide} px)", wide <= 0)

    def is_above_fold(self, identifier):
        return self.run("const r = document.getElementById(arguments[0]).getBoundingClientRect();"
                        "return r.width > 0 && r.top >= 0 && r.bottom <= innerHeight;", identifier)


def widest_blank(ink):
    """Returns first column and width of the widest gap without ink between the first and the last inked column."""
    drawn = [column for column, is_inked in enumerate(ink) if is_inked]
    before, after = max(zip(drawn, drawn[1:]), key=lambda pair: pair[1] - pair[0], default=(0, 1))
    return before + 1, after - before - 1

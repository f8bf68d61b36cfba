"""Draws the pictures of README.md and the field guide again, from made-up readings at a fixed time and from a simulated day.

usage: A351_BIN=build/release/bin /usr/bin/python3 tests/page/pictures.py
The same Chromium and fonts give the same bytes.
"""

import base64
import random
import time

NOW = 1772338210.0  # 2026-03-01T04:10:10Z

time.time = lambda: NOW  # For the made-up states and the stub daemon, which are imported after it.
random.seed(1)

from browser import LAPTOP, Browser  # noqa: E402
from made_up import SIGNALS, finding, finished, gravity, occupation, reading, signal, sites, stay, survey, tilt  # noqa: E402
from programs import BIN, TOP, Scratch, demand, run  # noqa: E402
from stub_daemon import StubDaemon  # noqa: E402

MOST_BYTES = 120_000
QUALITY = 85  # Of WebP.
TABLET = (800, 480)

STAYS = 7
GRAVITY_MGAL = [979861.32 - 6.37 * i - 0.41 * (i % 3) for i in range(STAYS)]
DIFFERENCES_MGAL = {0: 0.42, 3: -1.16, 5: 12.1}  # Of the known benchmarks.


def key_of(i):
    return f"20260301T00{i:02}00Z"


def shoot(browser, file, selector=None):
    """Writes a picture of the window, or of an element."""
    clip = {}
    if selector:
        box = browser.run("const b = document.querySelector(arguments[0]).getBoundingClientRect();"
                          "return [b.x + scrollX, b.y + scrollY, b.width, b.height];", selector)
        clip = {"captureBeyondViewport": True, "clip": dict(zip(("x", "y", "width", "height", "scale"), [*box, 1]))}
    shot = browser.driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "webp", "quality": QUALITY, **clip})
    data = base64.b64decode(shot["data"])
    demand(f"{file} has {len(data) / 1e3:.0f} kB, at most {MOST_BYTES / 1e3:.0f}", len(data) <= MOST_BYTES)
    (TOP / file).write_bytes(data)


def made_up_day():
    stub = StubDaemon()
    stub.sites = sites()
    stub.occupations = [{**finished(f"No.{i}", hours_ago=4 - 0.5 * i), "key": key_of(i)} for i in range(STAYS)]
    stub.status["signal"] = signal("go", [["{}: the reading is complete. Press Stop, then go.", ["No.7"]]])
    stub.status["occupation"] = occupation("No.7", key="20260301T040000Z", set_up_count=2, gravity=gravity(), whole=reading(set_ups=2))
    stays = [stay(f"No.{i}", gravity_mgal=gravity_mgal, difference_mgal=DIFFERENCES_MGAL.get(i), key=key_of(i)) for i, gravity_mgal in enumerate(GRAVITY_MGAL)]
    running = stay("No.7", gravity_mgal=979809.87, is_running=True, set_ups=2, key="20260301T040000Z")
    stub.survey = survey([*stays, running], [finding("No.5 (1) reads like No.3: it is 12.1 mGal too high for No.5", True, key_of(5))],
                         as_of_utc="2026-03-01T04:10:02.000Z", data_to_utc="2026-03-01T04:10:01.500Z")
    return stub


def draw_page(browser):
    stub = made_up_day()
    time.sleep(1.0)
    browser.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": f"performance.now = () => 0; Date.now = () => {1000 * NOW};"})
    browser.open(stub.port)
    browser.wait_for_text("run-value", "979809.9")
    stub.status["signal"] = {**stub.status["signal"], "look": {}}  # A further status, because time stands still.
    browser.wait_for_text("day-rows", "979809.9")
    time.sleep(1.0)
    shoot(browser, "daemon/page/page.webp")
    browser.click(f"#day-rows [data-key='{key_of(5)}']")
    shoot(browser, "daemon/page/gravity.webp", "#day")
    browser.resize(TABLET)
    stub.status["signal"], stub.status["tilt"] = signal("lift", [[SIGNALS["lift"][1][0], ["No.7"], ["1"], ["2"]]]), tilt(0.4, -0.3)
    browser.wait_for_text("level-word", "within")
    time.sleep(1.0)
    shoot(browser, "daemon/page/field.webp")
    browser.resize(LAPTOP)


def draw_report(browser, scratch):
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", "day", cwd=scratch)
    run(BIN / "a351-correct", "survey", "day/survey.toml", "--out", "result", cwd=scratch)
    browser.driver.get(f"file://{scratch}/result/report.html")
    time.sleep(1.0)
    shoot(browser, "corrector/report/report.webp")


with Scratch() as folder, Browser(may_ask={None, ""}) as page:
    draw_page(page)
    page.driver.get_log("performance")
    draw_report(page, folder)
    page.driver.get_log("performance")  # The files of the report are no hosts.

"""A whole day on the page: every stay and every check visible, times in the operator's zone with UTC, stays and labels in the charts of hours."""

import time

from browser import LAPTOP, Browser
from made_up import finished, occupation, sites, tilt, verdict
from programs import demand
from stub_daemon import StubDaemon, check

STAYS = 19  # As many as the published survey day has readings.

# Returns the rows that are wholly visible in the table and in the window.
VISIBLE_ROWS = """
const table = document.getElementById("day-table").getBoundingClientRect();
return Array.from(document.querySelectorAll("#day-rows tr")).filter((row) => {
    const { top, bottom } = row.getBoundingClientRect();
    return top >= table.top && bottom <= Math.min(table.bottom + 1, innerHeight);
}).length;
"""

# Returns the numbers of labels of the horizontal and the vertical axis of a chart.
LABELS = """
const count = (axis) => document.querySelectorAll(`#chart-${arguments[0]} .dygraph-axis-label-${axis}`).length;
return [count("x"), count("y")];
"""

# Returns the share of the columns of a chart whose background is that of a stay.
SHADED = """
const canvas = document.querySelector(`#chart-${arguments[0]} canvas`);
const { width, height } = canvas;
const bytes = canvas.getContext("2d").getImageData(0, 0, width, height).data;
const shaded = new Set();
for (let at = 0; at < bytes.length; at += 4) {
    if (bytes[at + 3] > 200 && bytes[at] > bytes[at + 2] + 15) shaded.add((at / 4) % width);
}
return shaded.size / width;
"""


def day_of_stays():
    return [{**finished(f"No.{i}", hours_ago=10 - 0.5 * i, note="windy beside the road" if i % 3 else ""), "key": f"20260301T{i:02}0000Z"}
            for i in range(STAYS)]


def show_list(stub, browser):
    browser.wait_for("all stays are listed", lambda: len(browser.text("day-rows").splitlines()) == STAYS)
    browser.run("scrollTo(0, 0)")
    for zone in ("Asia/Tokyo", "UTC"):
        browser.set_zone(zone)
        browser.driver.refresh()
        browser.wait_for("all stays are listed", lambda: len(browser.text("day-rows").splitlines()) == STAYS)
        shown = browser.run(VISIBLE_ROWS)
        demand(f"{zone}: {shown} of {STAYS} stays are visible at {LAPTOP[0]} x {LAPTOP[1]} without scrolling", shown == STAYS)
        browser.demand_readable(f"the day in {zone}")
        browser.shot(f"day-{zone.split('/')[-1]}-1366")
    browser.click("#day-rows tr:nth-child(4)")
    demand("a row that is pressed is chosen for a change", browser.run("return document.getElementById('day-stay').value") == "20260301T150000Z")
    stub.occupations = stub.occupations + [{**finished("No.0", 2, hours_ago=0.2), "key": "20260301T200000Z"}]
    browser.wait_for("a further stay is listed", lambda: len(browser.text("day-rows").splitlines()) == STAYS + 1)
    demand("the chosen stay is still chosen", browser.run("return document.getElementById('day-stay').value") == "20260301T150000Z")


def show_checks(stub, browser):
    for count in (6, 9, 12):
        checks = [check(f"quantity {i} that is shown in the list of checks", 0.31, "degC/h", 0.25, i > 2) for i in range(count)]
        stub.status["verdict"] = {**verdict("settling"), "checks": checks}
        browser.wait_for(f"{count} checks are listed", lambda: len(browser.text("verdict-checks").splitlines()) == count)
        for width in (1366, 400):
            browser.resize((width, 768))
            hidden = browser.run("const e = document.getElementById('verdict-checks'); return [e, ...e.children]"
                                 ".map((one) => one.scrollHeight - one.clientHeight).reduce((a, b) => Math.max(a, b));")
            demand(f"{count} checks at {width} px: {hidden} px are cut, must be 0", hidden <= 0)
    browser.resize(LAPTOP)


def show_zone(stub, browser):
    stub.status["occupation"] = {**occupation(), "start": "2026-03-01T12:00:05.000Z"}
    stub.status["tilt"] = {**tilt(0.4, 0.3), "reference": {"site": "No.0", "utc": "2026-03-01T20:10:00.000Z"}}
    for zone, since, reference, name in (("Asia/Tokyo", "21:00:05 (12:00:05 UTC)", "05:10:00 (20:10:00 UTC)", "UTC+9"),
                                         ("America/St_Johns", "08:30:05 (12:00:05 UTC)", "16:40:00 (20:10:00 UTC)", "UTC−3:30"),
                                         ("UTC", "12:00:05 UTC", "20:10:00 UTC", "UTC")):
        browser.set_zone(zone)
        browser.driver.refresh()
        browser.wait_for_text("run-stay", f"since {since}")
        demand(f"{zone}: the level's reference is from {reference}", browser.text("level-reference").endswith(reference))
        demand(f"{zone}: the charts name their zone", browser.text("signal-zone").startswith("UTC"))
        demand(f"{zone}: the clock has both times once", browser.text("clock").count("UTC") == 1)
    browser.set_zone("Asia/Tokyo")
    stub.status["occupation"] = {**occupation(), "start": "2026-03-01T15:30:00.000Z"}  # After midnight in Tokyo.
    browser.driver.refresh()
    browser.wait_for_text("run-stay", "since 00:30:00 (15:30:00 UTC)")
    for text, instant in (("23:50:00", "2026-03-01T14:50:00.000Z"), ("0:20", "2026-03-01T15:20:00.000Z"), ("15:40Z", "2026-03-01T15:40:00.000Z")):
        browser.click("#run-times")
        demand("the dialog has the local time", browser.run("return document.getElementById('times-from').value") == "00:30:00")
        browser.run("document.getElementById('times-from').value = arguments[0]", text)
        browser.click("#times-form [type=submit]")
        browser.wait_for(f"{text} is sent as {instant}", lambda: stub.posts and stub.posts[-1][1].get("from") == instant)
        browser.wait_for("the dialog is closed", lambda: browser.text("times-text") == "")
    browser.set_zone("UTC")
    stub.status["occupation"] = None
    browser.driver.refresh()


def show_charts(stub, browser):
    browser.resize((1366, 1600))
    stub.status["occupation"] = occupation()
    for span, expected in ((86400, (STAYS * 11 + 6.7) / 1440), (3600, (11 + 6.7) / 60)):
        stub.occupations = day_of_stays()[:-1] + [{**finished("No.18", hours_ago=0.5), "key": "20260301T180000Z"}]
        for group in ("signal", "warmth"):
            browser.click(f"#{group}-span input[value='{span}']")
        for chart in ("x", "y", "z", "temperature", "oven"):
            browser.wait_for_text(f"caption-{chart}", " to " if chart != "oven" else "set point", seconds=8)
            browser.wait_for(f"{chart}: the chart of {span // 3600} h has more than one label per axis",
                             lambda: min(browser.run(LABELS, chart)) > 1)
            if chart == "oven":  # Its set point has a similar colour.
                continue
            part = browser.run(SHADED, chart)
            axis = 1 - 70 / browser.run("return document.getElementById(`chart-${arguments[0]}`).clientWidth", chart)
            demand(f"{chart}: {100 * part:.1f} % of the chart of {span // 3600} h are shaded as stays, expected {100 * expected * axis:.1f}",
                   abs(part / (expected * axis) - 1) < 0.15)
        browser.shot(f"charts-{span // 3600}h-1366")


with Browser() as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    daemon.occupations = day_of_stays()
    daemon.status["verdict"] = verdict("stable")
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    show_list(daemon, page)
    show_checks(daemon, page)
    show_zone(daemon, page)
    show_charts(daemon, page)

"""A whole day on the page: every stay visible, times in the operator's zone with UTC, stays and labels in the charts of hours."""

import time

from browser import LAPTOP, Browser
from made_up import finished, occupation, signal, sites, tilt
from programs import demand
from stub_daemon import StubDaemon

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
    for zone in ("Asia/Tokyo", "UTC"):
        browser.set_zone(zone)
        browser.driver.refresh()
        browser.wait_for("all stays are listed", lambda: len(browser.text("day-rows").splitlines()) == STAYS)
        shown = browser.run(VISIBLE_ROWS)
        demand(f"{zone}: {shown} of {STAYS} stays are visible at {LAPTOP[0]} x {LAPTOP[1]} without scrolling", shown == STAYS)
        demand(f"{zone}: the zone is said once", browser.text("day-table").count("UTC") == 1)
        browser.demand_readable(f"the day in {zone}")
        browser.shot(f"day-{zone.split('/')[-1]}-1366")
    fourth = "#day-rows tr:nth-child(4)"
    browser.click(fourth)
    browser.wait_for("its remarks unfold", lambda: len(browser.text("day-rows").splitlines()) == STAYS + 1)
    focused = browser.run("const row = document.querySelector(arguments[0]); row.focus(); return row.dataset.key", fourth)
    stub.occupations = stub.occupations + [{**finished("No.0", 2, hours_ago=0.2), "key": "20260301T200000Z"}]
    browser.wait_for("a further stay is listed", lambda: len(browser.text("day-rows").splitlines()) == STAYS + 2)
    demand("the same row is unfolded and has the focus", browser.run("return document.activeElement.dataset.key") == focused
           and browser.run("return document.querySelector('[aria-expanded=true]').dataset.key") == focused)


def show_zone(stub, browser):
    stub.status["occupation"] = {**occupation(), "start": "2026-03-01T12:00:05.000Z"}
    stub.status["signal"] = signal("look")
    stub.status["tilt"] = {**tilt(0.4, 0.3), "reference": {"site": "No.0", "utc": "2026-03-01T20:10:00.000Z"}}
    for zone, since, reference, moved in (("Asia/Tokyo", "21:00:05 (12:00:05 UTC)", "05:10:00 (20:10:00 UTC)", "10:43:20 (01:43:20 UTC)"),
                                          ("America/St_Johns", "08:30:05 (12:00:05 UTC)", "16:40:00 (20:10:00 UTC)", "22:13:20 (01:43:20 UTC)"),
                                          ("UTC", "12:00:05 UTC", "20:10:00 UTC", "01:43:20 UTC")):
        browser.set_zone(zone)
        browser.driver.refresh()
        browser.wait_for_text("run-stay", f"since {since}")
        demand(f"{zone}: the sentence has the time {moved}", moved in browser.text("signal-sentence"))
        demand(f"{zone}: the level's reference is from {reference}", browser.text("level-reference").endswith(reference))
        browser.open_details()
        demand(f"{zone}: the charts name their zone", browser.text("trace-zone").startswith("UTC"))
        demand(f"{zone}: the clock has both times once", browser.text("clock").count("UTC") == 1)
    browser.set_zone("Asia/Tokyo")
    running = {**occupation(), "start": "2026-03-01T15:30:00.000Z"}  # After midnight in Tokyo.
    stub.status["occupation"] = running
    browser.driver.refresh()
    browser.wait_for_text("run-stay", "since 00:30:00 (15:30:00 UTC)")
    browser.click(f"#day-rows [data-key='{running['key']}']")
    for text, instant in (("23:50:00", "2026-03-01T14:50:00.000Z"), ("0:20", "2026-03-01T15:20:00.000Z"), ("15:40Z", "2026-03-01T15:40:00.000Z")):
        browser.click("#day-times")
        browser.wait_for("the dialog has the local time",
                         lambda: browser.run("return document.getElementById('times-from').value") == "00:30:00")
        browser.run("document.getElementById('times-from').value = arguments[0]", text)
        browser.click("#times-form [type=submit]")
        browser.wait_for(f"{text} is sent as {instant}", lambda: stub.posts and stub.posts[-1][1].get("from") == instant)
        browser.wait_for("the dialog is closed", lambda: browser.text("times-text") == "")
    browser.set_zone("UTC")
    stub.status["occupation"] = stub.status["tilt"] = None
    browser.driver.refresh()


def show_charts(stub, browser):
    browser.resize((1366, 1600))
    browser.open_details()
    stub.status["occupation"] = occupation()
    for span, expected in ((86400, (STAYS * 11 + 6.7) / 1440), (3600, (11 + 6.7) / 60)):
        stub.occupations = day_of_stays()[:-1] + [{**finished("No.18", hours_ago=0.5), "key": "20260301T180000Z"}]
        for group in ("trace", "warmth"):
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
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    show_list(daemon, page)
    show_zone(daemon, page)
    show_charts(daemon, page)

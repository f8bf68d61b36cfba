"""Old data must not look fresh: data that stop, a daemon that stops and starts again, gaps in the charts.

The page itself must not need more memory or time as it runs.
"""

import time

from browser import Browser, widest_blank
from made_up import occupation, signal, sites
from programs import IS_LONG, demand
from stub_daemon import RATE_HZ, StubDaemon

GAP_S = 4.0
MINUTE_S = 60.0
MOST_GROWTH_MB = 3  # Twice the garbage between two collections; rows that are never freed would add 2 MB per second.
WATCHED_S = 300.0 if IS_LONG else 6.0


def is_grey(browser):
    return "grayscale(1)" in browser.run("return getComputedStyle(document.getElementById('main')).filter")


def show_gap(stub, browser):
    browser.wait_for("the strip of x has ink from end to end",
                     lambda: sum(browser.ink("x")) > 0.9 * (len(browser.ink("x")) - 70))
    stub.lose(GAP_S)
    time.sleep(2.0)
    for chart in ("x", "norm"):
        ink = browser.ink(chart)
        first, blank = widest_blank(ink)
        expected = GAP_S / MINUTE_S * sum(1 for _ in range(ink.index(True), len(ink) - ink[::-1].index(True)))
        demand(f"{chart}: the gap of {GAP_S} s is {blank} columns without ink, expected {expected:.0f} within 4",
               abs(blank - expected) <= 4)
    browser.shot("gap-60s-1366")

    stub.history_gap = (time.time() - 1800, time.time() - 1200)
    browser.click("#trace-span input[value='3600']")
    browser.wait_for("the chart of an hour is drawn", lambda: sum(browser.ink("x")) > 300)
    first, blank = widest_blank(browser.ink("x"))
    columns = len(browser.ink("x"))
    # Outside the envelope there is only the grid; the axis labels need 64 columns.
    expected = 600 / 3600 * (columns - 64)
    demand(f"a gap of 10 min in an hour is {blank} columns without ink, expected {expected:.0f} within 8",
           abs(blank - expected) <= 8)
    browser.shot("gap-1h-1366")
    stub.history_gap, stub.peak_s = None, time.time() - 1000
    browser.click("#trace-span input[value='86400']")
    browser.click("#trace-span input[value='3600']")
    browser.wait_for_text("caption-x", "mGal, peaks cut")
    height = browser.ink_height("x") / browser.run("return document.getElementById('chart-x').clientHeight")
    demand(f"with a rare peak of 2000 mGal an envelope of 24 mGal has {100 * height:.0f} % of the strip, must exceed 20",
           height > 0.2)
    browser.shot("peak-1h-1366")
    browser.click("#trace-span input[value='60']")


def show_stale(stub, browser):
    stub.status["signal"], stub.status["occupation"] = signal("keep_off"), occupation()
    browser.wait_for_text("signal-word", "KEEP OFF")
    demand("with fresh data the page has no banner and its normal colours",
           browser.text("banner") == "" and not is_grey(browser))
    stub.is_sampling = False
    took = browser.wait_for_text("banner", "STALE: no new data.", seconds=6.0)
    demand(f"data are called stale after {took:.1f} s, must be 2 to 4", 2.0 < took < 4.0)
    demand("the old word is no longer shown", browser.text("signal-word") == "NO FRESH DATA")
    browser.wait_for_text("signal-sentence", "Last signal: KEEP OFF,")
    demand("the stay can still be stopped", browser.find("#stop").is_displayed())
    demand("the page is shown in grey", is_grey(browser))
    browser.shot("stale-1366")
    stub.is_sampling = True
    browser.wait_for("the banner disappears with new data", lambda: browser.text("banner") == "", seconds=3.0)
    demand("the word is shown again", browser.text("signal-word") == "KEEP OFF")
    stub.status["signal"], stub.status["occupation"] = signal("go", buttons=["start"]), None


def load_in_an_outage(stub, browser):
    stub.is_sampling = False
    time.sleep(5.0)
    last_s = stub.begin_s + stub.samples[-1][0] / RATE_HZ
    browser.driver.refresh()
    time.sleep(2.0)  # The page from before has gone.
    browser.wait_for_text("banner", "STALE: no new data.")
    said, age_s = browser.text("banner"), time.time() - last_s
    shown_s = float(said.split("are ")[1].split(" s")[0])
    demand(f"a page loaded in an outage says {shown_s} s, the last sample is {age_s:.1f} s old", abs(shown_s - age_s) < 1.5)
    stub.is_sampling = True
    browser.wait_for("the banner disappears with new data", lambda: browser.text("banner") == "", seconds=3.0)


def show_other_clock(stub, browser):
    stub.clock_ahead_s = 4.0
    time.sleep(3.0)
    demand("a difference of 4 s between the clocks is not said", browser.text("clock-note") == "")
    for ahead_s, word in ((-90.0, "1 min 30 s ahead of"), (90.0, "1 min 30 s behind")):
        stub.clock_ahead_s = ahead_s
        browser.wait_for_text("clock-note", f"this screen's clock is {word} the recorder's", seconds=8.0)
    stub.clock_ahead_s = 0.0
    browser.wait_for("equal clocks are not said", lambda: browser.text("clock-note") == "", seconds=8.0)


def show_lost(stub, browser):
    stub.is_away = True
    browser.wait_for_text("banner", "CONNECTION LOST", seconds=3.0)
    demand("the page is shown in grey", is_grey(browser))
    browser.shot("lost-1366")
    browser.open_details(identifier="more")
    browser.find("#note").send_keys("a lorry")
    browser.click("#note-form button")
    browser.wait_for_text("answer", "Not done: the daemon does not answer")
    time.sleep(3.0)
    stub.sites = [{**stub.sites[0], "site": "elsewhere"}]
    stub.is_away = False
    took = browser.wait_for("the page connects again by itself", lambda: browser.text("banner") == "", seconds=10.0)
    demand(f"the page connected after {took:.1f} s, limit 9 (the longest pause between attempts is 8 s)", took < 9.0)
    browser.wait_for_text("health-rows", "connections lost: 1")
    browser.wait_for("the list has the sites of the new daemon",
                     lambda: "elsewhere" in browser.text("start-site"))


def metrics(browser):
    """Returns the metrics with the smallest heap of four measurements, because the page continues after each collection."""
    looks = []
    for _ in range(4):
        browser.driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
        values = browser.driver.execute_cdp_cmd("Performance.getMetrics", {})["metrics"]
        looks.append({one["name"]: one["value"] for one in values})
        time.sleep(0.15)
    return min(looks, key=lambda look: look["JSHeapUsedSize"])


def watch_growth(browser):
    browser.driver.execute_cdp_cmd("Performance.enable", {})
    time.sleep(2.0)
    before = metrics(browser)
    time.sleep(WATCHED_S)
    after = metrics(browser)
    heap, nodes = (after[key] - before[key] for key in ("JSHeapUsedSize", "Nodes"))
    busy = (after["TaskDuration"] - before["TaskDuration"]) / (after["Timestamp"] - before["Timestamp"])
    demand(f"in {WATCHED_S:.0f} s the heap of {after['JSHeapUsedSize'] / 1e6:.1f} MB grows by {heap / 1e6:.2f} MB, "
           f"limit {MOST_GROWTH_MB}", heap < 1e6 * MOST_GROWTH_MB)
    demand(f"{nodes:.0f} of {after['Nodes']:.0f} nodes are new, limit 200", nodes < 200)
    print(f"the page's own thread is busy {100 * busy:.1f} % of the time")
    said = browser.text("health-rows")
    redraw_ms = float(said.split("drawn in ")[1].split()[0])
    demand(f"four strips of a minute are drawn in {redraw_ms} ms, limit 100; they are drawn every 200 ms", redraw_ms < 100)


with Browser(allowed_errors=["WebSocket connection to", "ERR_EMPTY_RESPONSE", "Failed to load resource"]) as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    time.sleep(0.3)
    page.resize((1366, 1200))
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    page.open_details()
    page.run("document.getElementById('details').scrollIntoView()")
    watch_growth(page)
    page.resize((1366, 768))
    show_stale(daemon, page)
    show_other_clock(daemon, page)
    page.resize((1366, 1200))
    show_gap(daemon, page)
    page.resize((1366, 768))
    show_lost(daemon, page)
    load_in_an_outage(daemon, page)

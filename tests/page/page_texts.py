"""Names, notes and messages with any characters are shown as plain text, and the page stays usable."""

import time

from browser import LAPTOP, PHONE, Browser
from made_up import details, finished, occupation, signal
from programs import demand
from stub_daemon import StubDaemon, row

MARKUP = "<img src=x onerror=\"document.title='owned'\"><script>document.title='owned'</script><b>bold</b>"
QUOTES = "\"'`&amp;&#60; ${1+1} {{1+1}} </title></option></select><svg onload=alert(1)>"
CONTROL = "bell\u0007 null\u0000 escape\u001b[31m tab\t line\nnext \u202egnirts"
CONTROL_SHOWN = "bell␇ null␀ escape␛[31m tab␉ line␊next \ufffdgnirts"
LONG = "ab <i>c</i> " * 850 + "end"  # 10 kB.
ENDLESS = "W" * 10_000
CASES = {"markup": (MARKUP, MARKUP), "quotes": (QUOTES, QUOTES), "control characters": (CONTROL, CONTROL_SHOWN),
         "10 kB": (LONG, LONG), "10 kB without a space": (ENDLESS, ENDLESS)}

ELEMENTS = "return document.querySelectorAll('script, img, iframe, b, i, svg, title').length"


def shown(browser, identifier):
    return browser.run("return document.getElementById(arguments[0]).textContent", identifier)


def show_everywhere(stub, text):
    stub.sites = [{"site": text, "distance_m": 3.0}]
    stub.occupations = [finished(text, note=text)]
    stub.status["occupation"] = occupation(text, operator=text, note=text, warnings=[text])
    # A sentence that began with a reason would take its place.
    stub.status["signal"] = {**signal("look", buttons=["checked"]), "sentence": f"Look: {text}", "parts": None}
    stub.status["details"] = {**details(checks=[]), "reasons": [text]}
    stub.status["tilt"] = {"axes": ["x", "y"], "x_arcmin": 2.0, "y_arcmin": 0.0, "limit_arcmin": 1.2, "is_within": False,
                           "reference": {"site": text, "utc": None}, "advice": [text]}
    stub.status["level"], stub.status["reasons"] = "warning", [text]
    stub.rows = [row("device", text)]


with Browser() as page:
    daemon = StubDaemon()
    daemon.status["occupation"] = occupation()
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("run-site", "No.5")
    elements = page.run(ELEMENTS)
    for name, (text, expected) in CASES.items():
        show_everywhere(daemon, text)
        page.wait_for(f"{name}: the site is shown unchanged", lambda: shown(page, "run-site") == expected)
        page.wait_for(f"{name}: the site is shown unchanged in the list of the day",
                      lambda: expected in shown(page, "day-rows"))
        for place in ("run-remark", "run-warnings", "signal-sentence", "details-checks", "level-advice", "level-reference", "trouble",
                      "health-rows"):
            said = shown(page, place).replace("′", "'")
            demand(f"{name}: {place} shows the text", expected.replace("′", "'") in said)
        page.run("scrollTo(0, 0)")
        for size in (LAPTOP, PHONE):
            page.resize(size)
            page.demand_readable(f"{name} at {size[0]} px")
            if size == LAPTOP:
                demand(f"{name}: word and stop button are visible without scrolling",
                       page.is_above_fold("signal-word") and page.is_above_fold("stop"))
            page.shot(f"text-{name.replace(' ', '-')}-{size[0]}")
        page.resize(LAPTOP)
        demand(f"{name}: the text created no element", page.run(ELEMENTS) == elements)
        demand(f"{name}: the text did not change the title: {page.driver.title[:60]!r}",
               page.driver.title.startswith("LOOK") and page.driver.title.endswith("a351"))

        daemon.status["occupation"] = None
        page.wait_for(f"{name}: the list of sites shows the site",
                      lambda: page.text("start-site") != "" and expected[:200] in shown(page, "start-site"))
        page.run("const s = document.getElementById('start-site'); s.selectedIndex = 1; s.dispatchEvent(new Event('change'));")
        page.click("#start")
        page.wait_for(f"{name}: the order carries the name unchanged",
                      lambda: daemon.posts and daemon.posts[-1][1].get("site") == text)
        page.run("const row = document.querySelector('#day-rows tr'); if (row.ariaExpanded !== 'true') row.click();")
        page.click("#day-discard")
        demand(f"{name}: the question shows the name", expected in shown(page, "discard-text"))
        demand(f"{name}: the buttons of the question are visible without scrolling", page.is_above_fold("discard-yes"))
        page.click("#discard-no")

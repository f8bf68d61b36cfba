"""Each state of the page with made-up data: words, signs, contrast and sizes; saves pictures under screenshots/."""

import time

from browser import LAPTOP, PHONE, Browser
from made_up import (MISSING, MOVED, SIGNALS, details, finding, finished, gravity, no_stay, occupation, reading, signal, sites, stay, survey,
                     tilt)
from programs import demand
from stub_daemon import StubDaemon, check, row

STAY = {"key": "20260301T013000Z", "site": "No.5"}  # The running one.
PROPOSED = "return [...document.querySelectorAll('#signal-buttons .proposed:not([hidden])')].map((one) => one.innerText)"


def show_words(stub, browser):
    stub.status["occupation"] = occupation()
    looks = set()
    for word in SIGNALS:
        stub.status["signal"] = signal(word)
        stub.status["occupation"] = occupation(moved=MOVED if word == "look" else None)
        browser.wait_for_text("signal-word", SIGNALS[word][0])
        sign, colour = browser.run("return [document.getElementById('signal-sign').getAttribute('href'),"
                                   "getComputedStyle(document.getElementById('signal')).backgroundColor]")
        looks.add((sign, colour))
        demand(f"{word}: at most two large buttons", len(browser.run(PROPOSED)) == len(stub.status["signal"]["buttons"]) <= 2)
        demand(f"{word}: a stay can be stopped", browser.find("#stop").is_displayed())
        demand(f"{word}: the title of the tab has it: {browser.driver.title}", browser.driver.title.startswith(SIGNALS[word][0]))
        for size in (LAPTOP, PHONE):
            browser.resize(size)
            browser.demand_readable(f"{word} at {size[0]} px")
            browser.shot(f"{word}-{size[0]}")
        browser.resize(LAPTOP)
    demand(f"each word has its own sign and colour: {looks}", len({one for one, _ in looks}) == len({one for _, one in looks}) == len(SIGNALS))
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedVisionDeficiency", {"type": "achromatopsia"})
    browser.shot("look-without-colour")
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedVisionDeficiency", {"type": "none"})


def press_buttons(stub, browser):
    at = MOVED["utc"]
    early = {"utc": at, "is_at_start": True}
    for word, buttons, presses in (
            ("lift", ["setup", "stop"], {"setup": ("setup", STAY)}),
            ("look", ["stop_at", "not_moved"], {"stop_at": ("stop", {**STAY, "at": at}), "not_moved": ("not_moved", STAY)}),
            ("look", ["setup_at", "not_moved"], {"setup_at": ("setup", {**STAY, "at": at})}),
            ("look", ["begin_at", "not_moved"], {"begin_at": ("retime", {**STAY, "from": at, "reason": "started too early"})}),
            ("look", ["checked"], {"checked": ("checked", {"code": "moved", "key": ""})})):
        stub.status["signal"] = signal(word, buttons=buttons)
        stub.status["occupation"] = occupation(moved=early if "begin_at" in buttons else MOVED)
        for code, (path, body) in presses.items():
            button = f"#signal-buttons [data-code={code}]"
            browser.wait_for(f"the button {code} is shown", lambda: browser.find(button).is_displayed())  # noqa: B023
            sent = len(stub.posts)
            browser.click(button)
            browser.wait_for(f"{browser.find(button).text}: an order was sent", lambda: len(stub.posts) > sent)  # noqa: B023
            demand(f"it is {path} {body}", stub.posts[-1] == (f"/api/occupation/{path}", body))
    demand("the sentence has the operator's time", "01:43:20 UTC" in browser.text("signal-sentence"))
    stub.status["signal"], stub.status["occupation"] = no_stay(), None
    browser.wait_for("Start is offered beside the signal",
                     lambda: browser.find("#signal #start").is_displayed() and browser.find("#signal #start-site").is_displayed())
    demand("without a stay there is nothing to stop", not browser.find("#stop").is_displayed())


def count_announcements(stub, browser):
    stub.status["occupation"] = occupation()
    parts = ["{}: set-up {} of {}, {} left", ["No.5"], ["1"], ["2"]]
    stub.status["signal"] = signal("keep_off", [[*parts, ["2:10"]], "."])
    browser.wait_for_text("signal-sentence", "2:10 left")
    browser.run("window.announced = 0; new MutationObserver((all) => { window.announced += all.length; }).observe("
                "document.getElementById('signal-word'), {childList: true, characterData: true, subtree: true});")
    for left in ("2:09", "2:08"):
        stub.status["signal"] = signal("keep_off", [[*parts, [left]], "."])
        browser.wait_for_text("signal-sentence", f"No.5: set-up 1 of 2, {left} left.")
    demand("an unchanged word is not announced again", browser.run("return window.announced") == 0)
    stub.status["signal"] = signal("lift")
    browser.wait_for_text("signal-word", "LIFT, SET DOWN")
    demand("a new word is announced once", browser.run("return window.announced") == 1)
    demand("the word is announced politely (aria-live)", browser.find("#signal-word").get_attribute("aria-live") == "polite")


def show_one_number(stub, browser):
    for given, number, missing in ((None, "", ""), (MISSING, "", "no benchmark with known gravity was read yet"),
                                   (gravity(), "979809.9 ± 1.3 mGal", "")):
        stub.status["occupation"] = occupation(gravity=given)
        browser.wait_for(f"the stay shows {number or missing or 'nothing'}",
                         lambda: (browser.text("run-value"), browser.text("run-missing").lower()) == (number, missing))  # noqa: B023
    large = browser.run("return [...document.querySelectorAll('main *')].filter((e) => e.checkVisibility() && !e.closest('#signal')"
                        " && e.children.length === 0 && /[0-9]{6}/.test(e.innerText)"
                        " && parseFloat(getComputedStyle(e).fontSize) >= 24).map((e) => e.innerText)")
    demand(f"one number is large: {large}", large == ["979809.9"])
    stub.status["occupation"] = occupation(gravity=gravity(), warnings=["the site was occupied before: this is stay 2"])
    browser.wait_for_text("run-warnings", "this is stay 2")
    above = {name: browser.is_above_fold(name) for name in ("signal-word", "signal-buttons", "run-value", "run-warnings")}
    demand(f"the main items are visible without scrolling at 1366 x 768: {above}", all(above.values()))
    browser.shot("stay-1366")


def show_details(stub, browser):
    demand("details are folded", browser.text("details-checks") == "" and browser.text("health-rows") == "")
    stub.status["details"] = details("stable", 430)
    stub.status["occupation"] = occupation(whole=reading(set_ups=2, set_up_sd_mgal=1.1, set_up_error_mgal=0.778))
    browser.open_details()
    browser.wait_for_text("details-reading", "979861.32 mGal before all corrections; 6 min 28 s of data used, 12 s left out. "
                          "Scatter of 2 set-ups: 1.10 mGal, of their mean 0.78 mGal.")
    demand("the state and its time are said", browser.text("details-reading").startswith("stable. Unchanged for 7 min 10 s."))
    checks = browser.text("details-checks").splitlines()
    demand(f"checks have a mark, values have units and errors: {checks}", checks[0] == "✗ temperature slope 0.31 °C/h (limit 0.25 °C/h)"
           and "✓ last knock 180 s ago (needs 72 s)" in checks and "✓ acceleration slope 2.1 ± 1.4 mGal/h (limit 12 mGal/h)" in checks)
    browser.demand_readable("details")
    browser.shot("details-1366", is_whole=True)
    browser.open_details(False)


def count_a_placement_test(stub, browser):
    configured = {"planned_set_ups": 20, "planned_s": 3600.0, "set_up_count": 7}
    stub.status["occupation"] = occupation("No.1", **configured)
    browser.wait_for_text("run-site", "No.1")
    demand("twenty configured set-ups are no placement test", not browser.find("#run-test").is_displayed())
    test = {**configured, "has_own_plan": True}
    stub.status["occupation"] = occupation(**test)
    browser.wait_for_text("run-test", "Placement test: the scatter is shown from 8 set-ups on.")
    whole = reading(set_ups=20, set_up_sd_mgal=1.3, set_up_sd_limits_mgal=[0.99, 1.9], set_up_error_mgal=0.29)
    stub.status["signal"] = signal("go")
    stub.status["occupation"] = occupation(**{**test, "whole": whole, "set_up_count": 20})
    browser.wait_for_text("run-test", "scatter of 20 set-ups 1.30 mGal (95 %: 0.99 to 1.90), with tilt, temperature and noise in it. "
                          "After Stop, in the evening: a351-correct calibrate --placement test.toml --out placement.toml")
    browser.demand_readable("a placement test")
    browser.shot("placement-test-1366")


def show_level(stub, browser):
    demand("while the box must not be touched there is no level", not browser.find("#level").is_displayed())
    stub.status["tilt"] = tilt(2.4, -0.6, ["lower the +x side by 2.4'", "raise the +y side by 0.6'"])
    browser.wait_for_text("level-advice", "lower the +x side by 2.4′")
    demand("both axes are shown in arc minutes with their signs", browser.text("level-numbers") == "x +2.4′ y −0.6′")
    demand("words say that the tilt is too large", browser.text("level-word") == "✗ more than 1.2′")
    x, y = (float(browser.find("#bubble-spot").get_attribute(key)) for key in ("cx", "cy"))
    demand(f"the bubble is on the high side, +x and -y: {x:.0f}, {y:.0f} (down is positive)", x > 40 and y > 0)
    browser.shot("tilted-1366")
    stub.status["tilt"] = tilt(60.0, 80.0, ["lower the +x side by 60.0'", "lower the +y side by 80.0'"])
    browser.wait_for_text("level-numbers", "+80.0′")
    x, y = (float(browser.find("#bubble-spot").get_attribute(key)) for key in ("cx", "cy"))
    demand(f"at a large tilt the bubble stays at the rim: {x:.0f}, {y:.0f}", 80 < (x * x + y * y) ** 0.5 < 100)
    stub.status["tilt"] = tilt(None, None)
    browser.wait_for_text("level-numbers", "tilt not known yet")
    demand("without a known tilt no bubble is shown", browser.find("#bubble-spot").get_attribute("visibility") == "hidden")
    stub.status["tilt"] = tilt(0.4, 0.3)
    browser.wait_for_text("level-word", "✓ within 1.2′")
    stub.status["tilt"] = None


def cells(browser):
    return browser.run("return [...document.querySelectorAll('#day-rows tr[data-key]')].map((row) =>"
                       "[...row.children].slice(1).map((cell) => cell.innerText).join('|'))")


def show_day(stub, browser):
    ended = [("No.0", 30, {}), ("No.0", 3, {"note": "windy"}), ("No.3", 2, {}), ("No.6", 1, {})]
    stub.occupations = [{**finished(site, hours_ago=hours, **more), "key": f"key-{i}"} for i, (site, hours, more) in enumerate(ended)]
    stub.discarded = [{**finished("No.9", hours_ago=4), "key": "gone"}]
    stub.status["occupation"] = occupation()
    headline, knock = "No.3 (1) reads like No.7: it is 12.1 mGal too high for No.3", "a knock <i> at 2026-03-01T01:43:20Z"
    stub.survey = survey([stay("No.0", difference_mgal=0.42, key="key-1"), stay("No.3", gravity_mgal=979873.5, difference_mgal=12.1, key="key-2"),
                          stay("No.6", gravity_mgal=None, key="key-3", remarks=[{"code": "left_out", "numbers": [], "text": knock}]),
                          stay("No.5", is_running=True)],
                         [finding("the readings follow the temperature", False), finding(headline, True, "key-2"),
                          finding("the sensor was exchanged", True)])
    expected = ["No.5 (1)|979861.3 ± 1.3||✓", "No.6 (1)|–||⚠", "No.3 (1)|979873.5 ± 1.3|+12.1|⚠", "No.0 (1)|979861.3 ± 1.3|+0.4|✓", "No.9|–||"]
    browser.wait_for(f"the stays are listed newest first, each with one mark: {expected}", lambda: cells(browser) == expected, seconds=15)
    demand("the zone is said once", browser.text("day-zone") == "Start, UTC" and "UTC" not in browser.text("day-rows"))
    demand("above the list are only headlines of the day", browser.text("gravity-findings") == "⚠ the sensor was exchanged")
    demand("remarks are folded", headline not in browser.text("day-rows") and not browser.find("#day-change").is_displayed())
    for key, remark, buttons in (("key-2", f"⚠ {headline}\n11 min 00 s", ["rename", "times", "discard"]),
                                 ("key-3", "⚠ a knock <i> at 01:43:20 UTC", ["rename", "times", "discard"]),
                                 ("key-1", "11 min 00 s; windy", ["rename", "times", "discard"]), ("gone", "discarded", ["restore"]),
                                 (STAY["key"], "running", ["rename", "times", "discard"])):
        browser.click(f"#day-rows [data-key='{key}']")
        browser.wait_for_text("day-rows", remark)
        shown = [one for one in ("rename", "times", "discard", "resume", "restore") if browser.find(f"#day-{one}").is_displayed()]
        demand(f"{key}: the buttons are {shown}", shown == buttons)
    browser.demand_readable("an unfolded row")
    browser.shot("day-1366")
    browser.click(f"#day-rows [data-key='{STAY['key']}']")
    demand("a second press folds it", "running" not in browser.text("day-rows"))
    browser.resize(PHONE)
    browser.demand_readable("the day at 360 px")
    browser.shot("day-360", is_whole=True)
    browser.resize(LAPTOP)


def show_figures(stub, browser):
    browser.wait_for("the trace of the stay is drawn", lambda: browser.run(
        "return (document.querySelector('#run-trace .curve')?.getAttribute('d').match(/[ML]/g) ?? []).length") > 100, seconds=15)
    begin, width = browser.run("const r = document.querySelector('#run-trace .shade'); return [+r.getAttribute('x'), +r.getAttribute('width')]")
    demand(f"the running set-up is shaded, from {begin:.0f} to {begin + width:.0f} of 53 to 389", abs(begin - 53) < 1 and abs(width - 336) < 1)
    states = "return [...document.querySelectorAll(`#${arguments[0]} circle`)].map((one) => one.getAttribute('class')).sort()"
    demand("known benchmarks are in the figure of the day, a doubtful one marked", browser.run(states, "day-differences") == ["doubt", "read"])
    marks = browser.run(states, "map")
    demand(f"benchmarks fill in on the map: {marks}", [marks.count(one) for one in ("read", "doubt", "open", "here")] == [1, 2, 11, 1])
    demand("their number is said", browser.text("map-caption") == "3 of 14 benchmarks were read today")
    demand("the place of the running stay has its name", browser.run("return document.querySelector('#map text').textContent") == "No.5")
    across = [{"site": name, "latitude_deg": 36.2 + 0.01 * k, "longitude_deg": longitude}
              for k, (name, longitude) in enumerate([("A", 179.99), ("B", -179.99), ("C", 180.0), ("D", -180.0)])]
    a, b, c, d = browser.driver.execute_async_script(
        "const done = arguments[1]; import('/figures.js').then((page) => { page.show_map(arguments[0], [], '');"
        "done([...document.querySelectorAll('#map circle')].map((one) => Number(one.getAttribute('cx')))); })", across)
    demand(f"a map across 180 degrees is one piece: {a:.1f} {c:.1f} {d:.1f} {b:.1f}", abs(c - d) < 0.1 and b - c > 20 and c - a > 20)
    browser.shot("figures-1366", is_whole=True)
    browser.open_details(False)


def choose_next(stub, browser):
    stub.sites = sites()  # Sorted by the distance from the last stay.
    stub.status["occupation"], stub.status["signal"] = None, no_stay()
    browser.wait_for("the nearest site that was not visited today is chosen",
                     lambda: browser.text("start") != "" and browser.find("#start-site").get_attribute("value") == "No.1")
    browser.choose("start-site", "No.6")
    browser.wait_for_text("start-warning", "was occupied at")
    stub.sites = sites(15)
    browser.wait_for("the list is read again", lambda: "No.14" in browser.text("start-site"))
    demand("what the operator has chosen stays", browser.find("#start-site").get_attribute("value") == "No.6")
    browser.choose("start-site", "No.0")
    browser.wait_for("a return to the first site of the day is no warning", lambda: browser.text("start-warning") == "")
    browser.click("#start")
    browser.wait_for("after a start the next one is chosen", lambda: browser.find("#start-site").get_attribute("value") == "No.1")
    browser.shot("start-1366")


def show_missed_set_up(stub, browser):
    last = {**finished("No.6", hours_ago=0.2), "key": "key-3"}
    missed, at = "No.6 (1): box lifted and set down without a set-up; only the part before is used", last["set_ups"][0]["start"]
    stub.occupations = [*stub.occupations[:-1], last]
    stub.survey = survey([stay("No.6", key="key-3")], [{**finding(missed, False, "key-3"), "kind": "missed_set_up", "time_utc": at}])
    browser.wait_for("a stay with a missed set-up is doubtful", lambda: "No.6 (1)|979861.3 ± 1.3||⚠" in cells(browser), seconds=15)
    browser.click("#day-rows [data-key='key-3']")
    browser.wait_for_text("day-rows", f"⚠ {missed}")
    browser.wait_for_text("day-setup", f"Next set-up at {at[11:19]}")
    stub.posts.clear()
    browser.click("#day-setup")
    browser.wait_for("three orders are sent", lambda: len(stub.posts) == 3)
    sent = [(path.split("/")[-1], body["key"], body.get("at")) for path, body in stub.posts]
    demand(f"the stay is resumed, divided and stopped as before: {sent}",
           sent == [("resume", "key-3", None), ("setup", "key-3", at), ("stop", "key-3", last["set_ups"][0]["end"])])
    stub.refusal = "this instant is not recorded"
    for stub.refused, expected in (("setup", ["resume", "setup", "stop"]), ("resume", ["resume"])):
        stub.posts.clear()
        browser.click("#day-setup")
        browser.wait_for(f"if {stub.refused} is refused, {len(expected)} orders are sent", lambda: len(stub.posts) == len(expected))
        browser.wait_for("the last answer is the refusal", lambda: browser.text("answer") == f"Not done: {stub.refusal}"
                         and "error" in browser.find("#answer").get_attribute("class"))
        time.sleep(0.2)  # A further order would follow at once.
        sent = [path.split("/")[-1] for path, _ in stub.posts]
        demand(f"the stay does not run on: {sent}", sent == expected)
    stub.refusal, stub.refused = None, ""
    stub.status["occupation"] = occupation()
    browser.wait_for("while a stay runs the button is hidden", lambda: browser.text("day-setup") == "")
    stub.status["occupation"] = None


def show_no_figures(stub, browser):
    stub.survey = {**stub.survey, "reason": "killed", "reason_text": "signal 9 ended it"}
    browser.wait_for_text("gravity-state", "These figures are old: signal 9 ended it.", seconds=15)
    stub.survey = survey([], reason="no_reference", reason_text="no benchmark with known gravity was read yet", model=None)
    browser.wait_for_text("gravity-state", "No figures: no benchmark with known gravity was read yet.", seconds=15)


def show_trouble(stub, browser):
    stub.status["level"], stub.status["signal"] = "warning", signal("look")
    stub.status["reasons"] = [stub.status["signal"]["sentence"]]
    browser.wait_for_text("signal-word", "LOOK")
    demand("the sentence of the signal is not said twice", browser.text("trouble") == "")
    stub.status["level"] = "fault"
    stub.status["reasons"] = ["the disk of the data root is full", "port: no such device"]
    browser.wait_for_text("trouble", "FAULT: the disk of the data root is full\nport: no such device")
    stub.rows = [row("state", ["fault"], ": the disk is full", level="fault"), row("troubles", "checksum errors 3"),
                 row("temperature", "42.500 degC"), row("outer oven", ["disabled"])]
    browser.open_details()
    browser.wait_for_text("health-rows", "checksum errors 3")
    said = browser.text("health-rows")
    demand(f"the rows of the daemon are shown, and one of the page: {said!r}",
           all(text in said for text in ("fault: the disk is full", "42.500 °C", "disabled", "connections lost: 0")) and "set point" not in said)
    demand("the row of the state has its level", browser.run("return document.querySelector('#health-rows > div').dataset.level") == "fault")
    stub.rows.pop()
    browser.wait_for("a row that is there no longer is removed", lambda: "disabled" not in browser.text("health-rows"))
    browser.demand_readable("a fault")
    browser.shot("fault-1366")


def show_check_lists(stub, browser):
    for count in (6, 12):
        checks = [check(f"quantity {i} that is shown in the list of checks", 0.31, "degC/h", 0.25, i > 2) for i in range(count)]
        stub.status["details"] = details(checks=checks)
        browser.wait_for(f"{count} checks are listed", lambda: len(browser.text("details-checks").splitlines()) == count)  # noqa: B023
        for width in (1366, 400):
            browser.resize((width, 768))
            hidden = browser.run("const e = document.getElementById('details-checks'); return [e, ...e.children]"
                                 ".map((one) => one.scrollHeight - one.clientHeight).reduce((a, b) => Math.max(a, b));")
            demand(f"{count} checks at {width} px: {hidden} px are cut, must be 0", hidden <= 0)
    browser.resize(LAPTOP)


with Browser(allowed_errors=["status of 409"]) as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    page.wait_for("samples arrive", lambda: daemon.samples)
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    show_words(daemon, page)
    press_buttons(daemon, page)
    count_announcements(daemon, page)
    show_one_number(daemon, page)
    show_details(daemon, page)
    count_a_placement_test(daemon, page)
    show_level(daemon, page)
    show_day(daemon, page)
    show_figures(daemon, page)
    choose_next(daemon, page)
    show_missed_set_up(daemon, page)
    show_no_figures(daemon, page)
    show_trouble(daemon, page)
    show_check_lists(daemon, page)

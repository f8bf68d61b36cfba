"""Each state of the page with made-up data: words, signs, contrast and sizes; saves pictures under screenshots/."""

import time

from browser import LAPTOP, PHONE, Browser
from made_up import VERDICTS, finding, finished, occupation, reading, sites, stay, survey, tilt, verdict
from programs import demand
from stub_daemon import StubDaemon, check, row

ABOVE_FOLD = ["verdict-word", "verdict-checks", "occupation-title", "level-word"]


def show_verdicts(stub, browser):
    pictures = set()
    for state in VERDICTS:
        stub.status["verdict"] = verdict(state)
        browser.wait_for_text("verdict-word", state.upper())
        sign = browser.run("return document.getElementById('verdict-sign').getAttribute('href')")
        pictures.add(sign)
        checks = browser.text("verdict-checks").splitlines()
        demand(f"{state}: checks that are not met are listed first, with a mark: {checks[0]}",
               [line[0] for line in checks] == ["✓" if one["is_met"] else "✗" for one in VERDICTS[state]])
        for size in (LAPTOP, PHONE):
            browser.resize(size)
            browser.demand_readable(f"{state} at {size[0]} px")
            browser.shot(f"{state.replace(' ', '-')}-{size[0]}")
        browser.resize(LAPTOP)
    demand(f"each verdict has its own sign: {pictures}", len(pictures) == len(VERDICTS))
    checks = browser.text("verdict-checks")
    demand("values have units", "0.05 °C/h (limit 0.25 °C/h)" in checks and "180 s ago (needs 72 s)" in checks)
    demand("an error is shown with its value", "2.1 ± 1.4 mGal/h" in checks)


def show_time_left(stub, browser):
    stub.status["verdict"] = {**verdict("disturbed", held_s=12), "time_left_s": 110.0}
    browser.wait_for_text("verdict-held", "Unchanged for 12 s.")
    browser.wait_for_text("verdict-left", "At least 1 min 50 s more.")
    known = check("temperature known for", 2.3, "min", 20.0, False, is_least=True)
    stub.status["verdict"] = {**verdict("settling", held_s=138), "checks": [known], "time_left_s": 1082.0}
    browser.wait_for_text("verdict-advice", "Wait: the temperature is known for 2.3 of 20 min.")
    browser.wait_for_text("verdict-left", "At least 18 min 02 s more.")
    stub.status["verdict"] = {**verdict("stable", held_s=60), "time_left_s": 0.0}
    browser.wait_for("a stable verdict has no time left", lambda: browser.text("verdict-held") == "Unchanged for 1 min 00 s." and not browser.text("verdict-left"))


def show_without_colour(stub, browser):
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedVisionDeficiency", {"type": "achromatopsia"})
    stub.status["verdict"] = verdict("disturbed")
    browser.wait_for_text("verdict-word", "DISTURBED")
    browser.shot("disturbed-without-colour")
    browser.driver.execute_cdp_cmd("Emulation.setEmulatedVisionDeficiency", {"type": "none"})


def count_announcements(stub, browser):
    stub.status["verdict"] = verdict("settling", held_s=10)
    browser.wait_for_text("verdict-held", "10 s")
    browser.run("window.announced = 0; new MutationObserver((all) => { window.announced += all.length; }).observe("
                "document.getElementById('verdict-word'), {childList: true, characterData: true, subtree: true});")
    for held_s in (11, 12):
        stub.status["verdict"] = verdict("settling", held_s=held_s)
        browser.wait_for_text("verdict-held", f"{held_s} s")
    demand("an unchanged verdict is not announced again", browser.run("return window.announced") == 0)
    stub.status["verdict"] = verdict("stable", held_s=0)
    browser.wait_for_text("verdict-word", "STABLE")
    demand("a new verdict is announced once", browser.run("return window.announced") == 1)
    demand("the verdict is announced politely (aria-live)",
           browser.find("#verdict-word").get_attribute("aria-live") == "polite")


def count_set_ups_down(stub, browser):
    stay = {"planned_set_ups": 3, "set_up_count": 2}
    for changes, expected, is_proposed in (
            ({"set_up_left_s": 130.0}, "set-up 2 of 3: 2:10 left", False),
            ({"set_up_left_s": 0.2}, "set-up 2 of 3: 0:01 left", False),
            ({"set_up_left_s": 0.0, "propose_set_up": True}, "set-up 2 of 3: 0:00 left", True),
            ({"set_up_left_s": 65.0, "set_up_count": 3}, "set-up 3 of 3: 1:05 left", False),
            ({"set_up_left_s": 0.0, "set_up_count": 3, "may_stop": True}, "set-up 3 of 3: the stay may be stopped", False),
            ({"set_up_left_s": 9.0, "set_up_count": 4}, "set-up 4 of 4: 0:09 left", False)):
        stub.status["occupation"] = occupation(**{**stay, **changes})
        browser.wait_for_text("run-plan", expected)
        demand(f"{expected}: the next set-up is {'proposed' if is_proposed else 'not proposed'}",
               browser.find("#run-propose").is_displayed() == is_proposed)


def count_a_placement_test(stub, browser):
    configured = {"planned_set_ups": 20, "planned_s": 3600.0, "set_up_count": 7, "set_up_left_s": 66.0}
    stub.status["occupation"] = occupation(**configured)
    browser.wait_for_text("run-plan", "set-up 7 of 20: 1:06 left")
    demand("twenty configured set-ups are no placement test", not browser.find("#run-test").is_displayed())
    test = {**configured, "has_own_plan": True, "set_up_left_s": 65.0}
    stub.status["occupation"] = occupation(**test)
    browser.wait_for_text("run-plan", "set-up 7 of 20: 1:05 left")
    browser.wait_for_text("run-test", "Placement test: the scatter is shown from 8 set-ups on.")
    whole = {**reading(0.31), "set_ups": 20, "set_up_sd_mgal": 1.3, "set_up_sd_limits_mgal": [0.99, 1.9], "set_up_error_mgal": 0.29}
    stub.status["occupation"] = occupation(**{**test, "whole": whole, "set_up_count": 20, "set_up_left_s": 0.0, "may_stop": True})
    browser.wait_for_text("run-plan", "set-up 20 of 20: the stay may be stopped")
    browser.wait_for_text("run-test", "scatter of 20 set-ups 1.30 mGal (95 %: 0.99 to 1.90), with tilt, temperature and noise in it. "
                          "After Stop, in the evening: a351-correct calibrate --placement test.toml --out placement.toml")
    browser.demand_readable("a placement test")
    browser.shot("placement-test-1366")


def show_occupations(stub, browser):
    stub.status["verdict"] = verdict("stable", held_s=430)
    stub.status["occupation"] = occupation()
    browser.wait_for_text("run-judgement", "still about 4 min 10 s needed (target 1.00 mGal)")
    demand("value and standard error are shown with their unit", browser.text("run-value") == "979861.32 ± 1.31 mGal reading")
    count_set_ups_down(stub, browser)
    count_a_placement_test(stub, browser)
    stub.status["occupation"] = occupation()
    browser.wait_for("the next set-up is not proposed yet", lambda: browser.text("run-propose") == "")
    above = {name: browser.is_above_fold(name) for name in ABOVE_FOLD + ["stop", "run-value"]}
    demand(f"the main items are visible without scrolling at 1366 x 768: {above}", all(above.values()))
    browser.shot("occupation-1366")

    stub.status["occupation"] = occupation(propose_set_up=True,
                                           warnings=["the site was occupied before: this is stay 2"])
    browser.wait_for_text("run-propose", "Lift the box")
    browser.wait_for_text("run-warnings", "this is stay 2")
    browser.demand_readable("the time for the next set-up")
    demand("the stop button stays visible without scrolling", browser.is_above_fold("stop"))
    browser.shot("next-set-up-1366")

    both = {**reading(0.82, 0.0, True), "set_ups": 2, "set_up_sd_mgal": 1.1, "set_up_error_mgal": 0.778}
    stub.status["occupation"] = occupation(whole=both, set_up_count=2, may_stop=True, set_up_left_s=0.0)
    browser.wait_for_text("run-judgement", "✓ GOOD ENOUGH")
    demand("the mean of all set-ups is the value", browser.text("run-value") == "979861.32 ± 0.82 mGal reading")
    browser.wait_for_text("run-whole", "UTC: 979861.32 ± 1.31 mGal. Scatter of 2 set-ups: 1.10 mGal, of their mean 0.78 mGal.")
    browser.demand_readable("good enough")
    browser.shot("good-enough-1366")
    browser.resize(PHONE)
    browser.demand_readable("good enough at 360 px")
    browser.shot("good-enough-360", is_whole=True)
    browser.resize(LAPTOP)

    at = "2026-03-01T01:43:20.000Z"
    stay = {key: occupation()[key] for key in ("key", "site")}
    for is_at_start, answers in ((False, {"moved-stop": ("occupation/stop", {**stay, "at": at}),
                                          "moved-setup": ("occupation/setup", {**stay, "at": at}),
                                          "moved-not": ("occupation/not_moved", stay)}),
                                 (True, {"moved-stop": ("occupation/retime", {**stay, "from": at, "reason": "started too early"})})):
        stub.status["occupation"] = occupation(moved={"utc": at, "is_at_start": is_at_start})
        browser.wait_for_text("moved-text", "The box was moved until 01:43:20" if is_at_start else "The box was moved at 01:43:20 UTC")
        browser.demand_readable("a moved box")
        browser.shot(f"moved-{'early' if is_at_start else 'late'}-1366")
        for button, (path, body) in answers.items():
            sent = len(stub.posts)
            browser.click(f"#{button}")
            browser.wait_for(f"{browser.text(button)}: an order was sent", lambda: len(stub.posts) > sent)
            demand(f"it is {path} {body}", stub.posts[-1] == (f"/api/{path}", body))
        demand("an early start has no further set-up", browser.find("#moved-setup").is_displayed() is not is_at_start)
    stub.status["occupation"] = occupation(moved={"utc": at, "is_at_start": False, "is_set_up": True})
    browser.wait_for_text("moved-text", "The box was lifted and set down at 01:43:20 UTC")
    demand("after a lift the next set-up is the first answer", browser.find("#run-moved button").get_attribute("id") == "moved-setup")
    stub.status["occupation"] = occupation()
    browser.wait_for("the question is gone", lambda: not browser.find("#run-moved").is_displayed())

    stub.status["occupation"] = occupation(whole=reading(None, None))
    browser.wait_for_text("run-judgement", "a set-up is missing")
    stub.status["occupation"] = occupation(whole=reading(None, None), set_up_count=2)
    browser.wait_for_text("run-judgement", "time needed not known yet")
    demand("no standard error is shown before it is known", browser.text("run-value") == "979861.32 mGal reading")


def show_level(stub, browser):
    browser.wait_for_text("level-numbers", "tilt not known yet")
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


def show_day(stub, browser):
    stub.occupations = [finished("No.0", hours_ago=30), finished("No.0", hours_ago=3, note="windy"),
                        finished("No.1", hours_ago=2, reading=None),
                        finished("No.1", hours_ago=1, set_ups=finished("x")["set_ups"] * 2, reading={**reading(0.42), "set_up_sd_mgal": 1.234})]
    stub.status["occupation"] = None
    browser.wait_for("the three occupations of the last 24 h are listed",
                     lambda: len(browser.text("day-rows").splitlines()) == 3)
    rows = browser.text("day-rows").splitlines()
    demand(f"occupations are listed newest first, with set-ups, note and value if known: {rows}",
           "2 set-ups, sd 1.23 mGal" in rows[0] and "–" in rows[1] and "windy" in rows[2] and "± 0.42" in rows[2])
    browser.find("#start-site").send_keys("No.1")
    browser.wait_for_text("start-warning", "was occupied at")
    browser.choose("start-site", "No.0")
    browser.wait_for("a return to the first site of the day is no warning", lambda: browser.text("start-warning") == "")
    browser.choose("start-site", "No.1")
    browser.shot("day-1366")
    browser.resize((1366, 1500))
    time.sleep(2.5)
    browser.shot("whole-1366", is_whole=True)
    browser.resize(PHONE)
    browser.demand_readable("the day at 360 px")
    browser.shot("day-360", is_whole=True)
    browser.resize(LAPTOP)


def show_gravity(stub, browser):
    browser.wait_for_text("gravity-state", "No figures: not computed yet.")
    demand("without stays there is no table", not browser.find("#gravity-table").is_displayed())
    headline, remark = "No.3 (1) reads like No.7: it is 12.1 mGal too high for No.3", "the readings follow the temperature <b>"
    stub.survey = survey([stay("No.0", difference_mgal=0.42), stay("No.3", 2, 979873.5, 12.1, set_ups=2),
                          stay("No.5", remarks=[{"code": "pulse", "numbers": [], "text": "a knock <i>"}], is_running=True,
                               u_evening_mgal=1.05),
                          stay("No.6", gravity_mgal=None, remarks=[{"code": "left_out", "numbers": [], "text": "no samples"}])],
                         [finding(remark, False), finding(headline, True)])
    browser.wait_for_text("gravity-state", "As of 12:03:10 UTC, data up to 12:03:09 UTC, model day.", seconds=20)
    rows = [row.replace("\t", " ").strip() for row in browser.text("gravity-rows").splitlines()]
    demand(f"the stays are listed newest first, with value, u, difference and remarks: {rows}",
           rows == ["No.6 (1) – – no samples", "No.5 (1) 979861.32 ± 1.27 – running; ± 1.05 mGal after a return to the base; a knock <i>",
                    "No.3 (2) 979873.50 ± 1.27 +12.10 2 set-ups", "No.0 (1) 979861.32 ± 1.27 +0.42"])
    demand("headlines come first, word by word", browser.text("gravity-findings").splitlines() == [headline, remark])
    browser.demand_readable("gravity so far")
    browser.shot("gravity-1366", is_whole=True)
    browser.resize(PHONE)
    browser.demand_readable("gravity so far at 360 px")
    browser.resize(LAPTOP)
    stub.survey = {**stub.survey, "reason": "killed", "reason_text": "signal 9 ended it"}
    browser.wait_for_text("gravity-state", "These figures are old: signal 9 ended it. As of 12:03:10 UTC", seconds=20)
    stub.survey = survey([], reason="no_reference", reason_text="no benchmark with known gravity was read yet", model=None)
    browser.wait_for_text("gravity-state", "No figures: no benchmark with known gravity was read yet.", seconds=20)


def show_trouble(stub, browser):
    stub.status["level"] = "fault"
    stub.status["reasons"] = ["the disk of the data root is full", "port: no such device"]
    browser.wait_for_text("trouble", "FAULT: the disk of the data root is full; port: no such device")
    stub.rows = [row("state", ["fault"], ": the disk is full", level="fault"), row("troubles", "checksum errors 3"),
                 row("temperature", "42.500 degC"), row("outer oven", ["disabled"])]
    browser.wait_for_text("health-rows", "checksum errors 3")
    said = browser.text("health-rows")
    demand(f"the rows of the daemon are shown, and one of the page: {said!r}",
           all(text in said for text in ("fault: the disk is full", "42.500 °C", "disabled", "connections lost: 0")) and "set point" not in said)
    demand("the row of the state has its level", browser.run("return document.querySelector('#health-rows > div').dataset.level") == "fault")
    stub.rows.pop()
    browser.wait_for("a row that is there no longer is removed", lambda: "disabled" not in browser.text("health-rows"))
    browser.demand_readable("a fault")
    browser.shot("fault-1366")


with Browser() as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    show_verdicts(daemon, page)
    show_time_left(daemon, page)
    show_without_colour(daemon, page)
    count_announcements(daemon, page)
    show_occupations(daemon, page)
    show_level(daemon, page)
    show_day(daemon, page)
    show_gravity(daemon, page)
    show_trouble(daemon, page)

"""The page can be used without a mouse, each button sends its order, and a wrong token can be replaced."""

import time

from browser import Browser, Keys
from made_up import finished, occupation, signal, sites
from programs import demand
from stub_daemon import StubDaemon

STAY = {"key": "20260301T013000Z", "site": "No.5"}  # The running one.

OUTLINE = """
const style = getComputedStyle(document.activeElement);
return [document.activeElement.id || document.activeElement.value || document.activeElement.tagName,
        style.outlineStyle === "none" ? 0 : parseFloat(style.outlineWidth)];
"""


def tab_round(browser, count):
    stops = []
    for _ in range(count):
        browser.press(Keys.TAB)
        name, outline_px = browser.run(OUTLINE)
        demand(f"the focus on {name} is visible: an outline of {outline_px} px, at least 3", outline_px >= 3)
        stops.append(name)
    return stops


def last_post(stub, browser, path):
    browser.wait_for(f"an order to {path} was sent", lambda: stub.posts and stub.posts[-1][0] == path)
    browser.wait_for_text("answer", f"took {path}")
    return stub.posts[-1][1]


def renew_token(stub, browser):
    stub.token = "another-start"
    browser.find("#note").send_keys("first", Keys.ENTER)
    last_post(stub, browser, "/api/note")
    demand("after a restart of the daemon an order is repeated with the new token, without asking",
           [body for _, body in stub.posts[-2:]] == [{**STAY, "note": "first"}] * 2 and browser.text("token-form") == "")
    stub.token, stub.tells_token = "of-the-configuration", False
    browser.find("#note").send_keys("second", Keys.ENTER)
    browser.wait_for_text("answer", "Not done: the token (header X-A351-Token) is missing or wrong")
    browser.wait_for_text("token-form", "Token of this daemon")
    browser.demand_readable("the question for the token")
    browser.find("#token").send_keys("of-the-configuration", Keys.ENTER)
    browser.find("#note").send_keys(Keys.ENTER)
    last_post(stub, browser, "/api/note")
    browser.driver.refresh()
    browser.wait_for_text("run-site", "No.5")
    browser.open_details(identifier="more")
    browser.find("#note").send_keys("third", Keys.ENTER)
    last_post(stub, browser, "/api/note")
    demand("a typed token is kept after a reload", browser.text("token-form") == "")


with Browser(allowed_errors=["status of 403", "status of 409"]) as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    daemon.occupations = [finished("No.0")]
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("start-site", "No.5, 3.3 km")
    page.open_details(identifier="more")
    order = ["start-site", "start", "SUMMARY", "start-operator", "start-note", "start-at", "add-site", "start-test"]
    demand(f"Tab moves through the form first: {order}", tab_round(page, 8) == order)

    page.driver.refresh()
    page.wait_for_text("start-site", "No.5")
    page.press(Keys.TAB, "No.5", Keys.TAB, Keys.TAB, Keys.ENTER, Keys.TAB, "T. Sato", Keys.TAB, "on the pillar", Keys.ENTER)
    demand("Enter starts an occupation at the typed site, with operator and note",
           last_post(daemon, page, "/api/occupation/start")
           == {"site": "No.5", "operator": "T. Sato", "note": "on the pillar"})

    page.driver.refresh()
    page.wait_for_text("start-site", "No.5")
    page.press(Keys.TAB, "No.5", Keys.TAB, Keys.TAB, Keys.ENTER, *[Keys.TAB] * 5, Keys.SPACE)
    page.press_with_shift(*[Keys.TAB] * 6)
    page.press(Keys.ENTER)
    demand("a placement test is started with twenty set-ups",
           last_post(daemon, page, "/api/occupation/start") == {"site": "No.5", "operator": "T. Sato", "note": "", "set_ups": "20"})
    page.wait_for("the next start is no test again", lambda: not page.find("#start-test").is_selected())

    daemon.status["occupation"], daemon.status["signal"] = occupation(), signal("keep_off")
    page.wait_for_text("run-site", "No.5")
    page.driver.refresh()
    page.wait_for_text("run-site", "No.5")
    demand("Tab reaches Stop, then Next set-up", tab_round(page, 2) == ["stop", "setup"])
    page.press_with_shift(Keys.TAB)
    count = len(daemon.posts)
    page.press(Keys.ENTER)
    page.wait_for_text("confirm-stop-text", "Stop No.5 (stay 1), running since")
    page.wait_for_text("confirm-stop-doubt", "⚠ KEEP OFF: No.5: set-up 1 of 2, 2:10 left.")
    daemon.status["signal"] = signal("keep_off", [["{}: set-up {} of {}, {} left", ["No.5"], ["1"], ["2"], ["2:09"]], "."])
    page.wait_for_text("confirm-stop-doubt", "2:09 left.")
    daemon.status["signal"] = signal("keep_off")
    page.demand_readable("the question before a stop")
    page.shot("stop-1366")
    page.press(Keys.ENTER)
    page.wait_for("Enter on the question continues, because the first button is the harmless one",
                  lambda: page.text("confirm-stop-text") == "")
    demand("a stop that was not confirmed is not sent", len(daemon.posts) == count)
    page.press(Keys.ENTER, Keys.TAB, Keys.ENTER)
    running = {"key": "20260301T013000Z", "operator": "T. Sato"}
    demand("the second button stops the stay that the question named",
           last_post(daemon, page, "/api/occupation/stop") == {**running, "site": "No.5"})
    page.press(Keys.TAB, Keys.SPACE)
    demand("Space on Next set-up starts the next set-up of the stay that is shown",
           last_post(daemon, page, "/api/occupation/setup") == STAY)

    count = len(daemon.posts)
    page.press(*[Keys.TAB] * 2)  # The button "More" is between.
    demand("Tab reaches the running stay in the list", page.run("return document.activeElement.dataset.key") == STAY["key"])
    page.press(Keys.ENTER)
    page.wait_for_text("day-rows", "running")
    page.wait_for_text("day-rows", "No.0")  # The list of earlier stays comes with a later status.
    demand("Tab moves through the other stay and its changes", tab_round(page, 4) == ["TR", "day-rename", "day-times", "day-discard"])
    page.press(Keys.ENTER)
    page.wait_for_text("discard-text", "Discard the running occupation at No.5, 6 min")
    page.demand_readable("the question")
    page.shot("discard-1366")
    page.press(Keys.ENTER)
    time.sleep(0.3)
    demand("Enter on the question keeps the occupation, because the first button is the harmless one",
           len(daemon.posts) == count and page.text("discard-text") == "")
    page.press(Keys.ENTER)
    page.wait_for_text("discard-text", "Discard the running")
    page.press(Keys.ESCAPE)
    page.wait_for("Escape keeps the occupation", lambda: page.text("discard-text") == "")
    page.press(Keys.ENTER, Keys.TAB, Keys.ENTER)
    demand("the second button discards the occupation that the question named",
           last_post(daemon, page, "/api/occupation/discard") == {**running, "site": "No.5"})

    page.press_with_shift(Keys.TAB, Keys.TAB)
    page.press(Keys.ENTER)
    page.wait_for_text("rename-text", "Choose the correct site for No.5 (stay 1), running since")
    page.demand_readable("the new name")
    page.shot("rename-1366")
    daemon.refusal = "the stay is at No.6, not at No.5"
    page.press("No.7", Keys.TAB, "wrong button", Keys.TAB, Keys.TAB, Keys.ENTER)
    page.wait_for_text("rename-error", "Not done: the stay is at No.6, not at No.5")
    page.demand_readable("a refused order")
    page.shot("refused-1366")
    demand("a refused order leaves its dialog open, with the texts", page.find("#rename-reason").get_attribute("value") == "wrong button"
           and page.find("#rename-site").get_attribute("value") == "No.7")
    daemon.refusal = None
    page.press(Keys.ENTER)
    demand("key, correct site and reason are sent", last_post(daemon, page, "/api/occupation/rename")
           == {**running, "site": "No.7", "reason": "wrong button"})

    page.press(Keys.TAB, Keys.ENTER)
    page.wait_for_text("times-text", "Correct the times of No.5 (stay 1), running since")
    page.demand_readable("the new times")
    page.press("noon", Keys.ENTER)
    page.wait_for_text("times-error", "noon is no time of day")
    demand("a text that is no time is not sent", daemon.posts[-1][0] == "/api/occupation/rename")
    page.press(Keys.ENTER, Keys.DELETE)
    page.run("document.getElementById('times-from').value = ''")
    start = daemon.status["occupation"]["start"]
    second = "00" if start[17:19] != "00" else "01"  # A time that is as before would not be sent.
    page.press(earlier := start[11:17] + second, Keys.ENTER)
    order = last_post(daemon, page, "/api/occupation/retime")
    demand(f"the start is sent with its date: {order}",
           order == {**running, "site": "No.5", "from": start[:17] + second + ".000Z"}
           and earlier in order["from"])

    page.run("document.getElementById('day-rename').focus()")
    daemon.sites = sites(15)
    page.wait_for("the list of sites is read again", lambda: "No.14" in page.run(
        "return document.getElementById('rename-site').textContent"))
    time.sleep(0.2)
    demand("a list that is read again without a change keeps the focus",
           page.run("return document.activeElement.id") == "day-rename")

    page.open_details(identifier="more")
    page.find("#note").send_keys("rain began", Keys.ENTER)
    demand("Enter in the note field sends the note", last_post(daemon, page, "/api/note") == {**STAY, "note": "rain began"})
    page.wait_for("the note field is empty after sending", lambda: page.find("#note").get_attribute("value") == "")

    page.open_details()
    page.find("#trace-span input[value='60']").send_keys(Keys.ARROW_RIGHT)
    page.run("document.getElementById('chart-x').scrollIntoView()")
    page.wait_for_text("caption-x", "x: median")
    demand("the arrow keys choose the time span",
           page.run("return document.querySelector('[name=trace-span]:checked').value") == "3600")

    renew_token(daemon, page)

"""The page in Japanese: the browser's language decides, a button changes it, nothing stays English, and everything still fits."""

import re
import time

from browser import LAPTOP, Browser
from gloves import SIZES, demand_for_gloves, prefer
from made_up import finished, occupation, reading, sites, stay, survey, tilt, verdict
from programs import demand
from stub_daemon import StubDaemon

# Words that are the same in Japanese: units, names, codes and what the stub says of its device.
SAME = set("mGal min UTC MB GB Hz ppm API English sync JavaScript a351 a351d stub usb dev serial stable sample day pillar Sato Stop the "
           "ctl".split())

# Returns the visible texts that have English words.
WORDS = """
const found = [];
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (element.checkVisibility() && !element.closest("noscript, svg, .foreign, select, canvas, .dygraph-label, [lang=en] > *"))
        found.push(walker.currentNode.data.trim());
}
return found;
"""


def english_words(browser):
    found = set()
    for text in browser.run(WORDS):
        found |= set(re.findall(r"(?<![A-Za-z0-9/_.])[A-Za-z]{3,}(?![A-Za-z0-9/_.])", text)) - SAME
    return found


def demand_japanese(browser, name):
    words = english_words(browser)
    demand(f"{name}: nothing is in English {words}", not words)


with Browser(language="ja,en") as page:
    daemon = StubDaemon()
    daemon.sites = sites()
    daemon.occupations = [finished(f"No.{i}", hours_ago=4 - i) for i in range(3)]
    daemon.status["verdict"] = {**verdict("settling"), "time_left_s": 184.0}
    daemon.status["occupation"] = {**occupation(), "operator": "", "note": ""}
    daemon.status["tilt"] = tilt(0.4, 0.3)
    time.sleep(0.3)
    page.driver.get(f"http://127.0.0.1:{daemon.port}/#field")
    page.wait_for_text("run-judgement", "あと約4分10秒")
    demand("the document says its language", page.run("return document.documentElement.lang") == "ja")
    demand("the button offers the other language", page.text("language-switch") == "English")
    demand_japanese(page, "settling")
    demand_for_gloves(page, "settling-ja", "run-value", ["verdict-word", "run-time", "run-plan", "run-value", "run-judgement", "stop", "setup", "tools"])
    daemon.status["verdict"] = verdict("stable", 430)
    daemon.status["occupation"] = {**occupation(whole=reading(0.82, 0.0, True)), "operator": "", "note": ""}
    daemon.survey = survey([stay("No.0"), stay("No.5", is_running=True)])
    page.wait_for_text("run-gravity", "現時点の重力値", seconds=10)
    demand_for_gloves(page, "good-enough-ja", "run-gravity", ["verdict-word", "run-time", "run-plan", "run-gravity", "run-judgement", "stop", "setup", "tools"])
    daemon.status["verdict"] = verdict("disturbed", 12)
    advice = [["lower the +{} side by {:.1f}'", ["x"], ["2.4"]]]
    daemon.status["occupation"] = {**occupation(moved={"utc": "2026-03-01T01:43:20.000Z", "is_at_start": False}), "operator": "", "note": ""}
    daemon.status["tilt"] = {**tilt(2.4, -0.6, ["lower the +x side by 2.4'"]), "advice_parts": [advice]}
    page.wait_for_text("moved-text", "本体が動きました")
    page.wait_for_text("level-advice", "+x 側を 2.4′ 下げる")
    demand_japanese(page, "moved")
    demand_for_gloves(page, "moved-ja", "run-gravity", ["verdict-word", "stop"])
    page.click("#stop")
    page.wait_for_text("confirm-stop-text", "終了しますか")
    demand_for_gloves(page, "stop-ja", None, ["confirm-stop-yes", "confirm-stop-no"])
    page.click("#confirm-stop-no")
    page.click("#help-open")
    demand_japanese(page, "help")
    page.shot("help-ja")
    page.click("#help-close")
    for state in ("no data", "warming up"):
        daemon.status["verdict"] = {**verdict(state), "reasons": []}
        page.wait_for(f"{state} is shown", lambda: page.find("#verdict").get_attribute("data-state") == state)
        demand_japanese(page, state)
    page.click("#view-switch")
    page.wait_for_text("health-rows", "恒温槽")
    daemon.status["occupation"] = None
    page.wait_for("no stay runs", lambda: page.text("start") == "開始")
    time.sleep(1.0)
    demand_japanese(page, "the full page")
    for scheme in ("light", "dark"):
        prefer(page, scheme)
        for size in SIZES:
            page.resize(size)
            page.demand_readable(f"the full page in Japanese, {scheme}, at {size[0]} px")
            time.sleep(0.5)
            page.shot(f"page-ja-{scheme}-{size[0]}", is_whole=True)
    page.resize(LAPTOP)
    page.click("#language-switch")
    page.wait_for_text("verdict-advice", "Wait")
    demand("the button leads back to English, and is remembered", page.run("return document.documentElement.lang") == "en")
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    demand("the choice is remembered", page.text("language-switch") == "日本語")

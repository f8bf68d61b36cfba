"""The page in Japanese: the browser's language decides, a button changes it, nothing stays English, and everything still fits."""

import re
import time

from browser import LAPTOP, Browser
from gloves import SIZES, demand_for_gloves, prefer
from made_up import MOVED, SIGNALS, finished, gravity, no_stay, occupation, signal, sites, tilt
from programs import demand
from stub_daemon import StubDaemon

# Words that are the same in Japanese: units, names, codes and what the stub says of its device.
SAME = set("mGal min UTC MB GB Hz ppm API English sync JavaScript a351 a351d stub usb dev serial stable sample day pillar Sato Stop the "
           "ctl".split())

ADVICE = [["lower the +{} side by {:.1f}'", ["x"], ["2.4"]]]
MAIN = ["signal-word", "signal-sentence", "signal-buttons", "run-value"]

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
    daemon.status["signal"] = signal("keep_off")
    daemon.status["occupation"] = {**occupation(), "operator": "", "note": ""}
    time.sleep(0.3)
    page.open(daemon.port)
    page.wait_for_text("signal-word", "触れない")
    demand("the document says its language", page.run("return document.documentElement.lang") == "ja")
    demand("the button offers the other language", page.text("language-switch") == "English")
    for word in SIGNALS:
        daemon.status["signal"] = signal(word)
        daemon.status["occupation"] = {**occupation(gravity=gravity(), moved=MOVED if word == "look" else None), "operator": "", "note": ""}
        daemon.status["tilt"] = {**tilt(2.4, -0.6, ["lower the +x side by 2.4'"]), "advice_parts": [ADVICE]} if word == "lift" else None
        page.wait_for(f"{word} is shown", lambda: page.find("#signal").get_attribute("data-word") == word)  # noqa: B023
        demand_japanese(page, word)
        demand_for_gloves(page, f"{word}-ja", "run-value", MAIN)
    page.wait_for_text("signal-sentence", "01:43:20")
    page.click("#stop")
    page.wait_for_text("confirm-stop-text", "終了しますか")
    demand_for_gloves(page, "stop-ja", None, ["confirm-stop-yes", "confirm-stop-no"])
    page.click("#confirm-stop-no")
    page.click("#help-open")
    demand_japanese(page, "help")
    page.shot("help-ja")
    page.click("#help-close")
    daemon.status["occupation"], daemon.status["signal"] = None, no_stay()
    page.wait_for("no stay runs", lambda: page.text("start") == "開始")
    page.open_details()
    page.open_details(identifier="more")
    page.click("#day-rows tr")
    page.wait_for_text("health-rows", "恒温槽")
    time.sleep(1.0)
    demand_japanese(page, "everything unfolded")
    for scheme in ("light", "dark"):
        prefer(page, scheme)
        for size in SIZES:
            page.resize(size)
            page.demand_readable(f"the page in Japanese, {scheme}, at {size[0]} px")
            page.shot(f"page-ja-{scheme}-{size[0]}", is_whole=True)
    page.resize(LAPTOP)
    page.click("#language-switch")
    page.wait_for_text("signal-word", "NO STAY RUNS")
    demand("the button leads back to English", page.run("return document.documentElement.lang") == "en")
    page.open(daemon.port)
    page.wait_for_text("clock", "UTC")
    demand("the choice is remembered", page.text("language-switch") == "日本語")

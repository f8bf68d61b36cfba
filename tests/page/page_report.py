"""The corrector's report fits into a laptop's window without a cut table, and into a phone's; its contents lead to its sections.

The card for the field is one page A5 in each language, with the signal's words of the page."""

import base64
import functools
import http.server
import shutil
import threading

from browser import LAPTOP, PHONE, Browser
from programs import BIN, TOP, Scratch, demand, run

# Returns [text, px] of elements that end right of the window, and of tables whose place is narrower than they are.
CUT = """
const cut = [];
for (const element of document.querySelectorAll("body *:not(svg *)")) {
    const { right } = element.getBoundingClientRect();
    const place = element.parentElement;
    const hidden = element.tagName === "TABLE" ? place.scrollWidth - place.clientWidth : 0;
    if (right > innerWidth + 0.5 || hidden > 0) cut.push([element.tagName, element.textContent.trim().slice(0, 40), right, hidden]);
}
return cut;
"""

# Returns the links of the contents that do not lead to a heading with the same text.
ASTRAY = """
return Array.from(document.querySelectorAll("nav a"))
    .filter((link) => document.getElementById(link.hash.slice(1))?.textContent !== link.textContent)
    .map((link) => link.textContent);
"""


# Returns the words of the signal on the card, in both languages.
SIGNAL = """
return Array.from(document.querySelectorAll("section"))
    .map((page) => Array.from(page.querySelector("table").rows, (row) => row.cells[0].textContent.trim()));
"""


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def serve(folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(QuietHandler, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return server.server_address[1]


def check(page, name):
    page.resize(LAPTOP)
    cut = page.run(CUT)
    height = page.run("return document.documentElement.scrollHeight")
    demand(f"{name}: nothing is cut at {LAPTOP[0]} px, {height} px high {cut[:3] if cut else ''}", not cut)
    page.demand_readable(f"{name} at {LAPTOP[0]} px")
    astray = page.run(ASTRAY)
    demand(f"{name}: each line of the contents leads to its section {astray}", not astray)
    page.shot(f"{name}-{LAPTOP[0]}", is_whole=True)
    page.resize(PHONE)
    page.demand_readable(f"{name} at {PHONE[0]} px")
    page.shot(f"{name}-{PHONE[0]}", is_whole=True)


def check_card(page, folder):
    printed = page.driver.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    (folder / "card.pdf").write_bytes(base64.b64decode(printed["data"]))
    said = run("pdfinfo", folder / "card.pdf").stdout
    demand(f"the card is one page A5 in each language: {said[-200:]}", "(A5)" in said and "Pages:           2" in said)
    catalogue = (TOP / "protocol/text/ja.po").read_text()
    words = page.run(SIGNAL)
    demand(f"both pages have the {len(words[0])} words of the signal", len(words[0]) == len(words[1]) == 6)
    for english, japanese in zip(*words):
        demand(f"{english} and {japanese} are the words of the page", f'msgid "{english}"\nmsgstr "{japanese}"\n' in catalogue)


with Scratch() as scratch, Browser(allowed_errors=["favicon.ico"]) as browser:
    run(BIN / "a351-sim", "survey", "--scenario", "tsukuba", "--seed", 3, "--out", scratch / "day")
    text = (scratch / "day" / "survey.toml").read_text()
    for name in ("monday", "tuesday"):
        (scratch / "day" / f"{name}.toml").write_text(text.replace('name = "', f'name = "{name} '))
    run(BIN / "a351-correct", "survey", "day/monday.toml", "day/tuesday.toml", "--out", "out", cwd=scratch)
    folder = next((scratch / "out").glob("monday*"))
    shutil.copy(folder / "report.html", scratch / "out" / "report.html")
    port = serve(scratch / "out")
    for name in ("report", "joint"):
        browser.driver.get(f"http://127.0.0.1:{port}/{name}.html")
        check(browser, name)
    shutil.copy(TOP / "daemon/field-card.html", scratch / "out")
    browser.driver.get(f"http://127.0.0.1:{port}/field-card.html")
    check_card(browser, scratch)

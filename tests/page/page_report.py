"""The corrector's report fits into a laptop's window without a cut table, and into a phone's; its contents lead to its sections."""

import functools
import http.server
import shutil
import threading

from browser import LAPTOP, PHONE, Browser
from programs import BIN, Scratch, demand, run

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

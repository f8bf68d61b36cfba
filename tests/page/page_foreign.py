"""A page of another origin in the same browser, and one that has rebound its name to this host, get nothing from the
daemon and change nothing; its own page may do both."""

import http.server
import threading

from browser import Browser
from emulated_session import Session
from programs import Scratch, demand

ATTACKER = "attacker.example"

# Resolves to "open" or "closed".
SOCKET = """
const done = arguments[arguments.length - 1];
const socket = new WebSocket(arguments[0]);
socket.onmessage = () => { done("open"); socket.close(); };
socket.onclose = () => done("closed");
"""

# Resolves to the status, "opaque" (sent, nothing readable) or "blocked".
FETCH = """
const done = arguments[arguments.length - 1];
fetch(arguments[0], arguments[1]).then((reply) => done(reply.type === "opaque" ? "opaque" : reply.status),
                                       () => done("blocked"));
"""

# Resolves to "loaded" or "refused".
ELEMENT = """
const done = arguments[arguments.length - 1];
const element = document.createElement(arguments[1]);
element.onload = () => done("loaded");
element.onerror = () => done("refused");
element.src = arguments[0];
document.body.append(element);
"""

FORM = """
document.body.innerHTML = `<form method="post" enctype="text/plain" action="${arguments[0]}">
    <input name='{"site": "No.1", "note": "' value='"}'></form>`;
document.forms[0].submit();
"""

START = '{"site": "No.1"}'


class Empty(http.server.BaseHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def do_GET(self):
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<!doctype html><title>attacker</title><link rel=icon href='data:,'><body>")


def wait_script(browser, script, *arguments):
    return browser.driver.execute_async_script(script, *arguments)


def post(content_type, **options):
    return {"method": "POST", "body": START, "headers": {"Content-Type": content_type}, **options}


def nothing_changed(session, claim):
    status = session.status()
    demand(f"{claim}: no occupation has come of it", status["occupation"] is None)


def attack(session, browser, name):
    """From the page that is open now, of another origin."""
    home = f"127.0.0.1:{session.port}"
    demand(f"{name}: the live stream is refused", wait_script(browser, SOCKET, f"ws://{home}/live") == "closed")
    demand(f"{name}: by the daemon itself, with 403", any("code: 403" in message for message in browser.console()))
    start = f"http://{home}/api/occupation/start"
    for content_type in ("application/json", "text/plain"):
        came = wait_script(browser, FETCH, start, post(content_type))
        demand(f"{name}: an order as {content_type} is {came}", came == "blocked")
    came = wait_script(browser, FETCH, start, post("text/plain", mode="no-cors"))
    demand(f"{name}: an order without waiting for leave is {came}", came in ("opaque", "blocked"))
    nothing_changed(session, name)
    for path in ("status", "token", "occupations"):
        came = wait_script(browser, FETCH, f"http://{home}/api/{path}", {})
        demand(f"{name}: reading {path} is {came}", came == "blocked")
    for path in ("api/token", "page.js"):
        came = wait_script(browser, ELEMENT, f"http://{home}/{path}", "script")
        demand(f"{name}: {path} as a script is {came}", came == "refused")
    wait_script(browser, ELEMENT, f"http://{home}/", "iframe")
    shown = browser.run("const f = document.querySelector('iframe');"
                        "try { return f.contentDocument ? 'blank' : 'other'; } catch { return 'other'; }")
    refused = any("frame" in message.lower() and ("refused" in message.lower() or "violates" in message.lower())
                  for message in browser.console())
    demand(f"{name}: the page is not put into a frame ({shown})", refused)
    browser.run(FORM, start)
    browser.wait_for(f"{name}: a form that posts an order is answered with a refusal",
                     lambda: "error" in browser.run("return document.body.innerText"))
    nothing_changed(session, name)


def rebind(session, browser):
    browser.driver.get(f"http://{ATTACKER}:{session.port}/")
    said = browser.run("return document.body.innerText")
    demand(f"a name rebound to this host is told: {said.strip()}", "Host is not a name of this daemon" in said)
    came = wait_script(browser, FETCH, f"http://{ATTACKER}:{session.port}/api/token", {})
    demand(f"it gets no token: {came}", came == 421)
    socket = wait_script(browser, SOCKET, f"ws://{ATTACKER}:{session.port}/live")
    demand("it gets no stream", socket == "closed" and any("code: 421" in message for message in browser.console()))
    start = f"http://{ATTACKER}:{session.port}/api/occupation/start"
    came = wait_script(browser, FETCH, start, post("application/json"))
    demand(f"its order is refused: {came}", came == 421)
    nothing_changed(session, "rebound")


def be_at_home(session, browser):
    """The same requests from the daemon's own page go through: what was refused above was so for its origin."""
    browser.open(session.port)
    browser.wait_for_text("caption-x", "mean")
    home = f"127.0.0.1:{session.port}"
    demand("its own page has the stream", wait_script(browser, SOCKET, f"ws://{home}/live") == "open")
    token = browser.run("return document.querySelector('meta[name=a351-token]').content")
    start = f"http://{home}/api/occupation/start"
    demand("an order without the token is refused there too",
           wait_script(browser, FETCH, start, post("application/json")) == 403)
    headers = {"Content-Type": "application/json", "X-A351-Token": token}
    demand("with it, it is taken", wait_script(browser, FETCH, start, {**post(""), "headers": headers}) == 200)
    browser.wait_for_text("run-site", "No.1")


EXPECTED = [ATTACKER, "WebSocket connection to", "Failed to load resource", "CORS policy", "frame", "ERR_BLOCKED"]

with Scratch() as scratch, Browser(allowed_errors=EXPECTED, may_ask={ATTACKER},
                                   rules=f"MAP {ATTACKER} 127.0.0.1, MAP * ~NOTFOUND, EXCLUDE 127.0.0.1") as page:
    daemon = Session(scratch, speed=1)
    daemon.wait_for_frames(50)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Empty)
    server.daemon_threads = True
    threading.Thread(target=server.serve_forever, daemon=True).start()
    page.driver.set_script_timeout(10)
    for host in ("127.0.0.1", ATTACKER):
        page.driver.get(f"http://{host}:{server.server_address[1]}/")
        attack(daemon, page, host)
    rebind(daemon, page)
    be_at_home(daemon, page)

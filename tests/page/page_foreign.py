"""Pages of other origins in the same browser, also one with DNS rebinding to this host, can neither read nor change anything.

The daemon's own page can do both.
"""

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
    demand(f"{claim}: no occupation was started", status["occupation"] is None)


def attack(session, browser, name):
    """Tries to read and change from the page of another origin that is open now."""
    home = f"127.0.0.1:{session.port}"
    demand(f"{name}: the live stream is refused", wait_script(browser, SOCKET, f"ws://{home}/live") == "closed")
    demand(f"{name}: the daemon itself refuses the stream with 403",
           any("code: 403" in message for message in browser.console()))
    start = f"http://{home}/api/occupation/start"
    for content_type in ("application/json", "text/plain"):
        came = wait_script(browser, FETCH, start, post(content_type))
        demand(f"{name}: an order as {content_type} is {came}, must be blocked", came == "blocked")
    came = wait_script(browser, FETCH, start, post("text/plain", mode="no-cors"))
    demand(f"{name}: an order in the mode no-cors is {came}", came in ("opaque", "blocked"))
    nothing_changed(session, name)
    for path in ("status", "token", "occupations"):
        came = wait_script(browser, FETCH, f"http://{home}/api/{path}", {})
        demand(f"{name}: reading {path} is {came}, must be blocked", came == "blocked")
    for path in ("api/token", "page.js"):
        came = wait_script(browser, ELEMENT, f"http://{home}/{path}", "script")
        demand(f"{name}: {path} as a script is {came}, must be refused", came == "refused")
    wait_script(browser, ELEMENT, f"http://{home}/", "iframe")
    shown = browser.run("const f = document.querySelector('iframe');"
                        "try { return f.contentDocument ? 'blank' : 'other'; } catch { return 'other'; }")
    refused = any("frame" in message.lower() and ("refused" in message.lower() or "violates" in message.lower())
                  for message in browser.console())
    demand(f"{name}: the page cannot be shown in a frame ({shown})", refused)
    browser.run(FORM, start)
    browser.wait_for(f"{name}: an order posted by a form is refused",
                     lambda: "error" in browser.run("return document.body.innerText"))
    nothing_changed(session, name)


def rebind(session, browser):
    browser.driver.get(f"http://{ATTACKER}:{session.port}/")
    said = browser.run("return document.body.innerText")
    demand(f"a request with a rebound name is refused: {said.strip()}", "Host is not a name of this daemon" in said)
    came = wait_script(browser, FETCH, f"http://{ATTACKER}:{session.port}/api/token", {})
    demand(f"the rebound name gets no token: status {came}", came == 421)
    socket = wait_script(browser, SOCKET, f"ws://{ATTACKER}:{session.port}/live")
    demand("the rebound name gets no stream",
           socket == "closed" and any("code: 421" in message for message in browser.console()))
    start = f"http://{ATTACKER}:{session.port}/api/occupation/start"
    came = wait_script(browser, FETCH, start, post("application/json"))
    demand(f"an order to the rebound name is refused: status {came}", came == 421)
    nothing_changed(session, "rebound")


def be_at_home(session, browser):
    """Sends the same requests from the daemon's own page; they must succeed, so the origin was the reason of the refusals."""
    browser.open(session.port)
    browser.wait_for("samples are shown", lambda: browser.run("return document.getElementById('trace-end').textContent") != "")
    home = f"127.0.0.1:{session.port}"
    demand("the daemon's own page gets the stream", wait_script(browser, SOCKET, f"ws://{home}/live") == "open")
    token = browser.run("return document.querySelector('meta[name=a351-token]').content")
    start = f"http://{home}/api/occupation/start"
    demand("the own page's order without the token is refused",
           wait_script(browser, FETCH, start, post("application/json")) == 403)
    headers = {"Content-Type": "application/json", "X-A351-Token": token}
    demand("the own page's order with the token is accepted",
           wait_script(browser, FETCH, start, {**post(""), "headers": headers}) == 200)
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

"""`a351ctl phone`: the code of the terminal opens the page on another device, with the token, which is neither sent in an address nor logged.

The test runs in a network of its own, with one address that is not loopback.
"""

import atexit
import json
import os
import re
import shutil
import subprocess
import sys

from browser import Browser
from emulated_session import Session, wait_for
from programs import BIN, Scratch, answer, daemon_config, demand, run, skip, unused_port

ADDRESS = "192.0.2.7"  # Of a range for documentation, RFC 5737.
NETWORK = ('ip link set lo up && (ip link add field0 type dummy 2>/dev/null || ip link add field0 type bridge) && '
           f'ip addr add {ADDRESS}/24 dev field0 && ip link set field0 up && exec "$@"')
PIXELS = 4  # Per module, for the decoder.


def enter_own_network():
    """Starts this script again in a network of its own."""
    if os.environ.get("A351_OWN_NETWORK"):
        return
    command = ["unshare", "--net", *([] if os.geteuid() == 0 else ["--map-root-user"]), "sh", "-c", NETWORK, "sh"]
    if not shutil.which("unshare") or subprocess.run([*command, "true"], capture_output=True).returncode != 0:
        skip("this host allows no network of one's own (unshare, ip)")
    os.execvpe(command[0], [*command, sys.executable, *sys.argv], {**os.environ, "A351_OWN_NETWORK": "1"})


def modules(text):
    """Returns the rows of light modules of a code of half blocks."""
    rows = []
    for line in text.splitlines():
        rows.append([letter in "\u2580\u2588" for letter in line])
        rows.append([letter in "\u2584\u2588" for letter in line])
    return rows


def decoded(text, scratch):
    """Returns what a reader of codes sees (package zbar-tools)."""
    rows = modules(text)
    pixels = "\n".join(" ".join("0" if light else "1" for light in row for _ in range(PIXELS)) for row in rows for _ in range(PIXELS))
    (scratch / "code.pbm").write_text(f"P1\n{PIXELS * len(rows[0])} {PIXELS * len(rows)}\n{pixels}\n")
    return run("zbarimg", "--quiet", "--raw", scratch / "code.pbm").stdout.strip()


def show_code(session, scratch):
    shown = session.ctl("phone")
    code, url = shown.rstrip("\n").rsplit("\n", 1)
    token = answer(session.port, "/api/token")["token"]
    demand("the address has the token in its fragment", url == f"http://{ADDRESS}:{session.port}/#token={token}")
    if shutil.which("zbarimg"):
        demand("a reader of codes sees this address", decoded(code, scratch) == url)
    else:
        print("skipped: the code is not read, zbar-tools is missing")
    return url, token


def open_on_phone(session, browser, url, token):
    browser.resize((400, 800))
    browser.driver.get(url)
    browser.wait_for_text("start", "Start")
    demand("the token is gone from the address", browser.run("return location.href") == f"http://{ADDRESS}:{session.port}/")
    demand("the page itself does not have the token", browser.run("return document.querySelector('meta[name=a351-token]').content") == "")
    demand("over http this is no secure context", not browser.run("return isSecureContext"))
    browser.wait_for_text("awake", "set the screen timeout to 30 min by hand")
    for load in ("the first load", "a reload"):
        browser.find("#start-name").send_keys("No.5")
        browser.click("#start")
        browser.wait_for_text("run-site", "No.5")
        browser.click("#stop")
        browser.wait_for_text("confirm-stop-text", "Stop No.5")
        browser.click("#confirm-stop-yes")
        browser.wait_for_text("start", "Start")
        demand(f"after {load} orders are accepted", browser.text("token-form") == "")
        browser.driver.refresh()
        browser.wait_for_text("start", "Start")
    sent = [json.loads(entry["message"])["message"] for entry in browser.driver.get_log("performance")]
    addresses = [one["params"]["request"]["url"] for one in sent if one["method"] == "Network.requestWillBeSent"]
    demand(f"none of {len(addresses)} requests has the token in its address", addresses and not any(token in one for one in addresses))
    log = (session.scratch / "a351d.log").read_text()
    demand("the daemon's log does not have the token", token not in log)
    status = browser.driver.execute_async_script("fetch('/api/token').then((reply) => arguments[0](reply.status))")
    demand(f"another device cannot read the token: status {status}", status == 403)


enter_own_network()
with Scratch() as scratch:
    loopback = Session(scratch, speed=1)
    loopback.wait_for_frames(20)
    told = loopback.try_ctl("phone")
    demand(f"a daemon on loopback: status 1 and what to set: {told.stderr.strip()}",
           told.returncode == 1 and re.search(r'set listen = "0.0.0.0:\d+" in \[page\]', told.stderr) is not None)
with Scratch() as scratch, Browser(allowed_errors=["status of 403"], may_ask={ADDRESS}, rules=f"MAP * ~NOTFOUND, EXCLUDE {ADDRESS}") as page:
    open_session = Session(scratch, speed=1, host="0.0.0.0")
    open_session.wait_for_frames(20)
    told = open_session.try_ctl("phone", "192.0.2.8")
    demand(f"another address is refused: {told.stderr.strip()}", told.returncode == 1 and f"allowed: {ADDRESS}" in told.stderr)
    open_on_phone(open_session, page, *show_code(open_session, scratch))

TOKEN = "token-of-one-address"
with Scratch() as scratch:
    port = unused_port()
    (scratch / "a351d.toml").write_text(daemon_config(port, ADDRESS) + f'token = "{TOKEN}"\n')
    daemon = subprocess.Popen([BIN / "a351d", "--config", "a351d.toml"], cwd=scratch, stderr=subprocess.DEVNULL)
    atexit.register(daemon.kill)

    def phone(token, *words):
        return run(BIN / "a351ctl", "--url", f"http://{ADDRESS}:{port}", "phone", *words, check=False, env={"A351_TOKEN": token})

    wait_for("a daemon on one address answers", lambda: phone("").returncode == 1)
    said = phone("").stderr
    demand(f"without the token it says what to set: {said.strip()}", "set A351_TOKEN to the token of [page]" in said)
    wrong = phone("x" * 20)
    demand(f"a wrong token gives no code: {wrong.stderr.strip()}", wrong.returncode == 1 and wrong.stdout == "")
    demand("another address is refused", f"allowed: {ADDRESS}" in phone(TOKEN, "192.0.2.8").stderr)
    shown = phone(TOKEN)
    demand("with its token the code has the address of --url",
           shown.returncode == 0 and shown.stdout.endswith(f"\nhttp://{ADDRESS}:{port}/#token={TOKEN.replace('-', '%2D')}\n"))
    demand("no note was written", list((scratch / "data" / "events").glob("*.jsonl")) == [])

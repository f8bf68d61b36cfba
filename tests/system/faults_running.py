"""Faults that a running daemon must withstand, numbered as in fault-list.md.

A device that resets, reports errors or is replaced by another one, a second daemon, SIGHUP, and hostile clients of the page.
"""

import json
import os
import signal
import socket
import subprocess
import time

from emulated_session import Session, wait_for
from fault_table import FaultTable
from programs import IS_SANITIZED, Scratch, daemon_config, daemon_status, unused_port

SPEED = 2  # At this speed the silence that ends a session, 2 s of signal, is its minimum of 1 s of real time.
OWN, OTHER = "00000001", "87654321"
HARD_ERR = 0x00E0
SEATS = 32  # Connections that the daemon serves at the same time.
table = FaultTable()


def reasons(session):
    return "; ".join(session.status().get("reasons", []))


def is_sampling(session):
    return session.status().get("device", {}).get("state") == "sampling"


def seconds_until(claim, is_true):
    begin = time.monotonic()
    wait_for(claim, is_true)
    return (time.monotonic() - begin) * SPEED


def undisturbed(session, act):
    """Calls `act`; returns its result, and True if no sample was lost and no session began meanwhile."""
    before = session.settled()
    result = act()
    after = session.settled()
    keys = ("gaps", "samples_missing", "bytes_skipped", "sessions", "link_stalls", "queue_full")
    return result, all(before[key] == after[key] for key in keys)


def second_daemon(session, name, old, new):
    """Starts a second daemon and returns its exit status, its run time in s, and its log."""
    (session.scratch / f"{name}.toml").write_text(daemon_config(unused_port()).replace(old, new))
    begin = time.monotonic()
    with open(session.scratch / f"{name}.log", "w") as log:
        second = session.start_daemon(f"{name}.toml", stderr=log)
        try:
            status = second.wait(timeout=10)
        except subprocess.TimeoutExpired:
            second.kill()
            status = second.wait()
    return status, time.monotonic() - begin, (session.scratch / f"{name}.log").read_text()


def no(is_undisturbed):
    return "un" if is_undisturbed else ""


def reset(session):
    runs = len(session.emulated()["runs"])
    session.order("reset")
    noticed_s = seconds_until("the reset is noticed", lambda: not is_sampling(session))
    back_s = seconds_until("it samples again", lambda: is_sampling(session))
    sessions = session.settled()["sessions"]
    table.note(19, "device resets",
               f"noticed after {noticed_s:.1f} s, sampling {back_s:.1f} s later, session {sessions}",
               noticed_s < 3.0 and sessions == len(session.emulated()["runs"]) == runs + 1)


def error_flags(session):
    before = session.settled()
    session.order("error_flags count=7 diag_stat=32")
    wait_for("the error flags are sent", lambda: session.emulated()["faults"].get("error_flags", 0) == 7)
    after = session.settled()
    # The daemon logs them in one line or, if they fall into two seconds, in two lines a minute apart.
    told = f"more, {before['error_flags'] + 7} in total"
    wait_for("the error flags are logged",
             lambda: any("frames with error flags" in line and told in line
                         for line in (session.scratch / "a351d.log").read_text().splitlines()), seconds=90)
    flags, missing = (after[key] - before[key] for key in ("error_flags", "samples_missing"))
    table.note(24, "device sends error flags", f"{flags} of 7 counted and logged, {missing} samples missing",
               flags == 7 and missing == 0)


def failed_start_up():
    """A failed start-up test is shown until a later one is passed, also after a restart of the daemon."""
    def said(session):
        return "failed its start-up test" in reasons(session)

    def restart(session):
        session.daemon.terminate()
        session.daemon.wait(timeout=60)
        session.daemon = session.start_daemon()
        wait_for("it samples again", lambda: is_sampling(session))

    with Scratch() as scratch:
        session = Session(scratch, speed=SPEED)
        session.wait_for_frames(100)
        session.order(f"failing_tests diag_stat={HARD_ERR}")
        session.order("power_cycle")
        wait_for("the failed test is shown", lambda: said(session))
        wait_for("it samples nevertheless", lambda: is_sampling(session))
        time.sleep(3.0)
        level, shown = session.status()["level"], [said(session)]
        restart(session)  # The sensor keeps its power; the daemon repeats the test, which fails again.
        shown.append(said(session))
        session.order("failing_tests diag_stat=0")
        shown.append(said(session))
        restart(session)
        wait_for("the error is resolved", lambda: not said(session))
        wait_for("the passed test is in the event log", lambda: len(test_results(scratch)) == 2)
        session.daemon.terminate()
        session.daemon.wait(timeout=60)
        events = test_results(scratch)
        xml = (scratch / "data" / "metadata" / "station.xml").read_text()
    comments = xml.count("start-up test of the sensor: HARD_ERR")
    table.note(24, "device fails its start-up test",
               f"{level}, shown for 3 s, after a restart, and before the next test: {shown}; events {events}; "
               f"{comments} channels with a comment",
               level == "fault" and all(shown) and events == ["HARD_ERR", "passed"] and comments == 4)


def exchanged_unit():
    """Another sensor is attached during a stay, and the first one comes back."""
    with Scratch() as scratch:
        session = Session(scratch, speed=SPEED)
        session.wait_for_frames(100)
        session.ctl("start", "No.1")
        session.wait_for_frames(400)
        taken_s, stays = [], []
        for serial in (OTHER, OWN):
            session.order(f"other_unit serial_number={serial}")
            runs = len(session.emulated()["runs"])
            wait_for("the other sensor sends frames", lambda: len(session.emulated()["runs"]) > runs
                     or session.status()["device"]["serial_number"] == serial)
            taken_s.append(seconds_until("it is reported", lambda: f"{serial} after" in reasons(session)))
            stays.append((len(json.loads(session.ctl("list", "--json"))["occupations"]), session.status()["occupation"]))
        session.daemon.terminate()
        session.daemon.wait(timeout=60)
        changes = [event for event in logged(scratch) if event["type"] == "other_unit"]
        log = (scratch / "a351d.log").read_text()
    is_cut = stays == [(1, None)] * 2
    table.note(21, "another device during a stay, and the first again",
               f"reported {taken_s[0]:.1f} and {taken_s[1]:.1f} s of signal after its first frame (limit 10); the stay was "
               f"{'' if is_cut else 'not '}ended; events {[change['serial_number'] for change in changes]}",
               max(taken_s) < 10.0 and is_cut and [change["serial_number"] for change in changes] == [OTHER, OWN]
               and f"{OTHER} after {OWN}" in log)


def logged(scratch):
    """Returns the events of the log."""
    return [event for file in sorted((scratch / "data" / "events").glob("*.jsonl"))
            for event in map(json.loads, file.read_text().splitlines())]


def test_results(scratch):
    return [event["result"] for event in logged(scratch) if event["type"] == "start_up_test"]


def other_device(session):
    session.order(f"other_unit serial_number={OTHER}")
    wait_for("the other device is reported", lambda: OTHER in reasons(session))
    said, frames = reasons(session), session.status()["counters"]["frames"]
    time.sleep(2.0)
    taken = session.status()["counters"]["frames"] - frames
    session.order(f"other_unit serial_number={OWN}")
    wait_for("the configured device samples again", lambda: is_sampling(session))
    table.note(21, "another device plugged in",
               f"{said}; {taken} of its frames recorded; the configured device samples again",
               taken == 0 and f"expected {OWN}" in said)


def second_daemons(session):
    for name, old, new in (("port", 'root = "data"', 'root = "other"'),
                           ("data root", 'port = "sensor"', 'port = "none"'), ("port and data root", "", "")):
        (status, took_s, said), is_undisturbed = undisturbed(session, lambda: second_daemon(session, name, old, new))
        table.note(23, f"second daemon on the {name}", f"exit {status} after {took_s:.2f} s: {said.splitlines()[-1:]}; "
                   f"the first {no(is_undisturbed)}disturbed", status == 3 and is_undisturbed)


def hang_ups(session):
    config = session.scratch / "a351d.toml"
    config.write_text(config.read_text().replace("elevation_m = 400.0", "elevation_m = 1.0\nunknown = 1"))

    def signals():
        for _ in range(5):
            session.daemon.send_signal(signal.SIGHUP)
            time.sleep(0.1)
        wait_for("SIGHUP is logged", lambda: "SIGHUP" in (session.scratch / "a351d.log").read_text())
        return session.daemon.poll()

    ended, is_undisturbed = undisturbed(session, signals)
    table.note(30, "SIGHUP with a broken configuration", f"logged; {no(is_undisturbed)}disturbed",
               ended is None and is_undisturbed)


def connect(session):
    return socket.create_connection(("127.0.0.1", session.port), timeout=10)


def request(session, path="/api/status"):
    return (f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{session.port}\r\n\r\n").encode()


def answer(client):
    """Returns the HTTP status of the answer, or 0 if the connection was closed without one."""
    try:
        line = client.makefile("rb").readline()
    except OSError:
        return 0
    return int(line.split()[1]) if line.startswith(b"HTTP/") else 0


def many_tabs(session):
    def act():
        clients = [connect(session) for _ in range(100)]
        # The daemon accepts them before it answers this request, which takes one seat; later it could answer each one before it
        # accepts the next.
        wait_for("all connections are accepted", lambda: daemon_status(session.port) is not None)
        for client in clients:
            try:
                client.sendall(request(session))
            except OSError:
                pass
        answers = [answer(client) for client in clients]
        for client in clients:
            client.close()
        return answers

    answers, is_undisturbed = undisturbed(session, act)
    served, refused = answers.count(200), answers.count(503)
    wait_for("connections are accepted again", lambda: daemon_status(session.port) is not None)
    table.note(32, "100 connections at the same time",
               f"{served} served, {refused} answered with 503, {answers.count(0)} closed; "
               f"{no(is_undisturbed)}disturbed", served >= SEATS - 1 and refused + answers.count(0) > 0 and is_undisturbed)


def hostile_clients(session):
    """Runs for 12 s ten clients that send a byte a second, ten that ask and do not read, and a stream of nonsense."""
    text = request(session)

    def act():
        slow, deaf = [connect(session) for _ in range(10)], [connect(session) for _ in range(10)]
        for client in deaf:
            client.setblocking(False)
        for at in range(12):
            for client, part in [(one, text[at:at + 1]) for one in slow] + [(one, 200 * text) for one in deaf]:
                try:
                    client.sendall(part)
                except OSError:
                    pass  # The connection is closed, or its buffer is full.
            for junk in (os.urandom(3000), b"\r\n" * 100, b"GET / HTTP/9.9\r\n\r\n"):
                with connect(session) as client:
                    client.sendall(junk)
            time.sleep(1.0)
        cut = sum(is_closed(client) for client in slow)
        for client in slow + deaf:
            client.close()
        return cut

    memory_before = resident_mb(session.daemon.pid)
    cut, is_undisturbed = undisturbed(session, act)
    grown_mb = resident_mb(session.daemon.pid) - memory_before
    wait_for("the page answers", lambda: daemon_status(session.port) is not None)
    table.note(31, "slow, deaf and hostile clients",
               f"{cut} of 10 slow clients disconnected, memory {grown_mb:+.1f} MB (limit 8); "
               f"{no(is_undisturbed)}disturbed", cut == 10 and (grown_mb < 8 or IS_SANITIZED) and is_undisturbed)


def is_closed(client):
    client.setblocking(False)
    try:
        return client.recv(4096) == b""
    except BlockingIOError:
        return False
    except OSError:
        return True


def resident_mb(pid):
    with open(f"/proc/{pid}/status") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:")) / 1024


with Scratch() as scratch:
    session = Session(scratch, speed=SPEED, config=f'serial_number = "{OWN}"')
    session.wait_for_frames(200)
    for fault in (second_daemons, hang_ups, many_tabs, hostile_clients, error_flags, reset, other_device):
        fault(session)
    session.settled()  # The first frame of a session counts only after a second frame confirms it.
    report, counters = session.end()
    session.archive_is_true(missing=0)
failed_start_up()
exchanged_unit()
table.finish()

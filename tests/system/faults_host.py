"""Faults of the host, numbered as in fault-list.md.

The clock is set or slewed while the daemon runs (needs faketime), the host starts in 1970, sleeps or inserts a leap
second, and the log cannot be written.
"""

import datetime
import os
import shutil
import signal
import struct
import threading
import time

from emulated_session import INTACT, Session, gaps_of
from fault_table import FaultTable
from miniseed_headers import headers
from programs import BIN, IS_SANITIZED, TOOLS, Scratch, run, together

FAKETIME = shutil.which("faketime")
SLEW = 500e-6
BEFORE_S, AFTER_S = 8, 16  # Recording before and after the fault.  Without synchronisation a set clock is trusted after 60 s.
STEP_S = 0.050             # Change that the mapping to UTC takes for a clock step: host_clock_rules.hpp.
LARGEST_ERROR_S = 0.0045   # Largest time error of a live archive if no frame is sent late, as in three_days.py.
SLEEP_S = 34               # More than twice the counter's wrap of 16.384 s.
UNDER_WAY_S = 0.5
LEAP_AFTER_S = 30
TIME_INS, TIME_WAIT = 1, 4  # States that adjtimex returns before and after a leap second: <sys/timex.h>.
SCENARIO = '''base = "indoor"
name = "now"
[schedule]
start_utc = "START"
duration_h = 1.0
'''
table = FaultTable()
scratches = []


def scratch_directory():
    scratches.append(Scratch())
    return scratches[-1].__enter__()


def session_on_host(scratch, library, **environment):
    now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    (scratch / "now.toml").write_text(SCENARIO.replace("START", now))
    return Session(scratch, speed=1, scenario="now.toml", start=now, on_host_clock=True,
                   env={**os.environ, "LD_PRELOAD": str(library), **environment})


def session_with_clock(clock):
    """Starts a session on the host's clock changed by the file `clock`; the raw and boot clocks are not changed."""
    scratch = scratch_directory()
    (scratch / "clock").write_text(clock)
    library = run(FAKETIME, "-m", "-f", "+0", "printenv", "LD_PRELOAD").stdout.strip()
    return session_on_host(scratch, library, FAKETIME_TIMESTAMP_FILE=str(scratch / "clock"), FAKETIME_NO_CACHE="1",
                           FAKETIME_DONT_FAKE_MONOTONIC="1")


def set_clocks(scratch, slept_s=0.0, ahead_s=0.0, is_synchronised=True, state=0):
    """Writes the file that tests/support/host_clocks.cpp reads; it changes at one instant for all readers."""
    (scratch / "clocks.new").write_bytes(
        struct.pack("=4q", round(slept_s * 1e9), round(ahead_s * 1e9), is_synchronised, state))
    (scratch / "clocks.new").rename(scratch / "clocks")


def session_on_clocks(**clocks):
    scratch = scratch_directory()
    set_clocks(scratch, **clocks)
    return session_on_host(scratch, TOOLS / "libhost-clocks.so", A351_HOST_CLOCKS=str(scratch / "clocks"))


def errors_s(session, root):
    """Returns for each record of axis z the true start in s since the first one, and the error of its time stamp in s."""
    instants = [row[0] / 1e9 for row in session.rows() if row[8] == INTACT]
    found, at = [], 0
    for record in headers(sorted((root / "archive").rglob("*.BNZ.D.*"))):
        found.append((instants[at] - instants[0], record.start_us / 1e6 - instants[at]))
        at += record.samples
    return found if at == len(instants) else []


def largest_error_s(report):
    """Returns the limit for time errors in s.  It includes the emulator's own lateness, which the daemon cannot know."""
    return LARGEST_ERROR_S + report["steady_lateness_s"]


def values_are_true(session):
    return all(one["matched"] == one["truth"] > 0 and one["altered"] == one["duplicated"] == 0
               for one in session.counted().values())


def clocks_set():
    steps = {hours: session_with_clock("+0") for hours in (+1, -1)}
    slewed = session_with_clock(f"+0 x{1 + SLEW}")
    for session in (*steps.values(), slewed):
        session.wait_for_frames(50 * BEFORE_S)
    for hours, session in steps.items():
        (session.scratch / "clock").write_text(f"{3600 * hours:+d}")
    time.sleep(AFTER_S)
    for hours, session in steps.items():
        session.end()
        errors = errors_s(session, session.scratch / "data")
        largest_s = max((abs(error) for _, error in errors), default=9e9)
        run(BIN / "a351-correct", "retime", session.scratch / "data", "--out", session.scratch / "re-timed")
        last_s = (errors_s(session, session.scratch / "re-timed") or [(0.0, 0.0)])[-1][1]
        table.note(25, f"host clock set by {hours:+d} h", f"{len(errors)} records continue the old times within "
                   f"{1e3 * largest_s:.2f} ms; re-timed, the last is at {last_s:+.3f} s", largest_s < STEP_S
                   and abs(last_s - 3600 * hours) < STEP_S and values_are_true(session))
    report, _ = slewed.end()
    errors = errors_s(slewed, slewed.scratch / "data")
    followed = [error - SLEW * at for at, error in errors]
    spread_s = max(followed) - min(followed) if followed else 9e9
    ahead_s = errors[-1][1] if errors else 0.0
    table.note(26, "host clock slewed by 500 ppm", f"times ahead by {1e3 * ahead_s:.1f} ms at the end, following it within "
               f"{1e3 * spread_s:.2f} ms",
               ahead_s > 2 * LARGEST_ERROR_S and spread_s < largest_error_s(report) and values_are_true(slewed))


def start_in_1970():
    return session_on_clocks(ahead_s=-time.time(), is_synchronised=False)


def end_in_1970(session):
    session.wait_for_frames(50 * BEFORE_S)
    before = session.status()["counters"]["frames"]
    years = [path.name for path in (session.scratch / "data" / "archive").glob("*")]
    set_clocks(session.scratch)
    time.sleep(AFTER_S)
    report, _ = session.end()
    records = headers(sorted((session.scratch / "data" / "archive").rglob("*.BNZ.D.*")))
    withheld = len(session.truth()) - sum(record.samples for record in records)
    run(BIN / "a351-correct", "retime", session.scratch / "data", "--out", session.scratch / "re-timed")
    errors = errors_s(session, session.scratch / "re-timed")
    largest_s = max((abs(error) for _, error in errors), default=9e9)
    table.note(27, "host starts in 1970", f"archived before the clock was set: {years or 'nothing'}; {withheld} of "
               f"{withheld + sum(record.samples for record in records)} samples withheld; re-timed, all are within "
               f"{1e3 * largest_s:.2f} ms",
               years == [] and before <= withheld < before + 50 * 4
               and all(record.start_us > 1e15 for record in records) and largest_s < largest_error_s(report))


def fall_asleep(session):
    """Stops the raw clock and the daemon, as in a sleep of the host; frames that the sensor sends meanwhile are lost.

    @return  thread that wakes the host again and then has the length of the sleep in `slept_s`
    """
    session.wait_for_frames(50 * BEFORE_S)
    session.order(f"silence seconds={SLEEP_S + 2 * UNDER_WAY_S}")
    time.sleep(UNDER_WAY_S)  # Frames already sent are read before the sleep; none is sent during it.
    session.daemon.send_signal(signal.SIGSTOP)
    since = time.monotonic()

    def wake():
        alarm.slept_s = time.monotonic() - since
        set_clocks(session.scratch, slept_s=alarm.slept_s)
        session.daemon.send_signal(signal.SIGCONT)

    alarm = threading.Timer(SLEEP_S, wake)
    alarm.start()
    return alarm


def end_awake(session, alarm):
    alarm.join()
    slept_s = alarm.slept_s
    time.sleep(AFTER_S)
    report, counters = session.end()
    gaps, missing = gaps_of(session.truth())
    errors = errors_s(session, session.scratch / "data")
    run(BIN / "a351-correct", "retime", session.scratch / "data", "--out", session.scratch / "re-timed")
    retimed = errors_s(session, session.scratch / "re-timed")
    largest_s, largest_retimed_s = (max((abs(error) for _, error in found), default=9e9)
                                    for found in (errors, retimed))
    table.note(28, f"host sleeps for {slept_s:.1f} s", f"{counters['gaps']} gaps of {counters['samples_missing']}, truth "
               f"{gaps} of {missing}; {len(errors)} records within {1e3 * largest_s:.2f} ms; re-timed, {len(retimed)} "
               f"within {1e3 * largest_retimed_s:.2f} ms",
               (counters["gaps"], counters["samples_missing"]) == (gaps, missing) == (1, missing)
               and counters["sessions"] == 1
               and largest_s < largest_error_s(report) and largest_retimed_s < STEP_S)


def start_before_leap_second():
    """Returns the session, how far the clock of its host is ahead in s, and the real time at which it shows midnight."""
    midnight = (time.time() // 86400 + 1) * 86400
    ahead_s = midnight - LEAP_AFTER_S - time.time()
    return session_on_clocks(ahead_s=ahead_s, state=TIME_INS), ahead_s, midnight - ahead_s


def end_after_leap_second(session, ahead_s, midnight):
    time.sleep(max(0.0, midnight - time.time()))
    set_clocks(session.scratch, ahead_s=ahead_s - 1.0, state=TIME_WAIT)
    time.sleep(AFTER_S)
    report, _ = session.end()
    records = headers(sorted((session.scratch / "data" / "archive").rglob("*.BNZ.D.*")))
    errors = [error - ahead_s for _, error in errors_s(session, session.scratch / "data")] or [9e9]
    is_said = "a leap second is inserted" in (session.scratch / "a351d.log").read_text()
    table.note(29, "leap second inserted", f"{'announced' if is_said else 'not announced'} in the log; the first record is at "
               f"{errors[0]:+.4f} s of the old time, the last at {errors[-1]:+.4f} s; "
               f"{sum(record.is_time_questionable for record in records)} of {len(records)} are questionable",
               is_said and max(abs(errors[0]), abs(errors[-1] + 1.0)) < largest_error_s(report)
               and all(record.is_time_questionable for record in records) and values_are_true(session))


def start_with_lost_logs():
    reader, gone = os.pipe()
    os.close(reader)
    full = os.open("/dev/full", os.O_WRONLY)
    return {"on a full disk": Session(scratch_directory(), stderr=full),
            "to a reader that has ended": Session(scratch_directory(), stderr=gone)}


def logs_lost():
    sessions = start_with_lost_logs()
    for where, session in sessions.items():
        session.wait_for_frames(5000)
        report, counters = session.end()
        table.note(34, f"log {where}",
                   f"{counters['frames']} of {report['frames_sent']} frames, {counters['gaps']} gaps",
                   counters["frames"] == report["frames_sent"] and counters["gaps"] == 0 and values_are_true(session))


def clocks_changed():
    if FAKETIME and not IS_SANITIZED:
        clocks_set()
    else:
        print("skipped: #25 and #26, because faketime is not installed, or because a sanitizer must be the first preloaded "
              "library")


def clocks_of_host():
    if IS_SANITIZED:
        print("skipped: #27, #28 and #29, because a sanitizer must be the first preloaded library")
        return
    in_1970, sleeper, before_leap = start_in_1970(), session_on_clocks(), start_before_leap_second()
    alarm = fall_asleep(sleeper)
    end_in_1970(in_1970)
    end_after_leap_second(*before_leap)
    end_awake(sleeper, alarm)


together(clocks_of_host, clocks_changed, logs_lost)  # They wait most of their time.
for scratch in scratches:
    scratch.__exit__(None, None, None)
table.finish()

"""A nearly full disk: journal segments older than journal_keep_days are deleted, and the archive continues."""

import hashlib

import small_disk
from emulated_session import Session, wait_for
from programs import Scratch, demand, run

KEEPER_S = 60  # Interval in s at which the daemon looks for old segments.
LONG_AGO, LATER, NOW = "2024-03-01T00:00:00Z", "2024-06-01T00:00:00Z", "2024-09-01T00:00:00Z"
SCENARIO = """base = "indoor"
name = "month"
[schedule]
start_utc = "START"
duration_h = 1.0
"""


def begin(scratch, start, speed):
    (scratch / "month.toml").write_text(SCENARIO.replace("START", start))
    return Session(scratch, speed=speed, scenario="month.toml", start=start)


def record(session, frames):
    """Records until the emulator has sent so many frames; the daemon's own count includes replayed frames."""
    wait_for(f"{frames} frames", lambda: session.emulated()["frames_sent"] >= frames)
    session.settled()
    session.end()


def segments(scratch):
    return {file.name for file in (scratch / "data" / "journal").glob("*.a351j*")}


def checksums(scratch):
    return {file: hashlib.sha256(file.read_bytes()).hexdigest()
            for file in (scratch / "data" / "archive").rglob("*.D.*")}


small_disk.enter_own_mounts()
with Scratch() as scratch:
    data = scratch / "data"
    small_disk.mount(data)
    session = begin(scratch, LONG_AGO, 100)
    record(session, 30 * 60 * 50)
    oldest = segments(scratch)
    oldest_bytes = sum((data / "journal" / name).stat().st_size for name in oldest)
    session = begin(scratch, LATER, 20)
    record(session, 3000)
    middle = segments(scratch) - oldest
    archived = checksums(scratch)

    small_disk.fill(data / "filler", small_disk.RESERVE - oldest_bytes // 2)
    session = begin(scratch, NOW, 2)
    wait_for("the archive waits for space", lambda: any(
        reason.startswith("disk full") for reason in session.status().get("reasons", [])))
    wait_for("old segments are removed", lambda: session.status()["counters"]["journal_segments_removed"] > 0,
             seconds=2 * KEEPER_S)
    wait_for("the archive is written again", lambda: session.status()["archived"])
    removed = session.status()["counters"]["journal_segments_removed"]
    is_kept = middle <= segments(scratch) and not oldest & segments(scratch)
    session.end()
    is_untouched = checksums(scratch).items() >= archived.items()
    run("rm", *archived)  # Only the files of the last session remain.
    counted = session.counted().values()
    is_true = all(one["matched"] == one["truth"] for one in counted)
    demand(f"{removed} of {len(oldest)} segments that a later session's mark covers are removed", removed == len(oldest))
    demand("the segments without a later mark are kept", is_kept)
    demand(f"{len(archived)} day files are unchanged", is_untouched)
    demand("the archive continued without loss", is_true)
    run("umount", data)

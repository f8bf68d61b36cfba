"""The day is taken home as one file while the daemon records an emulated day.

Unpacked it must be what the data root has, sha256sum must accept it, and the corrector must give the same from it.  The recording
must not notice it.  After Ctrl-C no half file has the name; take_home_test.cpp has all else that can go wrong.
"""

import json
import signal
import subprocess
import time

from emulated_session import Session, told_at, wait_for
from programs import BIN, IS_SANITIZED, Scratch, contents, demand, rows, run, short_day, together

SPEED = 60 if IS_SANITIZED else 800
TOKEN = "a-token-that-nobody-else-may-see-0123456789"


def with_token(scratch):
    with open(scratch / "a351d.toml", "a") as config:  # It ends with the table [page].
        config.write(f'# token = "{TOKEN}"\ntoken = "{TOKEN}"\n')


def bundle(session, out, check=True):
    begin = time.monotonic()
    result = run(BIN / "a351ctl", "--url", session.url, "bundle", "--out", out, check=check)
    print(f"{result.stdout}{result.stderr}in {time.monotonic() - begin:.1f} s", flush=True)
    return result


def unpacked(file, into):
    """Unpacks a bundle and returns its folder."""
    into.mkdir()
    run("tar", "-xf", file, "-C", into)
    (folder,) = into.iterdir()
    run("sha256sum", "--check", "--strict", "--quiet", "SHA256SUMS", cwd=folder)
    listed = {line.split("  ")[1] for line in (folder / "SHA256SUMS").read_text().splitlines()}
    demand(f"sha256sum accepts each of the {len(listed)} files of {file.name}", contents(folder).keys() == listed | {"SHA256SUMS"})
    return folder


def interrupted(session, folder):
    """Interrupts a copy when its first megabyte is on the disk, and returns how it ended."""
    copies = []

    def grows():
        if not copies or copies[-1].poll() is not None:  # On a busy host the daemon may still be at two that have ended.
            copies.append(subprocess.Popen([BIN / "a351ctl", "--url", session.url, "bundle", "--out",
                                            folder / "day.tar"], stderr=subprocess.PIPE, text=True))
        return any(part.stat().st_size > 1_000_000 for part in folder.glob(".day.tar.*.part"))
    wait_for("a copy grows", grows, 60)
    copy = copies[-1]
    copy.send_signal(signal.SIGINT)
    _, stderr = copy.communicate(timeout=60)
    return subprocess.CompletedProcess(copy.args, copy.returncode, "", stderr)


with Scratch() as scratch:
    (scratch / "day.toml").write_text(short_day())
    session = Session(scratch, speed=SPEED, scenario=scratch / "day.toml", prepare_port=lambda _: with_token(scratch),
                      config='[survey]\nsites = "sites.csv"\n')
    wait_for("the daemon answers", lambda: session.status())
    stays = rows(scratch / "schedule.csv")
    for stay in stays:
        told_at(session, stay["start_utc"], "start", stay["site"])
        told_at(session, stay["end_utc"], "stop")
        if stay is stays[3]:
            (scratch / "stick").mkdir()
            frames = session.status()["counters"]["frames"]
            together(lambda: bundle(session, scratch / "one.tar"), lambda: bundle(session, scratch / "stick"))
            demand("meanwhile the daemon has recorded", session.status()["counters"]["frames"] > frames)
            (in_stick,) = (scratch / "stick").iterdir()
            demand(f"in a folder the copy gets the name of the day: {in_stick.name}",
                   in_stick.name.startswith("XX_A351_2017071") and in_stick.name.endswith("Z.tar"))
            for file in (scratch / "one.tar", in_stick):
                folder = unpacked(file, scratch / f"from-{file.parent.name}-{file.stem}")
                run(BIN / "a351-correct", "survey", folder)
                demand("the corrector takes the folder of a day that is not over",
                       len({row["site"] for row in rows(folder / "result" / "occupations.csv")}) >= 3)

    demand("the emulator sends the rest of its day and ends cleanly", session.sim.wait(timeout=1800) == 0)
    wait_for("the archive has everything", lambda: session.status()["archived"] == session.status()["received"], 60)
    session.archive_is_true(missing=0)
    data = scratch / "data"
    wait_for("the gravity so far has every stay", lambda: len(json.loads(session.ctl("survey", "--json"))["stays"]) == len(stays), 120)

    bundle(session, scratch / "day.tar")
    folder = unpacked(scratch / "day.tar", scratch / "home")
    for part in ("archive", "journal", "events", "metadata"):
        of_root, of_copy = contents(data / part), contents(folder / part)
        # Since then the daemon may have compressed a segment, and it has continued the newest one and begun others.
        of_root = {name: content for name, content in of_root.items() if part != "journal" or name <= max(of_copy)}
        differing = [name for name in of_root.keys() & of_copy.keys() if not of_root[name].startswith(of_copy[name])
                     or part != "journal" and len(of_root[name]) != len(of_copy[name])]
        demand(f"{part}: the copy has the {len(of_root)} files of the data root, bytes that differ: {differing}",
               differing == [] and {name.removesuffix(".zst") for name in of_root} == {name.removesuffix(".zst") for name in of_copy})
    demand("the token is nowhere in the copy", TOKEN.encode() not in (scratch / "day.tar").read_bytes())
    run(BIN / "a351d", "--config", folder / "a351d.toml", "--check-config")
    demand("the gravity so far is in it", len(json.loads((folder / "gravity-so-far.json").read_text())["stays"]) == len(stays))
    run(BIN / "a351-correct", "survey", folder)
    run(BIN / "a351-correct", "survey", data, "--sites", scratch / "sites.csv", "--out", scratch / "result")
    for name in ("stations.csv", "occupations.csv", "models.csv"):
        demand(f"the corrector's {name} is the same from folder and data root",
               (folder / "result" / name).read_bytes() == (scratch / "result" / name).read_bytes())

    target = scratch / "disk"
    target.mkdir()
    before = (scratch / "day.tar").read_bytes()[:512]  # The first header names the day.
    (target / "day.tar").write_bytes(before)
    result = interrupted(session, target)
    demand(f"Ctrl-C: exit status {result.returncode}, one line: {result.stderr.strip()}",
           result.returncode == 1 and result.stderr.count("\n") == 1 and "interrupted" in result.stderr)
    demand("nothing of the copy is left, and the file that was there is as before",
           [path.name for path in target.iterdir()] == ["day.tar"] and (target / "day.tar").read_bytes() == before)
    demand("the daemon still runs and answers", session.daemon.poll() is None and session.status() != {})
    session.daemon.kill()
    session.daemon.wait()
    result = bundle(session, target / "day.tar", check=False)
    demand("without a daemon the exit status is 3", result.returncode == 3 and "no daemon answers" in result.stderr)

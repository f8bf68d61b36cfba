"""Every command in the EXAMPLES of a program's manual pages runs as written and writes the files that it names; every file
shown there is accepted.

usage: manual_examples.py a351-correct | a351-sim | a351d

An example that ends in ` &` serves a link or an address until SIGTERM.  In the examples of a351ctl and of the HTTP interface
the key of a stay is replaced by that of the first stay, and the usual address by that of the daemon of this test.
"""

import atexit
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time

from programs import BIN, IS_SANITIZED, TOP, Scratch, daemon_config, daemon_status, demand, os, rows, run, short_day, unused_port

# Subcommands whose results the examples of other pages read.
FIRST = ("calibrate", "record", "export", "survey", "import")
LONGEST_START_S = 60
USUAL_ADDRESS = "http://127.0.0.1:8351"
KEY = r"\b\d{8}T\d{6}Z\b"
SPEED = 60 if IS_SANITIZED else 120
BEGIN, RECORDED = "2017-07-15T20:42:12Z", "2017-07-15T21:00:00Z"  # The examples of a351ctl go back 12 min.


def prepare_correct(scratch):
    """Makes the input files that the examples of a351-correct expect from the user."""
    (scratch / "short.toml").write_text(short_day())
    for scenario, root in (("short.toml", "data"), ("indoor", "night"), ("tilt-series", "tilt-series"), ("tumble", "tumble"),
                           ("placement", "placement")):
        run(BIN / "a351-sim", "survey", "--scenario", scenario, "--out", root, cwd=scratch)
    for table in ("sites.csv", "observations.csv"):
        shutil.copy(TOP / "tests" / "golden" / "tsukuba" / table, scratch)
    usgs = TOP / "tests" / "golden" / "usgs"
    for meter in ("B44", "B108"):
        shutil.copy(usgs / f"{meter}_2017-12-05.txt", scratch / f"{meter.lower()}.txt")
    run(BIN / "a351-correct", "import", "b108.txt", "--out", "imported", cwd=scratch)
    known = (scratch / "imported" / "sites.csv").read_text()
    for row in rows(usgs / "absolute.csv")[:4]:
        known = re.sub(f"^({row['site']},.*),,,$", rf"\1,{row['gravity_mgal']},{row['u_gravity_mgal']},", known, flags=re.M)
    (scratch / "known-sites.csv").write_text(known)
    (scratch / "plan.csv").write_text("site,start_utc,set_ups,minutes_each\n"
                                      "No.0,2026-05-01T00:00:00Z,1,12\nNo.1,2026-05-01T00:35:00Z,1,12\n")
    (scratch / "plan-sites.csv").write_text("site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\n"
                                            "No.0,140.1,36.2,530,979860.2\nNo.1,140.1,36.2,185,\n")
    survey = (TOP / "config" / "survey.toml").read_text()
    for name in ("day", "monday", "tuesday"):
        (scratch / f"{name}.toml").write_text(survey.replace('name = "tsukuba"', f'name = "{name}"'))


def prepare_sim(scratch):
    """Makes the input files that the examples of a351-sim expect."""
    shutil.copy(TOP / "config" / "faults" / "example.toml", scratch)
    run(BIN / "a351-sim", "survey", "--scenario", "indoor", "--out", "data", cwd=scratch)


def examples(page):
    """Returns the commands between .nf and .fi, each on one line, as a reader of the page sees them."""
    section = page.read_text().split("\n.SH EXAMPLES\n")[1].split("\n.SH ")[0]
    shown = "\n".join(re.findall(r"^\.nf\n(.*?)^\.fi$", section, re.M | re.S))
    shown = re.sub(r"\\([-e])", lambda escape: {"-": "-", "e": "\\"}[escape[1]], shown).replace("\\\n", " ")
    return [line for line in shown.splitlines() if line.strip()]


def outputs(command):
    """Returns the paths after --out, --output and --report and after `>`, relative to the directory of the command."""
    words = shlex.split(command)
    named = [after for word, after in zip(words, words[1:]) if word in ("--out", "--output", "--report")]
    return named + re.findall(r">(\S+)", command)


def wait_for(claim, is_true, process):
    since = time.monotonic()
    while not (holds := is_true()) and process.poll() is None and time.monotonic() - since < LONGEST_START_S:
        time.sleep(0.05)
    demand(f"{claim} after {time.monotonic() - since:.1f} s", holds and process.poll() is None)


def start(command, scratch, environment):
    """Starts an example that serves, and waits for its link or its address."""
    process = subprocess.Popen(["bash", "-c", "exec " + command.removesuffix(" &")], cwd=scratch, env=environment)
    atexit.register(process.kill)  # If a demand fails.
    words = shlex.split(command)
    if "--link" in words:
        link = scratch / words[words.index("--link") + 1]
        wait_for(f"{command}: serves its link", link.is_symlink, process)
    else:
        wait_for(f"{command}: answers", lambda: daemon_status(environment["A351_URL"].rsplit(":", 1)[1]), process)
    return process


def end(servers):
    for server in reversed(servers):
        server.send_signal(signal.SIGTERM)
        demand(f"{server.args[-1]}: ends after SIGTERM with status 0", server.wait(timeout=30) == 0)


def run_to_end(command, scratch, environment):
    written = [scratch / name for name in outputs(command)]
    for path in written:  # An earlier example may have written it.
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    result = subprocess.run(["bash", "-c", command], cwd=scratch, env=environment, capture_output=True, text=True)
    print(result.stderr, end="")
    # `a351ctl status` ends as a monitoring plugin: 1 is a warning, 2 a fault.
    allowed = (0, 1, 2) if command == "a351ctl status" else (0,)
    may_be_silent = written or command == "a351d --list-ports"  # A computer may have no port.
    demand(" ".join(command.split()), result.returncode in allowed and (may_be_silent or result.stdout))


def try_page(page, own, scratch, environment):
    commands = examples(page)
    demand(f"{page.name} has {len(commands)} examples, all of {' or '.join(own)}",
           commands and all(command.startswith(tuple(name + " " for name in own)) for command in commands))
    servers = []
    for command in commands:
        if command.endswith(" &"):
            servers.append(start(command, scratch, environment))
        else:
            run_to_end(command, scratch, environment)
    end(servers)
    for path in [scratch / name for command in commands for name in outputs(command)]:
        demand(f"  {page.name}: {path.name} is written", path.is_file() or (path.is_dir() and any(path.iterdir())))


def write_example(page, scratch):
    """Writes the file shown in the EXAMPLES of a page of section 5 under the name of the page, without `.5`."""
    (scratch / page.stem).write_text("\n".join(examples(page)) + "\n")


def try_files_of_sim(scratch):
    for name in ("a351-scenario.toml", "a351-faults.toml"):
        write_example(TOP / "sim" / "command" / f"{name}.5", scratch)
    run_to_end("a351-sim plan --scenario a351-scenario.toml --out example", scratch, ENVIRONMENT)
    end([start("a351-sim device --link example-link --faults a351-faults.toml &", scratch, ENVIRONMENT)])


def try_subcommands(program, folder, prepare):
    """Tries the page of each subcommand, then the overview."""
    commands_folder = TOP / folder / "command"
    pages = [commands_folder / f"{program}-{command}.1" for command in FIRST if program == "a351-correct"]
    pages += sorted(set(commands_folder.glob(f"{program}-*.1")) - set(pages)) + [TOP / folder / f"{program}.1"]
    with Scratch() as scratch:
        prepare(scratch)
        for page in pages:
            own = page.stem.replace(program + "-", program + " ")
            try_page(page, (own, "printf"), scratch, ENVIRONMENT)
        if program == "a351-sim":
            try_files_of_sim(scratch)


def try_changes(scratch, environment, port):
    """Tries the examples that change stays or ask the interface, while a daemon records on simulated time."""
    now = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
    clock = f"scaled:{SPEED}@{BEGIN},{now}"
    servers = [start(f"a351-sim device --link sensor --clock {clock} &", scratch, environment),
               start(f"a351d --config a351d.toml --clock {clock} &", scratch, environment)]
    wait_for(f"recorded from {BEGIN} to {RECORDED}",
             lambda: ((daemon_status(port) or {}).get("sample") or {}).get("utc", "") > RECORDED, servers[1])
    commands = examples(TOP / "daemon" / "ctl" / "a351ctl.1")
    demand(f"a351ctl.1 has {len(commands)} examples, all of a351ctl", all(command.startswith("a351ctl ") for command in commands))
    for command in commands:
        if re.search(KEY, command):
            command = re.sub(KEY, re.search(KEY, run(BIN / "a351ctl", "list", env=environment).stdout)[0], command)
        time.sleep(0.5)  # No operator sets up and stops between two samples.
        run_to_end(command, scratch, environment)
    for command in examples(TOP / "daemon" / "page" / "a351d-http.7"):
        if shutil.which("curl"):
            run_to_end(command.replace(USUAL_ADDRESS, environment["A351_URL"]), scratch, environment)
    end(servers)


def try_daemon():
    port = unused_port()
    environment = {**ENVIRONMENT, "A351_URL": f"http://127.0.0.1:{port}"}
    with Scratch() as scratch:
        write_example(TOP / "daemon" / "a351d.toml.5", scratch)
        run_to_end("a351d --config a351d.toml --check-config", scratch, environment)
        (scratch / "a351d.toml").write_text(daemon_config(port) + '[survey]\nsites = "sites.csv"\n')
        shutil.copy(TOP / "tests" / "golden" / "tsukuba" / "sites.csv", scratch)
        try_page(TOP / "daemon" / "a351d.1", ("a351d", "a351-sim device"), scratch, environment)
        shutil.rmtree(scratch / "data")
        try_changes(scratch, environment, port)


ENVIRONMENT = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"}
program = sys.argv[1]
if program == "a351d":
    try_daemon()
elif program == "a351-sim":
    try_subcommands(program, "sim", prepare_sim)
else:
    try_subcommands("a351-correct", "corrector", prepare_correct)

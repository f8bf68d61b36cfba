"""Several emulated boxes on this host, each with its daemon; each daemon lists all of them as [page] boxes."""

import datetime
import signal

from emulated_session import Session, wait_for
from programs import BIN, instant, one_site, run

SITES = "site,longitude_deg,latitude_deg,altitude_m,gravity_mgal\nNo.1,140.1,36.1,26,\nNo.2,140.2,36.2,30,\n"
SAMPLE_S = 0.02


def spread_s(instants):
    """Returns the time from the first to the last of several instants, in s."""
    times = [instant(one) for one in instants]
    return (max(times) - min(times)).total_seconds()


def last_sample(session):
    """Returns the time of the last sample, None if there is none."""
    return (session.status().get("sample") or {}).get("utc")


class Boxes:
    """Boxes on the host's clock, so that their times can be compared.  Their page is at http://127.0.0.1:PORT."""

    def __init__(self, scratch, count):
        start = datetime.datetime.now(datetime.timezone.utc) - datetime.timedelta(seconds=1)
        start = start.strftime("%Y-%m-%dT%H:%M:%SZ")
        scenario = one_site("quiet", start, 2)
        self.sessions = []
        for i in range(count):
            folder = scratch / f"box{i}"
            folder.mkdir()
            (folder / "boxes.toml").write_text(scenario)
            (folder / "sites.csv").write_text(SITES)
            self.sessions.append(Session(folder, speed=1, scenario="boxes.toml", start=start, on_host_clock=True,
                                         config='[survey]\nsites = "sites.csv"\n'))
        self.urls = [session.url for session in self.sessions]
        for session in self.sessions:
            with open(session.scratch / "a351d.toml", "a") as config:
                config.write(f"boxes = {self.urls}\n".replace("'", '"'))
            self.kill(session)
            self.revive(session)

    def kill(self, session):
        session.daemon.send_signal(signal.SIGKILL)
        session.daemon.wait(timeout=30)

    def revive(self, session):
        """Starts a daemon again and waits for two seconds of samples, because the first ones have no time yet."""
        since = datetime.datetime.now(datetime.timezone.utc) + datetime.timedelta(seconds=2)
        session.daemon = session.start_daemon()
        wait_for("the daemon has samples again", lambda: (last := last_sample(session)) and instant(last) > since)

    def ctl(self, *arguments):
        """Runs a351ctl for all boxes."""
        urls = [part for url in self.urls for part in ("--url", url)]
        return run(BIN / "a351ctl", *urls, *arguments, check=False)

    def end(self):
        for session in self.sessions:
            for process in (session.daemon, session.sim):
                process.send_signal(signal.SIGTERM)
                process.wait(timeout=30)

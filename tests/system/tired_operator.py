"""A simulated operator who makes the mistakes of mistakes.toml in a simulated survey day.

Most mistakes are made in the event log and in the list of sites.  If one is of the instrument, a step or knocks, the day is
simulated again with it, with the same seed.  Ten more sites are in the list, so that a name can be that of a benchmark that was
not visited.
"""

import csv
import datetime
import pathlib
import random
import shutil
import tomllib

from programs import BIN, correct_survey, events_of, instant, read_json, rms, rows, run, write_events

MISTAKES = tomllib.loads((pathlib.Path(__file__).resolve().parent / "mistakes.toml").read_text())["mistake"]
MORE_SITES = 10
LEAST_APART_MGAL = 5.0  # A slip between benchmarks that are nearer changes the table by less than its uncertainty.


def utc(time):
    return time.strftime("%Y-%m-%dT%H:%M:%S.%fZ")


class NoRoom(Exception):
    """No stay is left with which a mistake could be made."""


class Stay:
    """The events of a stay; start and stop are None if the operator forgot them."""

    def __init__(self, start, set_ups, stop):
        self.start, self.set_ups, self.stop = start, set_ups, stop
        self.true_start, self.true_stop, self.true_site = instant(start["utc"]), instant(stop["utc"]), start["site"]


class Day:
    """The log and the list of a day, in which mistakes are made."""

    def __init__(self, folder, seed):
        self.folder, self.draw = folder, random.Random(seed)
        self.survey = folder / "survey.toml"
        self.survey.write_text(self.survey.read_text().replace('occupations = "schedule.csv"', 'occupations = ""'))
        events = events_of(folder)
        starts = [i for i, event in enumerate(events) if event["type"] == "start"]
        self.stays = [Stay(one[0], one[1:-1], one[-1]) for one in
                      (events[i:k] for i, k in zip(starts, starts[1:] + [len(events)]))]
        self.repairs, self.touched = [], set()
        self.sites = rows(folder / "sites.csv")
        self.truth = {site["site"]: float(site["gravity_mgal"]) for site in self.sites}
        names = random.Random(seed)
        for number in range(MORE_SITES):
            near = names.choice(self.sites[:len(self.truth)])
            away = names.uniform(1.0, 60.0) * names.choice((-1, 1))
            self.sites.append({**near, "site": f"P.{number}", "gravity_mgal": f"{float(near['gravity_mgal']) + away:.3f}"})

    def gravity(self, name):
        return next(float(site["gravity_mgal"]) for site in self.sites if site["site"] == name)

    def free_stay(self, condition=lambda k: True):
        """Draws the number of a stay with which nothing has happened yet, nor with its neighbours."""
        free = [k for k in range(len(self.stays)) if not {k - 1, k, k + 1} & self.touched and condition(k)]
        if not free:
            raise NoRoom
        k = self.draw.choice(free)
        self.touched.add(k)
        return self.stays[k]

    def key_of(self, stay):
        return instant(stay.start["utc"]).strftime("%Y%m%dT%H%M%SZ")

    def is_only(self, k):
        return sum(stay.true_site == self.stays[k].true_site for stay in self.stays) == 1

    def write(self):
        events = sorted((event for stay in self.stays for event in (stay.start, *stay.set_ups, stay.stop) if event),
                        key=lambda event: event["utc"])
        write_events(self.folder, events + self.repairs)
        with open(self.folder / "sites.csv", "w", newline="") as text:
            table = csv.DictWriter(text, self.sites[0].keys(), lineterminator="\n")
            table.writeheader()
            table.writerows(self.sites)


def next_start(day, stay):
    return day.stays[day.stays.index(stay) + 1].start


def is_followed(day):
    return lambda k: k + 1 < len(day.stays) and day.stays[k + 1].start["site"] != day.stays[k].start["site"]


def late_stop(day, mistake, is_noticed):
    stay = day.free_stay(is_followed(day))
    late = instant(next_start(day, stay)["utc"]) - datetime.timedelta(seconds=day.draw.uniform(*mistake["before_next_start_s"]))
    stay.stop["utc"] = utc(late)
    if is_noticed:
        day.repairs.append({"type": "retime", "utc": utc(late), "key": day.key_of(stay), "to": utc(stay.true_stop), "reason": "late"})
    return {"kinds": {"moved_box"}, "sites": {stay.true_site}, "between": (stay.true_stop - datetime.timedelta(seconds=30), late)}


def no_stop(day, mistake, is_noticed):
    stay = day.free_stay(is_followed(day))
    stay.stop = None
    return {"kinds": {"moved_box", "no_stop"}, "sites": {stay.true_site}}


def no_last_stop(day, mistake, is_noticed):
    stay = day.free_stay(lambda k: k + 1 == len(day.stays))
    stay.stop = None
    return {"kinds": {"no_stop"}, "sites": {stay.true_site}}


def early_start(day, mistake, is_noticed):
    stay = day.free_stay(lambda k: k > 0)
    before = instant(day.stays[day.stays.index(stay) - 1].stop["utc"])
    stay.start["utc"] = utc(stay.true_start - day.draw.uniform(*mistake["share_of_the_way"]) * (stay.true_start - before))
    if is_noticed:
        day.repairs.append({"type": "retime", "utc": utc(stay.true_stop), "key": day.key_of(stay), "from": utc(stay.true_start),
                            "reason": "early"})
    return {"kinds": {"early_start", "moved_box"}, "sites": {stay.true_site}}


def late_start(day, mistake, is_noticed):
    stay = day.free_stay()
    stay.start["utc"] = utc(stay.true_start + datetime.timedelta(seconds=day.draw.uniform(*mistake["late_s"])))
    stay.set_ups = [event for event in stay.set_ups if event["utc"] > stay.start["utc"]]
    return {"kinds": set(), "sites": {stay.true_site}}


def early_stop(day, mistake, is_noticed):
    stay = day.free_stay()
    stay.stop["utc"] = utc(stay.true_start + datetime.timedelta(seconds=day.draw.uniform(*mistake["after_start_s"])))
    stay.set_ups = [event for event in stay.set_ups if event["utc"] < stay.stop["utc"]]
    return {"kinds": {"short_stay"}, "sites": {stay.true_site}}


def no_stay(day, mistake, is_noticed):
    stay = day.free_stay(day.is_only)
    stay.start, stay.set_ups, stay.stop = None, [], None
    return {"kinds": {"not_visited"}, "sites": {stay.true_site}}


def missed_set_up(day, mistake, is_noticed):
    stay = day.free_stay()
    stay.set_ups = []
    return {"kinds": {"missed_set_up"}, "sites": {stay.true_site}}


def knocks(day, mistake, is_noticed):
    return {"kinds": set(), "sites": set()}  # Made when the day was simulated.


def other_name(day, mistake, is_noticed):
    stay = day.free_stay()
    free = [site["site"] for site in day.sites[len(day.truth):]
            if abs(float(site["gravity_mgal"]) - day.gravity(stay.true_site)) > LEAST_APART_MGAL]
    stay.start["site"] = day.draw.choice(free)
    if is_noticed:
        day.repairs.append({"type": "rename", "utc": utc(stay.true_stop), "key": day.key_of(stay), "site": stay.true_site,
                            "reason": "wrong name"})
    return {"kinds": {"other_name", "reference"}, "sites": {stay.start["site"]}}


def swapped_names(day, mistake, is_noticed):
    one = day.free_stay(day.is_only)
    other = day.free_stay(lambda k: day.is_only(k)
                          and abs(day.gravity(day.stays[k].true_site) - day.gravity(one.true_site)) > LEAST_APART_MGAL)
    one.start["site"], other.start["site"] = other.true_site, one.true_site
    if is_noticed:
        for stay in (one, other):
            day.repairs.append({"type": "rename", "utc": utc(stay.true_stop), "key": day.key_of(stay), "site": stay.true_site,
                                "reason": "swapped"})
    return {"kinds": {"other_name"}, "sites": {one.true_site, other.true_site}}


def wrong_reference(day, mistake, is_noticed):
    stay = day.free_stay()
    site = next(site for site in day.sites if site["site"] == stay.true_site)
    off = day.draw.uniform(*mistake["off_mgal"]) * day.draw.choice((-1, 1))
    site["gravity_mgal"] = f"{float(site['gravity_mgal']) + off:.3f}"
    return {"kinds": {"reference", "other_name"}, "sites": {stay.true_site}}


def step(day, mistake, is_noticed):
    return {"kinds": {"step"}, "sites": set(), "off_mgal": day.step_mgal}  # Made when the day was simulated.


def is_said(findings, expected):
    """Returns true if a finding names the mistake."""
    for finding in findings:
        # At an end of the day a step looks like a reading that is off.
        if "step" in expected["kinds"] and (finding["kind"] == "step" or finding["code"].endswith("_or_step")) \
                and abs(abs(finding["size_mgal"]) - expected["off_mgal"]) < 4.0 * finding["u_mgal"]:
            return True
        if "step" in expected["kinds"] and finding["code"] == "misfit_step":
            return True
        if finding["kind"] == "not_visited" in expected["kinds"] and expected["sites"] & set(finding["text"].split(": ")[1].split(", ")):
            return True
        if finding["kind"] in expected["kinds"] and {finding["site"], finding["other_site"]} & expected["sites"]:
            begin, end = expected.get("between", (None, None))
            if begin is None or begin <= instant(finding["time_utc"]) < end:
                return True
    return False


def left_out_errors(folder, truth):
    """Returns left-out value minus truth, and u, for each visited site."""
    return {row["site"]: (float(row["left_out_mgal"]) - truth[row["site"]], float(row["u_left_out_mgal"]))
            for row in rows(folder / "stations.csv") if row["site"] in truth and row["left_out_mgal"]}


def corrected(day, name):
    """Corrects the day and returns its findings and the errors of the stations left out."""
    correct_survey(day.survey, day.folder / name)
    return read_json(day.folder / name / "result.json")["findings"], left_out_errors(day.folder / name, day.truth)


def play(folder, scenario_file, seed, count=3, names=None):
    """Plays a game day.

    @param scenario_file  function of further sections of the scenario, which returns a scenario file
    @param names          names of the mistakes; None: `count` are drawn
    @return  the mistakes with what was said before or after the proposals were carried out, if it was said that the model does
             not fit, ratio of the left-out errors on the same sites with every proposal carried out to those of the day without
             mistakes, and without a proposal, and the findings
    """
    draw = random.Random(seed)
    chosen = [mistake for mistake in MISTAKES if mistake["name"] in names] if names else draw.sample(MISTAKES, count)
    step_mgal = sum(draw.uniform(*mistake["off_mgal"]) for mistake in chosen if mistake["what"] == "step")
    without = "".join(mistake.get("scenario", "") for mistake in chosen)
    more = "".join(mistake.get("scenario_with", "") for mistake in chosen)
    if step_mgal:
        more += f"[slow_noise]\ntransport_step_mgal = {step_mgal}\n"

    def simulate(name, sections):
        run(BIN / "a351-sim", "survey", "--scenario", scenario_file(sections), "--seed", seed, "--out", folder / name)

    simulate("clean", without)
    if more:
        simulate("day", without + more)
    else:
        shutil.copytree(folder / "clean", folder / "day")
    clean, day = Day(folder / "clean", seed), Day(folder / "day", seed)
    clean.write()
    clean_findings, clean_errors = corrected(clean, "result")
    day.step_mgal = step_mgal
    made = []
    for mistake in chosen:
        is_noticed = mistake.get("can_notice", False) and draw.random() < 0.3
        try:
            expected = globals()[mistake["what"]](day, mistake, is_noticed)
        except NoRoom:
            continue
        made.append({"name": mistake["name"], "what": mistake["what"], "is_noticed": is_noticed, **expected})
    day.write()
    findings, raw_errors = corrected(day, "as-it-stands")
    run(BIN / "a351-correct", "amend", day.survey, "--all")
    left, errors = corrected(day, "amended")

    def ratio(after):
        same = clean_errors.keys() & after.keys()
        return rms(after[site][0] for site in same) / rms(clean_errors[site][0] for site in same)

    changed = max(abs(errors[site][0] - clean_errors[site][0]) / clean_errors[site][1] for site in clean_errors.keys() & errors.keys())
    for mistake in made:
        mistake["is_said"] = mistake["is_noticed"] or not mistake["kinds"] or is_said(findings + left, mistake)
    is_misfit = any(finding["kind"] == "misfit" for finding in findings + left)
    return {"made": made, "is_misfit": is_misfit, "raw": ratio(raw_errors), "amended": ratio(errors), "changed": changed, "findings": findings,
            "clean": clean_findings}

"""Made-up states of the stub daemon, shared by the tests of the page."""

import time

from stub_daemon import check, rfc3339

SLOPE = check("temperature slope", 0.05, "degC/h", 0.25, True)
CHANGE = check("reading will change in 10 min by", 0.4, "mGal", 2.0, True, error=0.3)
DRIFT = check("acceleration slope", 2.1, "mGal/h", 12.0, True, error=1.4)
WARM = check("temperature differs from the set point by", 0.02, "degC", 1.0, True)
QUIET = check("last knock", 180.0, "s", 72.0, True, is_least=True, ending="ago")
NOISE = check("noise", 1.02, "", 5.0, True, ending="x its usual level")

CHECKS = [check("temperature slope", 0.31, "degC/h", 0.25, False),
          check("reading will change in 10 min by", 2.9, "mGal", 2.0, False, error=0.5), SLOPE, CHANGE, DRIFT, WARM, QUIET, NOISE]

MOVED = {"utc": "2026-03-01T01:43:20.000Z", "is_at_start": False}
MOVED_PARTS = ["the box was moved at {}: stop at that time, or say that it was not moved", ["2026-03-01T01:43:20Z"]]

# For each word: the text, parts of the sentence, and the buttons.
SIGNALS = {
    "no_data": ("NO DATA", ["No values arrive"], [". Check the sensor's plug and its power supply."]),
    "warming_up": ("WARMING UP", ["The box is not at its operating temperature yet"], [". At least {} min more", ["42"]], "."),
    "keep_off": ("KEEP OFF", ["{}: set-up {} of {}, {} left", ["No.5"], ["1"], ["2"], ["2:10"]], "."),
    "lift": ("LIFT, SET DOWN", ["{}: set-up {} of {} is complete. Lift the box, set it down level, then press Next set-up.",
                                ["No.5"], ["1"], ["2"]]),
    "go": ("YOU CAN GO", ["{}: the reading is complete. Press Stop, then go.", ["No.5"]]),
    "look": ("LOOK", MOVED_PARTS),
}
BUTTONS = {"lift": ["setup", "stop"], "go": ["stop", "setup"], "look": ["stop_at", "not_moved"]}


def english(parts):
    """Returns a sentence of the daemon in English."""
    return "".join(part if isinstance(part, str) else part[0].replace("{}", "%s") % tuple(english(word) for word in part[1:]) for part in parts)


def signal(word, parts=None, buttons=None):
    text, *said = SIGNALS[word]
    parts = parts or said
    return {"word": word, "text": text, "sentence": english(parts), "parts": parts,
            "buttons": BUTTONS.get(word, []) if buttons is None else buttons, "look": {"code": "moved", "key": ""} if word == "look" else None}


def no_stay():
    said = [["The stay at {} has ended. At the next benchmark set the box down level, then press Start.", ["No.5"]]]
    return {**signal("go", said, ["start"]), "text": "NO STAY RUNS"}


def details(state="settling", held_s=75.0, checks=None):
    return {"state": state, "since": rfc3339(time.time() - held_s), "held_s": held_s, "time_left_s": None, "reasons": [],
            "checks": CHECKS if checks is None else checks}


def reading(value_mgal=979861.32, **changes):
    return {"value_mgal": value_mgal, "used_s": 388.0, "left_out_s": 12.0, "set_ups": 1, "set_up_sd_mgal": None,
            "set_up_sd_limits_mgal": None, "set_up_error_mgal": None, **changes}


def gravity(gravity_mgal=979809.87, u_mgal=1.27):
    return {"gravity_mgal": gravity_mgal, "u_mgal": u_mgal, "missing_parts": None}


MISSING = {"gravity_mgal": None, "u_mgal": None, "missing_parts": [["no benchmark with known gravity was read yet"]]}


def occupation(site="No.5", **changes):
    start = rfc3339(time.time() - 400)
    return {"key": "20260301T013000Z", "site": site, "number": 1, "operator": "T. Sato", "note": "on the pillar", "start": start, "set_up": start,
            "set_up_count": 1, "session": "00", "index": 1, "running_s": 400.0, "gravity": None, "reading": reading(),
            "whole": reading(), "planned_s": 720.0, "planned_set_ups": 2, "has_own_plan": False, "set_up_left_s": 130.0,
            "warnings": [], "moved": None, **changes}


def finished(site, number=1, hours_ago=1.0, **changes):
    begin = time.time() - 3600 * hours_ago
    return {"key": f"20260301T00{number:02}00Z", "site": site, "number": number, "note": "", "used": None,
            "set_ups": [{"start": rfc3339(begin), "end": rfc3339(begin + 660)}], "reading": reading(), **changes}


def stay(site, occupation=1, gravity_mgal=979861.32, difference_mgal=None, **changes):
    return {"key": "20260301T013000Z", "site": site, "occupation": occupation, "set_ups": 1, "gravity_mgal": gravity_mgal,
            "u_mgal": None if gravity_mgal is None else 1.27, "left_out_difference_mgal": difference_mgal,
            "is_running": False, "remarks": [], **changes}


def finding(text, is_headline, key=None):
    return {"kind": "other_name", "code": "other_name", "key": key, "is_headline": is_headline, "text": text}


def survey(stays, findings=(), **changes):
    return {"as_of_utc": "2026-03-01T12:03:10.000Z", "data_to_utc": "2026-03-01T12:03:09.500Z", "reason": None, "reason_text": None,
            "model": "day", "stays": list(stays), "findings": list(findings), **changes}


def tilt(x_arcmin, y_arcmin, advice=()):
    return {"axes": ["x", "y"], "x_arcmin": x_arcmin, "y_arcmin": y_arcmin, "limit_arcmin": 1.2,
            "is_within": None if x_arcmin is None else not advice, "advice": list(advice),
            "reference": {"site": "No.0", "utc": rfc3339(time.time() - 7200)}}


def sites(count=14):
    return [{"site": f"No.{i}", "distance_m": 130.0 * i * i, "longitude_deg": 140.1 + 0.02 * (i % 5), "latitude_deg": 36.1 + 0.013 * i,
             "altitude_m": None, "gravity_mgal": None} for i in range(count)]

"""Made-up states of the stub daemon, shared by the tests of the page."""

import time

from stub_daemon import check, rfc3339

SLOPE = check("temperature slope", 0.05, "degC/h", 0.25, True)
CHANGE = check("reading will change in 10 min by", 0.4, "mGal", 2.0, True, error=0.3)
DRIFT = check("acceleration slope", 2.1, "mGal/h", 12.0, True, error=1.4)
WARM = check("temperature differs from the set point by", 0.02, "degC", 1.0, True)
QUIET = check("last knock", 180.0, "s", 72.0, True, is_least=True, ending="ago")
NOISE = check("noise", 1.02, "", 5.0, True, ending="x its usual level")

VERDICTS = {
    "no data": [check("last good sample", 42.0, "s", 10.0, False, ending="ago")],
    "warming up": [check("temperature differs from the set point by", 6.2, "degC", 1.0, False),
                   check("switched on", 0.4, "h", 2.5, False, is_least=True, ending="ago"), SLOPE],
    "disturbed": [check("last knock", 12.0, "s", 72.0, False, is_least=True, ending="ago"), WARM, SLOPE, CHANGE, DRIFT,
                  NOISE],
    "settling": [check("temperature slope", 0.31, "degC/h", 0.25, False),
                 check("reading will change in 10 min by", 2.9, "mGal", 2.0, False, error=0.5), WARM, DRIFT, QUIET, NOISE],
    "stable": [WARM, SLOPE, CHANGE, DRIFT, QUIET, NOISE],
}


def verdict(state, held_s=75.0):
    return {"state": state, "since": rfc3339(time.time() - held_s), "held_s": held_s,
            "reasons": [f"{one['quantity']} {one['value']}" for one in VERDICTS[state] if not one["is_met"]],
            "checks": VERDICTS[state]}


def reading(standard_error_mgal=1.31, needed_s=250.0, is_good_enough=False):
    return {"value_mgal": 979861.32, "standard_error_mgal": standard_error_mgal, "used_s": 388.0, "left_out_s": 12.0,
            "target_mgal": 1.0, "is_good_enough": is_good_enough, "needed_s": needed_s,
            "set_ups": 1, "set_up_sd_mgal": None, "set_up_error_mgal": None}


def occupation(site="No.5", **changes):
    start = rfc3339(time.time() - 400)
    return {"key": "20260301T013000Z", "site": site, "number": 1, "operator": "T. Sato", "note": "on the pillar", "start": start, "set_up": start,
            "set_up_count": 1, "session": "00", "index": 1, "running_s": 400.0, "reading": reading(),
            "whole": reading(), "planned_s": 720.0, "planned_set_ups": 2, "has_own_plan": False, "set_up_left_s": 130.0, "propose_set_up": False,
            "may_stop": False, "warnings": [], **changes}


def finished(site, number=1, hours_ago=1.0, **changes):
    begin = time.time() - 3600 * hours_ago
    return {"key": f"20260301T00{number:02}00Z", "site": site, "number": number, "note": "", "used": None,
            "set_ups": [{"start": rfc3339(begin), "end": rfc3339(begin + 660)}], "reading": reading(0.42), **changes}


def stay(site, occupation=1, gravity_mgal=979861.32, difference_mgal=None, **changes):
    return {"key": "20260301T013000Z", "site": site, "occupation": occupation, "set_ups": 1, "gravity_mgal": gravity_mgal,
            "u_mgal": None if gravity_mgal is None else 1.27, "u_evening_mgal": None, "left_out_difference_mgal": difference_mgal,
            "is_running": False, "remarks": [], **changes}


def finding(text, is_headline):
    return {"kind": "other_name", "code": "other_name", "is_headline": is_headline, "text": text}


def survey(stays, findings=(), **changes):
    return {"as_of_utc": "2026-03-01T12:03:10.000Z", "data_to_utc": "2026-03-01T12:03:09.500Z", "reason": None, "reason_text": None,
            "model": "day", "stays": list(stays), "findings": list(findings), **changes}


def tilt(x_arcmin, y_arcmin, advice=()):
    return {"axes": ["x", "y"], "x_arcmin": x_arcmin, "y_arcmin": y_arcmin, "limit_arcmin": 1.2,
            "is_within": None if x_arcmin is None else not advice, "advice": list(advice),
            "reference": {"site": "No.0", "utc": rfc3339(time.time() - 7200)}}


def sites(count=14):
    return [{"site": f"No.{i}", "distance_m": 130.0 * i * i, "longitude_deg": None, "latitude_deg": None,
             "altitude_m": None, "gravity_mgal": None} for i in range(count)]

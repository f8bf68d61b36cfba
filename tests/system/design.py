"""A survey is designed: files, text and JSON agree, each proposal keeps what it promises, a mistake in the plan writes nothing."""

import json

from programs import BIN, TOP, Scratch, demand, read_json, rows, run

KNOWN = ("No.0", "No.7")
VISITS = ("No.0", "No.1", "No.2", "No.7", "No.3", "No.4")


def design(scratch, *arguments, check=True):
    return run(BIN / "a351-correct", "design", *arguments, cwd=scratch, check=check)


def write_inputs(scratch):
    lines = ["site,longitude_deg,latitude_deg,altitude_m,gravity_mgal"]
    for row in rows(TOP / "tests" / "golden" / "tsukuba" / "sites.csv"):
        gravity = row["gravity_mgal"] if row["site"] in KNOWN else ""
        lines.append(",".join([row["site"], row["longitude_deg"], row["latitude_deg"], row["altitude_m"], gravity]))
    (scratch / "sites.csv").write_text("\n".join(lines) + "\n")
    lines = [f"{site},2026-05-01T{k // 2:02}:{30 * (k % 2):02}:00Z,1,12" for k, site in enumerate(VISITS)]
    (scratch / "plan.csv").write_text("\n".join(["site,start_utc,set_ups,minutes_each", *lines]) + "\n")


with Scratch() as scratch:
    write_inputs(scratch)
    text = design(scratch, "plan.csv", "--sites", "sites.csv", "--out", "first").stdout
    print(text)
    found = read_json(scratch / "first" / "design.json")
    stations = rows(scratch / "first" / "design.csv")
    demand("design.csv and design.json have the stations of the plan with one uncertainty",
           [row["site"] for row in stations] == list(VISITS) == [row["site"] for row in found["stations"]]
           and all(abs(float(row["u_mgal"]) - one["u_mgal"]) < 1e-6 for row, one in zip(stations, found["stations"])))
    demand("known stations have no uncertainty, the others have some",
           all((float(row["u_mgal"]) == 0.0) == (row["site"] in KNOWN) for row in stations))
    demand("differences.csv has every pair", len(rows(scratch / "first" / "differences.csv")) == 15)
    demand("the text has the hours and each proposal",
           "2.7 h" in text and found["alternatives"] and all(one["text"] in text for one in found["alternatives"]))

    printed = design(scratch, "plan.csv", "--sites", "sites.csv", "--json", "--out", "again").stdout
    names = sorted(path.relative_to(scratch / "first") for path in (scratch / "first").rglob("*") if path.is_file())
    demand("the same plan gives the same bytes, which --json prints",
           printed == (scratch / "first" / "design.json").read_text()
           and all((scratch / "first" / name).read_bytes() == (scratch / "again" / name).read_bytes() for name in names))

    for one in found["alternatives"]:
        (scratch / "changed.csv").write_text(one["plan_change"])
        changed = json.loads(design(scratch, "changed.csv", "--sites", "sites.csv", "--json", "--out", "changed").stdout)
        demand(f"as a plan: {one['text']}: {changed['u_mgal']:.2f} mGal",
               abs(changed["u_mgal"] - one["u_mgal"]) < 1e-9 and one["u_mgal"] < 0.99 * found["u_mgal"]
               and abs(60.0 * (changed["hours"] - found["hours"]) - one["extra_minutes"]) < 1e-6)

    plan = (scratch / "plan.csv").read_text()
    before = sorted(scratch.rglob("*"))
    for bad, arguments, parts in (
            (plan.replace("No.1,", "no.1,"), [], ("bad.csv:3", "site = no.1", "like No.1?")),
            (plan.replace("00:30:00Z", "00:11:00Z"), [], ("bad.csv:3", "start_utc = 2026-05-01T00:11:00Z", "or later")),
            (plan.replace("Z,1,12\nNo.2", "Z,1,1\nNo.2"), [], ("bad.csv:3", "minutes_each = 1", "allowed")),
            (plan, ["--unit", "plan.csv"], ("plan.csv", )),
            (plan, ["--unit", "first/design.json"], ("first/design.json", "allowed")),
            (plan, ["--out", "plan.csv"], ("--out = plan.csv", "allowed"))):
        (scratch / "bad.csv").write_text(bad)
        refused = design(scratch, "bad.csv", "--sites", "sites.csv", *arguments, check=False)
        print(refused.stderr.strip())
        (scratch / "bad.csv").unlink()
        demand(f"one line, status 2, nothing written: {refused.stderr.strip()[:60]}...",
               refused.returncode == 2 and refused.stderr.count("\n") == 1 and all(part in refused.stderr for part in parts)
               and sorted(scratch.rglob("*")) == before)

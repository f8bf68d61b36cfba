"""A survey is designed: files, text and JSON agree, a mistake in the plan writes nothing.

alternatives_test.cpp has the proposals.
"""

from programs import BIN, TOP, Scratch, contents, demand, read_json, refused, rows, run, write_sites

KNOWN = ("No.0", "No.7")
VISITS = ("No.0", "No.1", "No.2", "No.7", "No.3", "No.4")


def design(scratch, *arguments):
    return run(BIN / "a351-correct", "design", *arguments, cwd=scratch)


def write_inputs(scratch):
    table = rows(TOP / "tests" / "golden" / "tsukuba" / "sites.csv")
    write_sites(scratch / "sites.csv", table, {row["site"]: row["gravity_mgal"] for row in table if row["site"] in KNOWN})
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
    demand("the same plan gives the same bytes, which --json prints",
           printed == (scratch / "first" / "design.json").read_text()
           and contents(scratch / "first") == contents(scratch / "again"))

    before = sorted(scratch.rglob("*"))
    (scratch / "bad.csv").write_text((scratch / "plan.csv").read_text().replace("No.1,", "no.1,"))
    refused(("bad.csv:3", "site = no.1", "like No.1?"), BIN / "a351-correct", "design", "bad.csv", "--sites", "sites.csv", cwd=scratch)
    (scratch / "bad.csv").unlink()
    demand("nothing is written", sorted(scratch.rglob("*")) == before)

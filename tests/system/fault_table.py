"""Table of the faults of fault-list.md: each result is noted with its figure, and all are printed at the end.

One fault with a result out of its limits fails the test.
"""

import sys


class FaultTable:
    def __init__(self):
        self.rows = []

    def note(self, number, fault, figure, is_held):
        self.rows.append((number, fault, figure, is_held))
        print(f"#{number} {fault}: {figure}: {'ok' if is_held else 'FAILED'}", flush=True)

    def finish(self):
        print("\n  # | fault | figure | ok")
        for number, fault, figure, is_held in sorted(self.rows, key=lambda row: row[0]):
            print(f"{number:3d} | {fault} | {figure} | {'yes' if is_held else 'NO'}")
        if not all(row[3] for row in self.rows):
            sys.exit(1)

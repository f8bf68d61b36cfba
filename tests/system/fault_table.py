"""The faults of fault-list.md: each is noted with its figure, all are printed in the end, one that does not hold fails
the test."""

import sys


class FaultTable:
    def __init__(self):
        self.rows = []

    def note(self, number, fault, figure, is_held):
        self.rows.append((number, fault, figure, is_held))
        print(f"#{number} {fault}: {figure}: {'held' if is_held else 'NOT HELD'}", flush=True)

    def finish(self):
        print("\n  # | fault | figure | held")
        for number, fault, figure, is_held in sorted(self.rows, key=lambda row: row[0]):
            print(f"{number:3d} | {fault} | {figure} | {'yes' if is_held else 'NO'}")
        if not all(row[3] for row in self.rows):
            sys.exit(1)

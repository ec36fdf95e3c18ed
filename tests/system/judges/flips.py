#!/usr/bin/env python3
"""Parses the table that runtime.frame_log writes: when frames were due, and when a display showed them.

usage: flips.py TABLE.csv OUTPUT PLOT.svg [HERTZ]     plots the flips of an output ("display") against their due times
"""
import copy
import csv
import statistics
import sys
import xml.sax.saxutils


# What happens in so many refreshes before its due one decides on a frame: it is handed over, copied and committed.
DECISIVE = 2.5


def standstills(path):
    """From when to when the machine stood still, in seconds (programs/standstills.h)."""
    with open(path, newline="") as file:
        return [(float(row["from_s"]), float(row["to_s"])) for row in csv.DictReader(file)]


class Flips:
    """The rows of one output, of a display that counts its refreshes, but for those of the run's end."""

    def __init__(self, path, output):
        with open(path, newline="") as file:
            self._take([row for row in csv.DictReader(file)
                        if row["output"] == output and row["outcome"] != "stopped"])

    def _take(self, rows):
        self.rows = rows
        self.flipped = [row for row in rows if row["refresh"]]

    def without(self, times, before):
        """Only the frames of which no part of the time from `before` seconds before they were due until then lies in
        these times."""
        def is_apart(row):
            due = float(row["due_s"])
            return not any(begin < due and end > due - before for begin, end in times)
        chosen = copy.copy(self)
        chosen._take([row for row in self.rows if is_apart(row)])
        return chosen

    def count(self, outcome):
        return sum(row["outcome"] == outcome for row in self.rows)

    def outcomes(self):
        """How many of each."""
        return {name: self.count(name) for name in sorted({row["outcome"] for row in self.rows})}

    def off(self):
        """By how many refreshes each flip missed the one that it was due at, by the display's count; before it:
        negative."""
        return [int(row["refresh"]) - int(row["due_refresh"]) for row in self.flipped
                if row["due_refresh"]]

    def latencies(self):
        """From capture to flip, in seconds."""
        return [float(row["shown_s"]) - float(row["captured_s"]) for row in self.flipped]

    def spread(self):
        """Standard deviation of these."""
        return statistics.pstdev(self.latencies()) if self.flipped else 0.0

    def check_outcomes(self):
        """A frame counts as shown exactly where it was flipped at the refresh that it was due at."""
        for row in self.flipped:
            if row["due_refresh"]:
                on_time = row["refresh"] == row["due_refresh"]
                assert row["outcome"] == ("shown" if on_time else "shown_off_schedule"), row

    def write_plot(self, path, title, period):
        """An SVG: over the frames' due times, by how many milliseconds they were flipped after them; grey: frames
        that were not."""
        due = [float(row["due_s"]) for row in self.rows]
        begin, end = min(due), max(due)
        width, height, limit = 1000, 260, 4 * period
        def x(time):
            return 60 + (width - 80) * (time - begin) / max(end - begin, 1e-9)
        def y(off):
            return 130 - 100 * max(-1, min(1, off / limit))
        parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
                 'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>'
                 f'<text x="60" y="18">{xml.sax.saxutils.escape(title)}</text>']
        for refreshes in range(-4, 5):
            level = y(refreshes * period)
            parts.append(f'<line x1="60" x2="{width - 20}" y1="{level}" y2="{level}" stroke="#ddd"/>'
                         f'<text x="8" y="{level + 4}">{1000 * refreshes * period:+.1f} ms</text>')
        for row in self.rows:
            at = float(row["due_s"])
            if row["shown_s"]:
                colour = "#226" if row["outcome"] == "shown" else "#c22"
                parts.append(f'<circle cx="{x(at):.1f}" cy="{y(float(row["shown_s"]) - at):.1f}" r="1.5" '
                             f'fill="{colour}"/>')
            else:
                parts.append(f'<line x1="{x(at):.1f}" x2="{x(at):.1f}" y1="236" y2="244" stroke="#999"/>')
        parts.append(f'<text x="60" y="{height - 4}">due, over {end - begin:.0f} s</text></svg>')
        with open(path, "w") as file:
            file.write("\n".join(parts))


def main():
    table, output, plot, *hertz = sys.argv[1:]
    flips = Flips(table, output)
    if not flips.rows:
        sys.exit(f"{table}: no frames of {output}")
    off = flips.off()
    title = (f"{output}: {len(flips.rows)} frames, {len(off)} of them flipped at a known refresh, "
             f"{sum(each == 0 for each in off)} at the due one")
    flips.write_plot(plot, title, 1 / float(hertz[0] if hertz else 60))


if __name__ == "__main__":
    main()

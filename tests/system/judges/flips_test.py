#!/usr/bin/env python3
"""Tests flips, and its plot, on a table of five frames."""
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from flips import Flips  # noqa: E402

# On its refresh, one refresh late, not shown, of another output, and of the run's end.
TABLE = """output,frame,captured_s,ready_s,due_s,due_refresh,shown_s,refresh,outcome
display,1,10.00,10.05,10.10,600,10.10,600,shown
display,2,10.04,10.09,10.14,602,10.16,603,shown_off_schedule
display,3,10.08,10.20,10.18,605,,,late
loopback:/dev/video50,1,10.00,10.05,10.10,,10.11,,shown
display,4,10.12,10.17,10.22,607,,,stopped
"""


class PlottedFlips(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self._table = os.path.join(self._folder.name, "frames.csv")
        with open(self._table, "w") as file:
            file.write(TABLE)

    def tearDown(self):
        self._folder.cleanup()

    def plot(self):
        path = os.path.join(self._folder.name, "flips.svg")
        subprocess.run([sys.executable, os.path.join(HERE, "flips.py"), self._table, "display", path, "60"], check=True)
        return xml.etree.ElementTree.parse(path).getroot()

    def test_reads_one_output_to_its_end(self):
        flips = Flips(self._table, "display")
        self.assertEqual([row["frame"] for row in flips.rows], ["1", "2", "3"])
        self.assertEqual(flips.off(), [0, 1])
        self.assertEqual(flips.outcomes(), {"shown": 1, "shown_off_schedule": 1, "late": 1})
        flips.check_outcomes()

    def test_leaves_out_what_a_standstill_decided(self):
        flips = Flips(self._table, "display")
        self.assertEqual([row["frame"] for row in flips.without([(10.11, 10.12)], 0.05).rows], ["1", "3"])

    def test_plots_each_flip_at_its_place(self):
        root = self.plot()
        name = "{http://www.w3.org/2000/svg}"
        first, second = root.findall(name + "circle")
        self.assertEqual(float(first.get("cx")), 60, "the first is at the left")
        self.assertEqual(float(first.get("cy")), 130, "on its due time")
        self.assertEqual(first.get("fill"), "#226")
        self.assertAlmostEqual(float(second.get("cx")), 60 + 920 / 2, delta=0.1)
        self.assertAlmostEqual(float(second.get("cy")), 130 - 100 * 0.02 / (4 / 60), delta=0.1, msg="20 ms late: above")
        self.assertEqual(second.get("fill"), "#c22")
        missed = [each for each in root.findall(name + "line") if each.get("stroke") == "#999"]
        self.assertEqual(len(missed), 1, "the one that was not shown")
        self.assertIn("3 frames, 2 of them flipped at a known refresh, 1 at the due one", "".join(root.itertext()))


if __name__ == "__main__":
    unittest.main()

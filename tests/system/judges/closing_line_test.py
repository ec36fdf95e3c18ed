#!/usr/bin/env python3
"""Tests closing_line on lines that the program has printed, and on lines that it must not print."""
import os
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from closing_line import ledger  # noqa: E402

SHOWED = "showed 90 frames in 3.0 s (30.0 frames/s)"


class Ledger(unittest.TestCase):
    def test_reads_reasons(self):
        read = ledger("[info] streaming\n"
                      f"{SHOWED}, 2 off schedule; dropped 5 (3 replaced by a newer one, 2 late): window\n")
        self.assertEqual(
            read, {"shown": 90, "dropped": 5, "replaced by a newer one": 3, "late": 2})

    def test_takes_no_output_for_a_reason(self):
        for outputs in ("loopback:/dev/video50", "window", "loopback:/dev/video50, out/a (1), b.mp4"):
            self.assertEqual(ledger(f"{SHOWED}; dropped 0: {outputs}\n"), {"shown": 90, "dropped": 0})
            self.assertEqual(ledger(f"{SHOWED}; dropped 1 (1 late): {outputs}\n"),
                             {"shown": 90, "dropped": 1, "late": 1})

    def test_reads_what_never_showed_a_frame(self):
        read = ledger("showed 0 frames in 0.0 s (0.0 frames/s); dropped 1 (1 while starting): window")
        self.assertEqual(read, {"shown": 0, "dropped": 1, "while starting": 1})

    def test_finds_what_does_not_add_up(self):
        for wrong in (f"{SHOWED}; dropped 3 (1 late): window", f"{SHOWED}; dropped 1: window",
                      f"{SHOWED}; dropped 1 (late): window", f"{SHOWED}; dropped 0", ""):
            with self.assertRaises(AssertionError):
                ledger(wrong)


if __name__ == "__main__":
    unittest.main()

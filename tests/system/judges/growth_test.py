#!/usr/bin/env python3
"""Tests growth on figures whose growth is known."""
import os
import random
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from growth import Soak, per_hour  # noqa: E402

NOISE = random.Random(1)


def readings(kib_per_hour=0.0, descriptors=lambda seconds: 40):
    """Ninety minutes, every ten seconds: caches fill for ten minutes; 256 KiB of noise."""
    return [(t, 90_000 + 20 * min(t, 600) + kib_per_hour * t / 3600 + NOISE.uniform(-128, 128), descriptors(t))
            for t in range(0, 5400, 10)]


class Growth(unittest.TestCase):
    def test_slope_is_that_of_a_line(self):
        self.assertAlmostEqual(per_hour([(0, 5.0), (1800, 6.0), (3600, 7.0)]), 2.0)

    def test_one_high_reading_does_not_move_it(self):
        level = [(t, 100.0) for t in range(100)]
        self.assertEqual(per_hour(level[:50] + [(50, 9000.0)] + level[51:]), 0.0)

    def test_two_samples_say_nothing(self):
        with self.assertRaises(ValueError):
            per_hour([(0, 1), (1, 1)])

    def test_level_program_passes(self):
        self.assertEqual(Soak(readings(), 1 << 20, 5400).faults(), [])

    def test_slow_leak_is_found(self):
        self.assertIn("memory grows", Soak(readings(kib_per_hour=1024), 0, 5400).faults()[0])

    def test_descriptors_that_are_not_closed_are_found(self):
        self.assertIn("descriptors", Soak(readings(descriptors=lambda t: 40 + t // 1800), 0, 5400).faults()[0])

    def test_a_log_that_fills_the_journal_is_found(self):
        self.assertIn("log a day", Soak(readings(), 3 << 20, 5400).faults()[0])


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Tests growth on figures whose growth is known."""
import os
import random
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from growth import Soak, per_hour  # noqa: E402


def readings(kib_per_hour=0.0, descriptors=lambda seconds: 40, minutes=90):
    """Every ten seconds: caches fill for ten minutes; 256 KiB of noise."""
    noise = random.Random(1)
    return [(t, 90_000 + 20 * min(t, 600) + kib_per_hour * t / 3600 + noise.uniform(-128, 128), descriptors(t))
            for t in range(0, 60 * minutes, 10)]


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
        self.assertEqual(Soak(readings(), 1 << 20, 5400).violations(), [])

    def test_what_fills_at_the_start_is_left_out(self):
        # With it, the median slope of half an hour would be that of the filling.
        self.assertEqual(Soak(readings(minutes=25, descriptors=lambda t: 20 if t < 600 else 40), 0, 1500).violations(), [])

    def test_leak_is_found_above_the_limit_only(self):
        self.assertIn("memory grows", Soak(readings(kib_per_hour=600), 0, 5400).violations()[0])
        self.assertEqual(Soak(readings(kib_per_hour=400), 0, 5400).violations(), [])

    def test_samples_of_the_start_alone_say_nothing(self):
        with self.assertRaises(ValueError):
            Soak(readings(minutes=9), 0, 540)

    def test_one_more_descriptor_for_a_moment_is_none(self):
        self.assertEqual(Soak(readings(descriptors=lambda t: 41 if t == 4000 else 40), 0, 5400).violations(), [])

    def test_descriptors_that_are_not_closed_are_found(self):
        self.assertIn("descriptors", Soak(readings(descriptors=lambda t: 40 + t // 1800), 0, 5400).violations()[0])

    def test_a_log_that_fills_the_journal_is_found(self):
        self.assertIn("log a day", Soak(readings(), 3 << 20, 5400).violations()[0])


if __name__ == "__main__":
    unittest.main()

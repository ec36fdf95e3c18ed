#!/usr/bin/env python3
"""How screens of a starting machine are told apart (appliance/image/check.py), by screens that are made here."""
import os
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

sys.path.insert(0, grub.IMAGE)

import check  # noqa: E402


class Screens(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "screen.ppm")

    def screen(self, width, height, colour=lambda x, y: (0, 0, 0)):
        with open(self.path, "wb") as file:
            file.write(b"P6\n%d %d\n255\n" % (width, height))
            file.write(b"".join(bytes(colour(x, y)) for y in range(height) for x in range(width)))
        return check.Screen(self.path)

    def test_kinds(self):
        self.assertEqual(self.screen(64, 48).kind(), "black")
        self.assertEqual(self.screen(64, 48, lambda x, y: (255 * (x % 9 == 0 and y < 9),) * 3).kind(), "text")
        self.assertEqual(self.screen(64, 48, lambda x, y: (4 * x, 5 * y, x + y)).kind(), "picture")

    def test_a_screen_that_is_off_is_black(self):
        def line(top):  # QEMU's "Display output is not active" is such a line, 16 rows high, in the middle
            return lambda x, y: (170 * (200 < x < 440 and top <= y < top + 16 and x % 3 == 0),) * 3
        self.assertEqual(self.screen(640, 480, line(232)).kind(), "black")
        self.assertEqual(self.screen(640, 480, line(0)).kind(), "text")
        self.assertEqual(self.screen(800, 480, line(232)).kind(), "text")

    def painting(self, shift=0, caption=False, paper=0):
        """A moving picture, with a text's box at its upper left, or paper under it: its last `paper` rows."""
        def colour(x, y):
            if y >= 240 - paper:
                return 248, 244, 234
            if caption and y < 60 and x < 160:
                return 40, 40, 40
            return (4 * (x + shift) % 150 + 100, y % 255, 90)
        return self.screen(320, 240, colour)

    def test_a_picture_on_paper_with_texts_is_a_card(self):
        self.assertTrue(self.painting(paper=60).is_card())
        self.assertFalse(self.painting(paper=60).is_painting())
        self.assertTrue(self.painting().is_painting())
        self.assertFalse(self.screen(320, 240).is_painting())

    def test_the_next_painting_is_another_one(self):
        first = self.painting()
        self.assertTrue(self.painting(9).is_next_painting(first))
        self.assertFalse(self.painting().is_next_painting(first))
        self.assertFalse(self.painting(9, paper=60).is_next_painting(first))
        self.assertFalse(self.painting(9).is_next_painting(self.painting(paper=60)))
        self.assertFalse(self.screen(64, 48, lambda x, y: (4 * x, 5 * y, x + y)).is_next_painting(first))

    def test_a_text_that_comes_or_goes_is_no_next_painting(self):
        first, captioned = self.painting(), self.painting(caption=True)
        self.assertTrue(captioned.has_caption())
        self.assertFalse(captioned.is_next_painting(first))
        self.assertFalse(first.is_next_painting(captioned))
        self.assertTrue(self.painting(9, caption=True).is_next_painting(captioned))

    def phases(self, mode_at, moments):
        """Whether the firmware is done at each moment, where its own mode comes at `mode_at`."""
        firmware = check.Firmware()
        return [firmware.is_over(at, self.screen(8, 6) if at < mode_at else self.screen(16, 8)) for at in moments]

    def test_text_is_the_firmwares_up_to_20_seconds(self):
        self.assertEqual(self.phases(5, [0, 6, 19, 21, 60]), [False, False, False, True, True])

    def test_a_slow_machine_has_as_much_longer(self):
        # As seen on a busy machine: the mode after 17.2 s, GRUB's last text at 21.2.
        self.assertEqual(self.phases(17.2, [0, 17.2, 21.2, 34, 35]), [False, False, False, False, True])
        self.assertEqual(self.phases(40, [0, 30, 40, 79, 81]), [False, False, False, False, True])

    def test_a_mode_that_is_never_seen_to_come_excuses_no_text_for_ever(self):
        self.assertEqual(self.phases(1e9, [0, 30, 59, 61, 400]), [False, False, False, True, True])

    def test_a_mode_that_comes_later_than_a_minute_excuses_nothing_more(self):
        self.assertEqual(self.phases(90, [0, 59, 61, 90, 100, 179]), [False, False, True, True, True, True])
        # Nothing differed between a second and a minute and a half.
        self.assertEqual(self.phases(90, [0, 1, 90, 91]), [False, False, True, True])


if __name__ == "__main__":
    unittest.main()

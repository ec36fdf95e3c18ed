#!/usr/bin/env python3
"""The image's own units, judged by systemd: they are well-formed, and what they start is there."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

UNITS = os.path.join(grub.IMAGE, "root", "etc", "systemd", "system")


@unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
class Units(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name in os.listdir(UNITS):
            if os.path.isfile(os.path.join(UNITS, name)):
                with open(os.path.join(UNITS, name)) as file:
                    self.write(name, file.read().replace("/usr/lib/pleinair/", grub.TOOLS + "/"))
        for name in ("pleinair-kiosk", "pleinair-repair-station", "dbus"):
            self.write(name + ".service", "[Service]\nExecStart=/bin/true\n")

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)

    def verify(self, name):
        instance = name.replace("@.", "@sda1.")
        done = subprocess.run(["systemd-analyze", "--man=no", "verify", os.path.join(self.folder, instance)],
                              capture_output=True, text=True, env={**os.environ, "SYSTEMD_UNIT_PATH": self.folder + ":"})
        return done.stdout + done.stderr

    def names(self):
        return [each for each in os.listdir(UNITS) if re.search(r"\.(service|path|timer)$", each)]

    def test_are_well_formed(self):
        self.assertGreaterEqual(len(self.names()), 6)
        for name in self.names():
            with self.subTest(unit=name):
                self.assertEqual(self.verify(name), "")

    def test_mistakes_would_be_seen(self):
        self.write("slot-on-trial.service", "[Service]\nType=oneshot\nExecStart=/nowhere/program\nTypo=yes\n")
        found = self.verify("slot-on-trial.service")
        self.assertIn("Typo", found)
        self.assertIn("/nowhere/program", found)

    def test_the_image_enables_them(self):
        with open(os.path.join(grub.IMAGE, "finish")) as file:
            finish = file.read()
        for name in self.names():
            with open(os.path.join(UNITS, name)) as file:
                if "[Install]" in file.read():
                    self.assertIn(name, finish)

    def test_the_program_is_told_where_the_notice_is_and_its_sign_is_waited_for(self):
        with open(os.path.join(grub.SOURCE, "systemd", "pleinair-painting.service.in")) as file:
            painting = file.read()
        self.assertIn("--notice /run/pleinair-machine/notice", painting)
        with open(os.path.join(UNITS, "confirm-slot.path")) as file:
            place = re.search("PathExists=/run/(.*)/steady", file.read()).group(1)
        self.assertIn(f"\nRuntimeDirectory={place}\n", painting)


if __name__ == "__main__":
    unittest.main()

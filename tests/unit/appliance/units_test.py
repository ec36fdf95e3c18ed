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
        # What they are dropped into comes from packages.
        for name in ("rauc", "systemd-repart", "systemd-udevd", "systemd-udev-trigger"):
            self.write(name + ".service", "[Service]\nExecStart=/bin/true\n")
        self.write("media-pleinair.mount", "[Mount]\nWhat=/dev/sda1\nWhere=/media/pleinair\n")
        # The image has kmod, where these tests run it may be missing.
        modprobe = shutil.which("modprobe", path="/usr/sbin:/sbin") or "/bin/true"
        for name in self.drop_ins():
            with open(os.path.join(UNITS, name)) as file:
                self.write(name, file.read().replace("/sbin/modprobe", modprobe))

    def drop_ins(self):
        return [os.path.join(each, name) for each in os.listdir(UNITS) if each.endswith(".d")
                for name in os.listdir(os.path.join(UNITS, each))]

    def write(self, name, text):
        os.makedirs(os.path.dirname(os.path.join(self.folder, name)), exist_ok=True)
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

    def test_what_is_dropped_into_others_is_well_formed(self):
        units = {os.path.dirname(each)[:-len(".d")] for each in self.drop_ins()}
        self.assertEqual(units, {"rauc.service", "media-pleinair.mount", "systemd-repart.service", "systemd-udevd.service",
                                 "systemd-udev-trigger.service", "dev-pleinair-provisioning.device"})
        for name in units:
            with self.subTest(unit=name):
                self.assertEqual(self.verify(name), "")
        self.write("rauc.service.d/pleinair.conf", "[Service]\nTypo=yes\n")
        self.assertIn("Typo", self.verify("rauc.service"))

    def value(self, unit, name):
        with open(os.path.join(UNITS, unit)) as file:
            return re.search(f"^{name}=(.*)$", file.read(), re.M).group(1)

    def test_a_confirmation_that_fails_is_made_again_and_again(self):
        self.assertEqual(self.value("confirm-slot.service", "Restart"), "on-failure")
        self.assertEqual(self.value("confirm-slot.service", "StartLimitIntervalSec"), "0")

    def test_only_a_refusal_is_no_failure(self):
        self.assertEqual(self.value("install-update@.service", "SuccessExitStatus"), "3")

    def test_a_stick_that_is_pulled_is_known_by_the_name_it_had(self):
        with open(os.path.join(grub.IMAGE, "root", "etc", "udev", "rules.d", "61-pleinair-machine.rules")) as file:
            self.assertIn('ACTION=="remove", RUN+="/usr/lib/pleinair/install-update --gone /dev/%k"', file.read())
        self.assertEqual(self.value("install-update@.service", "ExecStart"), "/usr/lib/pleinair/install-update /dev/%I")

    def test_painting_services_do_not_see_the_bus(self):
        for name in ("pleinair-painting.service.in", "pleinair-rescue@.service.in"):
            with open(os.path.join(grub.SOURCE, "systemd", name)) as file:
                self.assertIn("\nInaccessiblePaths=-/run/dbus\n", file.read())

    def test_five_starts_that_hang_fall_into_the_time_that_they_are_counted_in(self):
        with open(os.path.join(grub.SOURCE, "systemd", "pleinair-painting.service.in")) as file:
            seconds = dict(re.findall(r"^(\w+)=(\d+)$", file.read(), re.M))
        starts = int(seconds["StartLimitBurst"])
        longest = starts * (int(seconds["TimeoutStartSec"]) + int(seconds["TimeoutStopSec"]) + 0.5)
        self.assertGreater(int(seconds["StartLimitIntervalSec"]), longest + 30)

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

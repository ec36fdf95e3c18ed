#!/usr/bin/env python3
"""Which slot starts, over the life of a machine: GRUB's side (slots.cfg, run by GRUB's own interpreter) and the system's
(`slots`), which share a block of variables. RAUC's part is what its GRUB backend writes."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

SLOTS = os.path.join(grub.TOOLS, "slots")


class Machine:
    """A machine with slots a and b, each of which may be able to paint."""

    def __init__(self):
        self.disk = grub.Disk()
        self.running = None
        self.notice = ""

    def close(self):
        self.disk.close()

    def switch_on(self):
        self.running = self.disk.start()
        return self.running

    def system(self, command, seconds=120, words=""):
        """Runs `slots` in the running system. Returns whether it restarts the machine."""
        with tempfile.TemporaryDirectory() as folder:
            def write(name, text):
                path = os.path.join(folder, name)
                with open(path, "w") as file:
                    file.write(text)
                return path

            environment = {
                **os.environ, "PLEINAIR_GRUBENV": self.disk.block(), "PLEINAIR_MACHINE": folder,
                "PLEINAIR_CMDLINE": write("cmdline", f"quiet pleinair.slot={self.running} {words}\n"),
                "PLEINAIR_UPTIME": write("uptime", f"{seconds}.27 99.00\n"),
                "PLEINAIR_RESTART": f"touch {folder}/restarted", "PLEINAIR_SETTLED": f"touch {folder}/settled"}
            # The machine calls GRUB's tool by its name.
            environment["PATH"] = os.path.join(grub.TOOLS, "bin") + ":" + environment["PATH"]
            subprocess.run([SLOTS, command], check=True, env=environment, capture_output=True)
            self.disk.store()
            self.is_settled = os.path.exists(os.path.join(folder, "settled"))
            notice = os.path.join(folder, "notice")
            self.notice = ""
            if os.path.exists(notice):
                with open(notice) as file:
                    self.notice = file.read().strip()
            return os.path.exists(os.path.join(folder, "restarted"))

    def paint(self):
        self.system("confirm")

    def install(self, slot, version="2.0"):
        """What install-update and RAUC write."""
        other = "b" if slot == "a" else "a"
        self.disk.set(TRIAL=version)
        self.disk.set(**{f"{slot}_OK": 0, f"{slot}_TRY": 0})
        self.disk.set(**{"ORDER": f"{slot} {other}", f"{slot}_OK": 1, f"{slot}_TRY": 0})


@unittest.skipIf(grub.missing_program(), f"{grub.missing_program()} is not installed")
class Slots(unittest.TestCase):
    def setUp(self):
        self.machine = Machine()
        self.addCleanup(self.machine.close)

    def starts(self, count):
        return "".join(self.machine.switch_on() or "-" for _ in range(count))

    def test_a_new_machine_starts_slot_a_and_counts(self):
        self.assertEqual(self.machine.switch_on(), "a")
        self.assertEqual(self.machine.disk.values()["a_TRY"], "1")

    def test_a_slot_that_paints_starts_for_ever(self):
        for _ in range(6):
            self.assertEqual(self.machine.switch_on(), "a")
            self.machine.paint()
        self.assertEqual(self.machine.disk.values()["CONFIRMED"], "a")

    def test_a_slot_on_trial_has_three_starts(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b")
        self.assertEqual(self.starts(5), "bbbaa")

    def test_a_slot_that_was_confirmed_has_eight(self):
        self.machine.switch_on()
        self.machine.paint()
        self.assertEqual(self.starts(9), "aaaaaaaab")

    def test_an_update_that_paints_is_kept(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b")
        self.assertEqual(self.machine.switch_on(), "b")
        self.machine.paint()
        self.assertEqual(self.machine.notice, "")
        self.assertEqual(self.starts(5), "bbbbb")

    def test_an_update_that_does_not_start_is_taken_back_and_said(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b", "2.0")
        self.assertEqual(self.starts(4), "bbba")
        self.machine.paint()
        self.assertEqual(self.machine.notice, "Version 2.0 did not paint here and was taken back.")
        values = self.machine.disk.values()
        self.assertEqual((values["FAILED"], values["b_OK"]), ("2.0", "0"))
        self.assertEqual(self.starts(12), "aaaaaaaaaaaa", "it is not tried again")

    def test_an_update_that_starts_and_does_not_paint_goes_back_by_itself(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b", "2.0")
        self.assertEqual(self.machine.switch_on(), "b")
        self.assertFalse(self.machine.system("check", seconds=599), "it has ten minutes")
        self.assertTrue(self.machine.system("check", seconds=600))
        self.assertEqual(self.machine.switch_on(), "a")
        self.machine.paint()
        self.assertIn("2.0", self.machine.notice)
        self.assertEqual(self.starts(3), "aaa")

    def test_the_time_on_trial_can_be_set(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b")
        self.machine.switch_on()
        self.assertFalse(self.machine.system("check", seconds=900, words="pleinair.trial_minutes=20"))
        self.assertTrue(self.machine.system("check", seconds=1200, words="pleinair.trial_minutes=20"))

    def test_a_confirmed_slot_without_a_camera_stays(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.switch_on()
        self.assertFalse(self.machine.system("check", seconds=599))
        self.assertFalse(self.machine.is_settled)
        self.assertFalse(self.machine.system("check", seconds=100000))
        self.assertTrue(self.machine.is_settled, "it is not asked again")

    def test_a_new_machine_without_a_camera_stays(self):
        self.machine.switch_on()
        self.assertFalse(self.machine.system("check", seconds=100000))

    def test_a_half_written_slot_is_not_started(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.disk.set(TRIAL="2.0", b_OK=0, b_TRY=0)  # the power was cut while RAUC wrote
        self.assertEqual(self.starts(3), "aaa")
        self.machine.paint()
        self.assertEqual(self.machine.notice, "")

    def test_power_cuts_while_on_trial_do_not_lose_an_update_that_then_paints(self):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b")
        self.assertEqual(self.starts(3), "bbb")
        self.machine.paint()
        self.assertEqual(self.starts(4), "bbbb")

    def test_a_machine_of_which_no_slot_paints_goes_on_trying_both(self):
        starts = self.starts(13)
        self.assertEqual(starts, "aaabbbaaabbba")

    def test_a_machine_of_which_no_slot_is_good_starts_one(self):
        self.machine.disk.set(a_OK=0, b_OK=0)
        self.assertEqual(self.machine.switch_on(), "a")

    def test_a_block_that_cannot_be_read_starts_slot_a_and_is_written_anew(self):
        self.machine.disk.spoil()
        self.assertEqual(self.machine.switch_on(), "a")
        self.machine.paint()
        values = self.machine.disk.values()
        self.assertEqual((values["ORDER"], values["CONFIRMED"], values["b_OK"]), ("a b", "a", "1"))
        self.assertEqual(self.starts(2), "aa")

    def test_words_that_are_none_start_slot_a(self):
        self.machine.disk.set(ORDER="x", a_TRY="many", CONFIRMED="neither")
        self.assertEqual(self.machine.switch_on(), "a")


class Block(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "grubenv")
        subprocess.run([grub.EDIT, self.file, "create"], check=True)

    def test_is_overwritten_in_place(self):
        os.truncate(self.file, 2048)  # what is behind the block stays
        before = os.stat(self.file)
        grub.write_block(self.file, ORDER="a b", a_OK=1)
        grub.write_block(self.file, a_OK=0)
        after = os.stat(self.file)
        self.assertEqual((before.st_ino, after.st_size), (after.st_ino, 2048))
        self.assertEqual(grub.read_block(self.file), {"ORDER": "a b", "a_OK": "0"})

    def test_names_that_begin_alike_are_told_apart(self):
        grub.write_block(self.file, a_TRY=1, a_TRYING=2)
        grub.write_block(self.file, a_TRY=3)
        self.assertEqual(grub.read_block(self.file), {"a_TRYING": "2", "a_TRY": "3"})
        subprocess.run([grub.EDIT, self.file, "unset", "a_TRY"], check=True)
        self.assertEqual(grub.read_block(self.file), {"a_TRYING": "2"})

    def test_what_does_not_fit_is_refused_and_changes_nothing(self):
        grub.write_block(self.file, ORDER="a b")
        with self.assertRaises(subprocess.CalledProcessError):
            subprocess.run([grub.EDIT, self.file, "set", "long=" + "x" * 1024], check=True, stderr=subprocess.DEVNULL)
        self.assertEqual(grub.read_block(self.file), {"ORDER": "a b"})


KERNEL = "/usr/lib/grub/x86_64-efi/kernel.img"


@unittest.skipUnless(os.path.exists(KERNEL), "grub-efi-amd64-bin is not installed")
class Greeting(unittest.TestCase):
    def test_is_taken_out_of_grub_and_missed_where_it_is_not(self):
        with tempfile.TemporaryDirectory() as folder:
            image = os.path.join(folder, "kernel.img")
            shutil.copy(KERNEL, image)
            silence = [os.path.join(grub.IMAGE, "silence-grub"), image]
            before = os.path.getsize(image)
            subprocess.run(silence, check=True)
            with open(image, "rb") as file:
                self.assertNotIn(b"Welcome to GRUB", file.read())
            self.assertEqual(os.path.getsize(image), before)
            again = subprocess.run(silence, capture_output=True, text=True)
            self.assertEqual(again.returncode, 1)
            self.assertIn("found 0 times", again.stderr)


if __name__ == "__main__":
    unittest.main()

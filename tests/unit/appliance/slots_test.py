#!/usr/bin/env python3
"""Which slot starts, over the life of a machine: GRUB's side (slots.cfg, run by GRUB's own interpreter) and the system's
(`slots`), which share a block of variables. RAUC's part is what its GRUB backend writes."""
import fcntl
import os
import shutil
import subprocess
import sys
import tempfile
import time
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

    def system(self, *command, seconds=120, words="", steady=False, installing=False, status=0):
        """Runs `slots` in the running system. Returns whether it restarts the machine. `installing`: an installation goes on."""
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
                "PLEINAIR_RESTART": f"touch {folder}/restarted", "PLEINAIR_SETTLED": f"touch {folder}/settled",
                "PLEINAIR_RELEASE": write("os-release", "IMAGE_VERSION=7.0\n"),
                "PLEINAIR_STEADY": write("steady", "") if steady else os.path.join(folder, "none")}
            # The machine calls GRUB's tool by its name.
            environment["PATH"] = os.path.join(grub.TOOLS, "bin") + ":" + environment["PATH"]
            with open(os.path.join(folder, "update.lock"), "w") as lock:
                if installing:
                    fcntl.flock(lock, fcntl.LOCK_EX)
                done = subprocess.run([SLOTS, *command], env=environment, capture_output=True, text=True, timeout=30)
            if done.returncode != status:
                raise AssertionError(f"status {done.returncode}: {done.stderr}")
            self.disk.store()
            self.is_settled = os.path.exists(os.path.join(folder, "settled"))
            notice = os.path.join(folder, "notice")
            self.notice = ""
            if os.path.exists(notice):
                with open(notice) as file:
                    self.notice = file.read().strip()
            return os.path.exists(os.path.join(folder, "restarted"))

    def paint(self, **how):
        self.system("confirm", **how)

    def begin_to_install(self, slot, version="2.0"):
        """What install-update writes, and then RAUC."""
        self.system("begin", version)
        self.disk.set(**{f"{slot}_OK": 0, f"{slot}_TRY": 0})

    def install(self, slot, version="2.0"):
        self.begin_to_install(slot, version)
        self.rauc_ends(slot)
        self.system("installed", version)

    def rauc_ends(self, slot):
        other = "b" if slot == "a" else "a"
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
        self.machine.begin_to_install("b")  # the power was cut while RAUC wrote
        self.assertEqual(self.starts(3), "aaa")
        self.machine.paint()
        self.assertEqual(self.machine.notice, "")

    def paints_in_a_and_has_updated_b(self, version="2.0"):
        self.machine.switch_on()
        self.machine.paint()
        self.machine.install("b", version)

    def values(self, *names):
        values = self.machine.disk.values()
        return tuple(values.get(name) for name in names)

    def test_a_confirmation_while_an_installation_goes_on_forgets_nothing(self):
        self.machine.switch_on()
        self.machine.begin_to_install("b", "2.0")
        self.machine.paint(installing=True)
        self.assertEqual(self.values("TRIAL", "ORDER", "CONFIRMED"), ("2.0", "a b", "a"))
        self.machine.rauc_ends("b")
        self.machine.paint(installing=True)
        self.assertEqual(self.values("TRIAL", "ORDER", "FAILED"), ("2.0", "b a", None))
        self.machine.system("installed", "2.0")
        self.machine.switch_on()
        self.assertTrue(self.machine.system("check", seconds=600))
        self.machine.switch_on()
        self.machine.paint()
        self.assertEqual(self.values("FAILED", "TRIAL"), ("2.0", ""))

    def test_a_version_that_waits_for_the_restart_has_not_failed(self):
        self.paints_in_a_and_has_updated_b()
        self.machine.paint()  # until the shutdown ends
        self.assertEqual(self.machine.notice, "")
        self.assertEqual(self.values("ORDER", "TRIAL", "b_OK", "FAILED"), ("b a", "2.0", "1", None))
        self.assertEqual(self.machine.switch_on(), "b")

    def test_a_version_that_is_half_written_over_one_that_failed_has_not_failed(self):
        self.paints_in_a_and_has_updated_b()
        self.assertEqual(self.starts(4), "bbba")
        self.machine.begin_to_install("b", "2.1")
        self.assertEqual(self.values("FAILED", "ORDER"), ("2.0", "a b"))
        self.machine.paint(installing=True)
        self.assertEqual(self.values("FAILED", "TRIAL"), ("2.0", "2.1"))
        self.assertEqual(self.starts(1), "a", "the power was cut")
        self.machine.paint()
        self.assertEqual(self.values("FAILED", "TRIAL", "ORDER"), ("2.0", "", "a b"))
        self.assertEqual(self.machine.notice, "")

    def test_what_another_program_has_left_half_written_in_front_has_not_failed(self):
        self.paints_in_a_and_has_updated_b()
        self.machine.running = "a"
        self.machine.disk.set(b_OK=0, b_TRY=0)
        self.machine.paint()
        self.assertEqual(self.values("ORDER", "FAILED"), ("a b", None))

    def test_the_newest_version_that_failed_is_remembered(self):
        for version in ("2.1", "2.0"):
            self.paints_in_a_and_has_updated_b(version)
            self.assertEqual(self.starts(4), "bbba")
            self.machine.paint()
            self.assertEqual(self.machine.notice, f"Version {version} did not paint here and was taken back.")
        self.assertEqual(self.values("FAILED"), ("2.1",))

    def test_a_version_whose_name_was_lost_is_remembered_by_its_own_word(self):
        self.paints_in_a_and_has_updated_b()
        self.machine.disk.set(TRIAL="", FAILED="1.0")
        self.machine.switch_on()
        self.assertTrue(self.machine.system("check", seconds=600))
        self.assertEqual(self.values("FAILED"), ("7.0",))

    def test_a_slot_that_cannot_be_named_is_not_called_by_an_older_failure(self):
        self.paints_in_a_and_has_updated_b()
        self.machine.disk.set(TRIAL="", FAILED="1.0")
        self.assertEqual(self.starts(4), "bbba")
        self.machine.paint()
        self.assertEqual(self.machine.notice, "The version in the other slot did not paint here and was taken back.")

    def test_the_slot_to_go_back_to_is_not_given_away(self):
        self.paints_in_a_and_has_updated_b()
        self.assertEqual(self.machine.switch_on(), "b")
        before = self.machine.disk.values()
        self.machine.system("begin", "2.1", status=3)
        self.assertEqual(self.machine.disk.values(), before)
        self.machine.paint()
        self.machine.install("a", "2.1")
        self.assertEqual(self.machine.switch_on(), "a")

    def test_a_confirmed_slot_that_is_overwritten_is_no_longer_confirmed(self):
        self.machine.switch_on()
        self.machine.disk.set(CONFIRMED="b", b_OK=0)
        self.machine.install("b")
        self.assertEqual(self.values("CONFIRMED"), ("",))

    def test_a_confirmation_that_did_not_come_through_is_made_up_for(self):
        self.paints_in_a_and_has_updated_b()
        self.machine.switch_on()
        self.assertFalse(self.machine.system("check", seconds=600, steady=True))
        self.assertEqual(self.values("CONFIRMED"), ("b",))
        self.assertTrue(self.machine.is_settled)

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

    def test_starts_that_were_used_up_are_remembered_until_a_slot_paints(self):
        self.starts(6)
        self.assertIn(self.values("EXHAUSTED"), [("",), (None,)])
        self.starts(1)
        self.assertEqual(self.values("EXHAUSTED"), ("1",))
        self.starts(1)
        self.assertEqual(self.values("EXHAUSTED"), ("1",), "it stays so from start to start")
        self.machine.paint()
        self.assertEqual(self.starts(2), "aa")
        self.assertEqual(self.values("EXHAUSTED"), ("",))

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

    def test_the_machines_words_are_given_to_every_version(self):
        self.machine.switch_on()
        self.assertIn("quiet", self.machine.disk.kernel_words)
        words = "pleinair.software_gl pleinair.trial_minutes=20"
        self.machine.disk.set(WORDS=words)
        for slot in "ab":
            self.assertEqual(self.machine.switch_on(), slot)
            given = self.machine.disk.kernel_words
            self.assertEqual(given[-2:], words.split())
            self.assertIn("pleinair.slot=" + slot, given)
            self.machine.paint()
            self.machine.install("b")
        self.assertEqual(self.values("WORDS"), (words,))

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

    def test_writers_wait_for_each_other(self):
        writers = [subprocess.Popen([grub.EDIT, self.file, "set", f"name_{i}={i}"]) for i in range(20)]
        self.assertEqual([each.wait(30) for each in writers], [0] * 20)
        self.assertEqual(grub.read_block(self.file), {f"name_{i}": str(i) for i in range(20)})

    def test_a_caller_that_has_the_lock_can_write(self):
        with open(self.file) as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            other = subprocess.Popen([grub.EDIT, self.file, "set", "other=1"])
            subprocess.run([grub.EDIT, self.file, "set", "own=1"], check=True, timeout=30,
                           env={**os.environ, "PLEINAIR_GRUBENV_LOCKED": "1"})
            self.assertIsNone(other.poll())
        self.assertEqual(other.wait(30), 0)
        self.assertEqual(grub.read_block(self.file), {"own": "1", "other": "1"})

    def test_a_slot_is_judged_by_what_no_other_writer_is_about_to_change(self):
        grub.write_block(self.file, ORDER="a b", a_OK=1, a_TRY=1, b_OK=0, b_TRY=0)
        folder = os.path.dirname(self.file)
        with open(os.path.join(folder, "cmdline"), "w") as file:
            file.write("pleinair.slot=a\n")
        environment = {**os.environ, "PATH": os.path.join(grub.TOOLS, "bin") + ":" + os.environ["PATH"],
                       "PLEINAIR_GRUBENV": self.file, "PLEINAIR_MACHINE": folder, "PLEINAIR_SETTLED": "true",
                       "PLEINAIR_CMDLINE": os.path.join(folder, "cmdline"), "PLEINAIR_GRUBENV_LOCKED": "1"}
        with open(self.file) as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            confirming = subprocess.Popen([SLOTS, "confirm"], env=environment, stdout=subprocess.DEVNULL)
            time.sleep(1)
            self.assertNotIn("CONFIRMED", grub.read_block(self.file))
            subprocess.run([grub.EDIT, self.file, "set", "ORDER=b a", "b_OK=1", "TRIAL=2.0"], check=True, env=environment)
        self.assertEqual(confirming.wait(30), 0)
        values = grub.read_block(self.file)
        self.assertEqual((values["ORDER"], values["TRIAL"], values["CONFIRMED"]), ("b a", "2.0", "a"))

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

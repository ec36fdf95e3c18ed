#!/usr/bin/env python3
"""Bundles as they are made, judged, and installed from a folder: each refusal is a line on the screen. RAUC itself reads them;
what it would write to slots is left out here (tests/system/appliance)."""
import fcntl
import os
import random
import shutil
import stat
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

UPDATE = os.path.join(grub.SOURCE, "appliance", "update")
INSTALL = os.path.join(grub.TOOLS, "install-update")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
MISSING = next((each for each in ("rauc", "mksquashfs", "veritysetup", "openssl", "dpkg", "flock")
                if not shutil.which(each, path=PATH)), None)

RAUC = """#!/bin/sh
case $1 in
  install)
    echo "installing"; echo " 40% Copying image to root.1"; echo "$2" >>"{folder}/installed"
    {edit} {folder}/grubenv set b_OK=0 b_TRY=0
    {outcome}
    {edit} {folder}/grubenv set "ORDER=b a" b_OK=1 b_TRY=0 ;;
  *) exec {rauc} --keyring={key}/update.crt "$@" ;;
esac
"""


def make(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                   env={**os.environ, "PATH": PATH})


@unittest.skipIf(MISSING, f"{MISSING} is not installed")
class Updates(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.made = folder.name
        cls.key, cls.other_key = (os.path.join(cls.made, name) for name in ("key", "other"))
        make(os.path.join(UPDATE, "make-key"), cls.key)
        make(os.path.join(UPDATE, "make-key"), cls.other_key)
        for name, size in (("root", 300_000), ("kernel", 50_000)):
            with open(os.path.join(cls.made, name), "wb") as file:
                file.write(random.Random(size).randbytes(size))  # does not shrink
        cls.good = cls.bundle("good", "2.0")

    @classmethod
    def bundle(cls, name, version, key=None, arch="amd64"):
        path = os.path.join(cls.made, name + ".raucb")
        key = key or cls.key
        make(os.path.join(UPDATE, "make-bundle"), version, arch, f"{key}/update.key", f"{key}/update.crt",
             f"{cls.made}/root", f"{cls.made}/kernel", path)
        return path

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.stick = os.path.join(self.folder, "stick")
        os.makedirs(self.stick)
        self.block = os.path.join(self.folder, "grubenv")
        subprocess.run([grub.EDIT, self.block, "create"], check=True)
        self.write("os-release", 'NAME="Debian"\nIMAGE_VERSION=1.5\n')
        self.write("system.conf", "[system]\ncompatible=pleinair-amd64\n")
        self.write("cmdline", "quiet pleinair.slot=a\n")
        self.write("uptime", "20.5 9.0\n")
        self.rauc_answers("true")

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)

    def rauc_answers(self, outcome):
        os.makedirs(os.path.join(self.folder, "bin"), exist_ok=True)
        self.write("bin/rauc", RAUC.format(folder=self.folder, outcome=outcome, key=self.key, edit=grub.EDIT,
                                           rauc=shutil.which("rauc", path=PATH)))
        os.chmod(os.path.join(self.folder, "bin/rauc"), 0o755)

    def put(self, bundle, name=None):
        shutil.copy(bundle, os.path.join(self.stick, name or os.path.basename(bundle)))

    def shorten(self, name, size):
        os.truncate(os.path.join(self.stick, name), size)

    def begin(self, *place, restart=None):
        """`place`: the script's arguments; else the stick."""
        environment = {
            **os.environ, "PLEINAIR_LIBRARY_FOLDER": grub.TOOLS, "PLEINAIR_MACHINE": os.path.join(self.folder, "run"),
            "PLEINAIR_RELEASE": os.path.join(self.folder, "os-release"), "PLEINAIR_GRUBENV": self.block,
            "PLEINAIR_RAUC": os.path.join(self.folder, "system.conf"),
            "PLEINAIR_CMDLINE": os.path.join(self.folder, "cmdline"), "PLEINAIR_UPTIME": os.path.join(self.folder, "uptime"),
            "PLEINAIR_RESTART": restart or f"touch {self.folder}/restarted", "PLEINAIR_LINGER": "1",
            "PATH": f"{self.folder}/bin:{grub.TOOLS}/bin:{PATH}"}
        process = subprocess.Popen([INSTALL, *(place or [self.stick])], env=environment, stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        return process

    def install(self, *place, restart=None):
        """Returns the exit status and what the screen says at the end."""
        done = self.begin(*place, restart=restart)
        self.said = done.communicate(timeout=60)[0]
        return done.returncode, self.notice()

    def notice(self):
        notice = os.path.join(self.folder, "run", "notice")
        if not os.path.exists(notice):
            return ""
        with open(notice) as file:
            return file.read().strip()

    def has(self, name):
        return os.path.exists(os.path.join(self.folder, name))

    def refused(self):
        """What the screen says of a stick from which nothing is to be installed."""
        status, notice = self.install()
        self.assertEqual(status, 3, notice)
        self.assertFalse(self.has("installed") or self.has("restarted"), notice)
        return notice

    def test_the_same_content_and_key_give_the_same_bytes(self):
        again = self.bundle("again", "2.0")
        with open(self.good, "rb") as one, open(again, "rb") as two:
            self.assertEqual(one.read(), two.read())

    def test_a_newer_version_is_installed_and_started(self):
        self.put(self.good)
        status, notice = self.install()
        self.assertEqual((status, notice), (0, "Version 2.0 is installed: the machine starts anew."))
        self.assertIn("Installing version 2.0: please leave the stick in and the power on.", self.said)
        self.assertTrue(self.has("installed") and self.has("restarted"))
        self.assertEqual(grub.read_block(self.block)["TRIAL"], "2.0")

    def test_a_file_is_installed_like_a_stick(self):
        self.assertEqual(self.install(self.good)[0], 0)
        self.assertTrue(self.has("installed"))

    def test_the_newest_of_several_is_taken(self):
        self.put(self.good)
        self.put(self.bundle("newest", "10.0"))
        self.put(self.bundle("middle", "9.0"), "z.raucb")
        self.put(self.bundle("wrong", "11.0", key=self.other_key))
        self.assertIn("10.0", self.install()[1])

    def test_a_stick_without_bundles_is_no_matter(self):
        with open(os.path.join(self.stick, "holiday.jpg"), "w") as file:
            file.write("x")
        self.assertEqual(self.install(), (0, ""))

    def test_an_older_version_is_refused(self):
        self.put(self.bundle("old", "1.4"))
        self.assertEqual(self.refused(), "old.raucb is older (version 1.4) than what this machine has (1.5).")

    def test_versions_are_compared_as_numbers_and_not_as_text(self):
        self.write("os-release", "IMAGE_VERSION=1.10\n")
        self.put(self.bundle("nine", "1.9"))
        self.assertIn("is older", self.refused())

    def test_a_candidate_comes_before_its_release(self):
        self.write("os-release", "IMAGE_VERSION=2.0\n")
        self.put(self.bundle("candidate", "2.0~rc1"))
        self.assertIn("is older", self.refused())

    def test_the_running_version_is_not_installed_again(self):
        self.put(self.bundle("same", "1.5"))
        self.assertEqual(self.refused(), "same.raucb is version 1.5, which this machine has.")

    def test_a_wrong_key_is_refused(self):
        self.put(self.bundle("foreign", "2.0", key=self.other_key))
        self.assertEqual(self.refused(), "foreign.raucb is signed with a key that this machine does not know.")

    def test_a_manifest_that_was_changed_is_refused(self):
        self.put(self.bundle("forged", "1.4"))
        path = os.path.join(self.stick, "forged.raucb")
        with open(path, "rb") as file:
            content = file.read()
        self.assertEqual(content.count(b"version=1.4"), 1)
        with open(path, "wb") as file:
            file.write(content.replace(b"version=1.4", b"version=9.4"))
        self.assertTrue(self.refused().startswith("forged.raucb "))

    def test_truncated_bundles_are_refused_wherever_they_were_cut(self):
        whole = os.path.getsize(self.good)
        for size in (0, 3, 4000, whole // 2, whole - 5000, whole - 100, whole - 1):
            with self.subTest(size=size):
                self.put(self.good, "cut.raucb")
                self.shorten("cut.raucb", size)
                notice = self.refused()
                self.assertIn("cut.raucb is not complete", notice)
                self.assertIn("copy it again", notice)
                if size == whole // 2:
                    self.assertRegex(notice, rf"\({size} bytes, and its content alone has \d+\)")

    def test_other_machines_bundles_are_refused(self):
        self.put(self.bundle("arm", "2.0", arch="arm64"))
        self.assertEqual(self.refused(), "arm.raucb is for other machines (pleinair-arm64; this is pleinair-amd64).")

    def test_other_files_of_that_name_are_refused(self):
        with open(os.path.join(self.stick, "song.raucb"), "wb") as file:
            file.write(b"ID3 " * 5000)
        self.assertEqual(self.refused(), "song.raucb is no update.")

    def test_a_version_that_was_taken_back_is_not_tried_again(self):
        grub.write_block(self.block, FAILED="2.0")
        self.put(self.good)
        self.assertEqual(self.refused(), "good.raucb is version 2.0, which did not paint here and was taken back.")
        self.put(self.bundle("mended", "2.0.1"))
        self.assertEqual(self.install()[0], 0, "a newer one is")

    def test_each_refusal_has_a_line(self):
        self.put(self.bundle("old", "1.4"))
        self.put(self.bundle("foreign", "2.0", key=self.other_key))
        self.assertEqual(len(self.refused().splitlines()), 2)

    def test_a_bundle_of_other_machines_does_not_change_what_this_machine_is(self):
        self.put(self.bundle("arm", "2.0", arch="arm64"), "a.raucb")
        self.put(self.good, "b.raucb")
        self.assertEqual(self.install()[0], 0)
        self.put(self.bundle("arm", "3.0", arch="arm64"), "a.raucb")
        self.put(self.bundle("arm", "3.0", arch="arm64"), "b.raucb")
        os.remove(os.path.join(self.folder, "run", "restarts"))
        self.assertEqual(self.install()[1].count("this is pleinair-amd64"), 2)

    def test_two_versions_that_fail_are_not_tried_in_turns(self):
        self.put(self.good)
        self.put(self.bundle("newer", "2.1"))
        grub.write_block(self.block, FAILED="2.1")
        self.assertEqual(self.refused(), "good.raucb is version 2.0, and version 2.1, which is newer, did not paint here and "
                                         "was taken back.\n"
                                         "newer.raucb is version 2.1, which did not paint here and was taken back.")

    def test_a_version_is_tried_again_where_a_person_asks_for_it(self):
        grub.write_block(self.block, FAILED="2.0")
        self.put(self.good)
        self.write("stick/retry", "")
        self.refused()  # at power on, a stick that was left in
        self.write("uptime", "181.0 9.0\n")
        self.assertEqual(self.install()[0], 0)

    def test_the_slot_to_go_back_to_is_not_overwritten_by_a_version_on_trial(self):
        grub.write_block(self.block, ORDER="a b", a_OK=1, a_TRY=1, b_OK=1, b_TRY=0, CONFIRMED="b")
        self.put(self.good)
        self.assertEqual(self.refused(), "Version 1.5 is still on trial: plug the stick in again once it has painted for a "
                                         "minute.")
        self.assertEqual(grub.read_block(self.block)["CONFIRMED"], "b")
        grub.write_block(self.block, b_OK=0)  # nothing to go back to
        self.assertEqual(self.install()[0], 0)
        self.assertEqual(grub.read_block(self.block)["CONFIRMED"], "", "it is overwritten")

    def test_a_failed_version_in_front_is_remembered_when_it_is_overwritten(self):
        grub.write_block(self.block, ORDER="b a", a_OK=1, b_OK=1, b_TRY=3, CONFIRMED="a", TRIAL="1.9")
        self.rauc_answers("exit 1")
        self.put(self.good)
        self.assertEqual(self.install()[0], 1)
        values = grub.read_block(self.block)
        self.assertEqual((values["ORDER"], values["FAILED"], values["TRIAL"]), ("a b", "1.9", ""))

    def test_the_version_in_use_is_written_anew_after_the_installation(self):
        self.rauc_answers(f"{grub.EDIT} {self.folder}/grubenv set TRIAL=")
        self.put(self.good)
        self.assertEqual(self.install()[0], 0)
        self.assertEqual(grub.read_block(self.block)["TRIAL"], "2.0")

    def test_links_and_hidden_files_are_left_out(self):
        os.symlink(self.good, os.path.join(self.stick, "link.raucb"))
        self.put(self.good, "._good.raucb")
        self.assertEqual(self.install(), (0, ""))

    def test_an_installation_that_fails_is_said_and_changes_nothing(self):
        self.rauc_answers("echo 'LastError: Installation error: Failed updating slot root.1: I/O error'; exit 1")
        self.put(self.good)
        status, notice = self.install()
        self.assertEqual(status, 1)
        self.assertEqual(notice, "Version 2.0 could not be installed: Installation error: Failed updating slot root.1: "
                                 "I/O error\nVersion 1.5 goes on.")
        self.assertFalse(self.has("restarted"))
        self.assertEqual(grub.read_block(self.block).get("TRIAL"), "")

    def test_an_installation_that_is_ended_is_said(self):
        self.rauc_answers("kill $PPID; sleep 0.2; exit 1")
        self.put(self.good)
        status, notice = self.install()
        self.assertNotIn(status, (0, 3))
        self.assertIn("Version 2.0 could not be installed", notice)
        self.assertEqual(grub.read_block(self.block).get("TRIAL"), "")

    def test_a_failure_is_no_refusal_whatever_its_number(self):
        self.rauc_answers("exit 3")
        self.put(self.good)
        self.assertEqual(self.install()[0], 1)

    def test_a_machine_that_cannot_restart_says_what_to_do(self):
        self.put(self.good)
        self.assertEqual(self.install(restart="false"), (1, "Version 2.0 is installed: switch the machine off and on."))

    def test_what_a_stick_has_shown_goes_with_it(self):
        self.put(self.bundle("old", "1.4"))
        self.refused()
        self.assertNotEqual(self.notice(), "")
        self.assertNotEqual(self.install("--gone", "/dev/other")[1], "")
        self.assertEqual(self.install("--gone", self.stick)[1], "")
        self.write("run/notice", "Version 2.0 did not paint here and was taken back.\n")
        self.assertNotEqual(self.install("--gone", self.stick)[1], "", "no stick has said that")

    def program(self, name, text):
        self.write("bin/" + name, "#!/bin/sh\n" + text)
        os.chmod(os.path.join(self.folder, "bin", name), 0o755)

    def device(self):
        """A block device whose content is that of the stick's folder, as far as `mount` is asked."""
        device = os.path.join(self.folder, "sdz1")
        try:
            os.mknod(device, 0o600 | stat.S_IFBLK, os.makedev(7, 99))
        except PermissionError:
            self.skipTest("only root makes devices")
        self.program("mount", f'echo "$@" >{self.folder}/mounted; for place; do :; done; cp {self.stick}/* "$place"/\n')
        self.program("umount", f'rm "$1"/*; echo "$@" >{self.folder}/unmounted\n')
        return device

    def test_a_device_is_mounted_read_only_and_let_go_whatever_happens(self):
        device, place = self.device(), os.path.join(self.folder, "run", "stick")
        self.put(self.bundle("old", "1.4"))
        for bundle, status in ((None, 3), (self.good, 0)):
            if bundle:
                self.put(bundle)
            self.assertEqual(self.install(device)[0], status)
            with open(os.path.join(self.folder, "mounted")) as file:
                self.assertEqual(file.read(), f"-o ro,nosuid,nodev,noexec {device} {place}\n")
            with open(os.path.join(self.folder, "unmounted")) as file:
                self.assertEqual(file.read(), place + "\n")
            os.remove(os.path.join(self.folder, "unmounted"))

    def test_what_a_device_has_shown_goes_with_it(self):
        device = self.device()
        self.put(self.bundle("old", "1.4"))
        self.assertIn("is older", self.install(device)[1])
        self.assertEqual(self.install("--gone", device)[1], "")

    def test_a_stick_that_is_pulled_while_it_is_judged_leaves_nothing_behind(self):
        self.put(self.bundle("old", "1.4"))
        self.write("bin/rauc", f"#!/bin/sh\nrm -r {self.stick}\nexit 1\n")
        self.assertEqual(self.install(), (3, ""))

    def test_a_stick_without_bundles_takes_away_what_it_had_shown_and_not_what_another_has(self):
        self.put(self.bundle("old", "1.4"))
        self.refused()
        other = os.path.join(self.folder, "other")
        os.mkdir(other)
        self.assertIn("is older", self.install(other)[1])
        os.remove(os.path.join(self.stick, "old.raucb"))
        self.assertEqual(self.install(), (0, ""))
        self.put(self.bundle("old", "1.4"))
        self.refused()
        shutil.rmtree(self.stick)
        self.assertEqual(self.install(other), (0, ""), "the one that had shown it is gone")

    def test_a_stick_that_cannot_be_read_is_said(self):
        device = self.device()
        self.program("mount", "exit 32\n")
        self.assertEqual(self.install(device), (3, "The stick cannot be read."))

    def test_a_block_that_cannot_be_written_is_said(self):
        self.put(self.good)
        os.remove(self.block)
        os.mkdir(self.block)
        status, notice = self.install()
        self.assertNotEqual(status, 0)
        self.assertFalse(self.has("installed"))
        self.assertIn("An update cannot be begun", notice)

    def test_what_a_stick_that_was_pulled_has_left_undone_is_said_for_a_while(self):
        self.rauc_answers(f"rm -r {self.stick}; exit 1")
        self.put(self.good)
        process = self.begin()
        lines = [process.stdout.readline() for _ in range(1)]
        self.assertIn("Installing version 2.0", lines[0])
        said = process.communicate(timeout=60)[0]
        self.assertIn("Version 2.0 could not be installed", said)
        self.assertEqual((process.returncode, self.notice()), (1, ""))

    def test_the_stick_that_the_running_version_came_from_is_not_announced(self):
        self.put(self.bundle("old", "1.4"))
        self.put(self.bundle("same", "1.5"))
        grub.write_block(self.block, TRIAL="1.5")
        self.assertEqual(self.install(), (0, ""))
        self.assertIn("is version 1.5, which this machine has", self.said)
        self.put(self.good)
        self.assertTrue(self.install()[1].startswith("Version 2.0 is installed"), "a newer one is taken all the same")

    def test_a_second_stick_waits_and_is_left_alone_while_the_machine_goes_down(self):
        self.rauc_answers("sleep 2")
        self.put(self.good)
        other = os.path.join(self.folder, "other")
        shutil.copytree(self.stick, other)
        first = self.begin()
        time.sleep(1)
        second = self.begin(other)
        self.assertEqual((first.wait(30), second.wait(30)), (0, 0))
        with open(os.path.join(self.folder, "installed")) as file:
            self.assertEqual(file.read(), os.path.join(self.stick, "good.raucb") + "\n")
        self.assertIn("Version 2.0 is installed", self.notice())

    def test_a_stick_that_was_pulled_while_it_waited_is_no_bundle(self):
        lock = os.path.join(self.folder, "run", "update.lock")
        os.makedirs(os.path.dirname(lock))
        with open(lock, "w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            waiting = self.begin()
            time.sleep(0.5)
            self.assertIsNone(waiting.poll())
            os.rmdir(self.stick)
        self.assertEqual(waiting.wait(30), 0)
        self.assertEqual(self.notice(), "")

    def test_a_failure_without_a_reason_is_said_in_its_last_words(self):
        self.rauc_answers("echo 'no bus'; exit 1")
        self.put(self.good)
        self.assertEqual(self.install()[1], "Version 2.0 could not be installed: no bus\nVersion 1.5 goes on.")

    def test_content_that_was_changed_is_found_when_it_is_read(self):
        self.put(self.good)
        path = os.path.join(self.stick, "good.raucb")
        with open(path, "r+b") as file:
            file.seek(5000)
            file.write(b"changed")
        unpacked = subprocess.run([f"{self.folder}/bin/rauc", "extract", path, f"{self.folder}/unpacked"],
                                  capture_output=True, text=True)
        self.assertNotEqual(unpacked.returncode, 0)
        self.assertIn("payload is corrupted", unpacked.stderr)
        unpacked = subprocess.run([f"{self.folder}/bin/rauc", "extract", self.good, f"{self.folder}/unpacked"],
                                  capture_output=True, text=True)
        self.assertEqual(unpacked.returncode, 0, unpacked.stderr)

    def test_a_certificate_is_valid_on_machines_without_a_clock(self):
        dates = subprocess.run(["openssl", "x509", "-in", f"{self.key}/update.crt", "-noout", "-dates"], check=True,
                               capture_output=True, text=True).stdout
        self.assertIn("notBefore=Jan  1 00:00:00 1970", dates)
        self.assertIn("notAfter=Dec 31 23:59:59 9999", dates)

    def test_a_key_is_not_overwritten(self):
        again = subprocess.run([os.path.join(UPDATE, "make-key"), self.key], capture_output=True, text=True)
        self.assertEqual(again.returncode, 1)
        self.assertIn("is there already", again.stderr)


if __name__ == "__main__":
    unittest.main()

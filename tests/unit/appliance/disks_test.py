#!/usr/bin/env python3
"""Disks with the same partitions are told apart: by the identity that the boot loader was read from, and where copies share
that, too, by whether a disk can be pulled; and the machine's own gets identities that its copies do not have."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import grub  # noqa: E402

A = "aaaaaaaa-0000-4000-8000-000000000000"
B = "bbbbbbbb-0000-4000-8000-000000000000"
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
DEVICES = {"vda": "pci0000:00/virtio0/block/vda", "sda": "pci0000:00/usb2/2-1/host2/block/sda",
           "mmcblk0": "platform/mmc0/block/mmcblk0"}
# udev's answer, from files.
UDEVADM = """#!/bin/sh
for word; do case $word in --name=*) cat "{folder}/udev/${{word##*/}}" ;; esac; done
"""


class Disks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for each in ("bin", "udev", "sys/class/block", "run/disk"):
            os.makedirs(os.path.join(self.folder, each))
        self.tool("udevadm", UDEVADM)

    def tool(self, name, text):
        path = os.path.join(self.folder, "bin", name)
        with open(path, "w") as file:
            file.write(text.format(folder=self.folder))
        os.chmod(path, 0o755)

    def add(self, disk, removable=False, **identities):
        """A disk with partitions: 4=A is partition 4 of identity A."""
        place = os.path.join(self.folder, "sys", "devices", DEVICES[disk])
        os.makedirs(place)
        os.symlink(place, os.path.join(self.folder, "sys/class/block", disk))
        with open(os.path.join(place, "removable"), "w") as file:
            file.write(f"{int(removable)}\n")
        for number, identity in identities.items():
            name = disk + ("p" if disk[-1].isdigit() else "") + number[1:]
            os.makedirs(os.path.join(place, name))
            with open(os.path.join(place, name, "partition"), "w") as file:
                file.write(number[1:] + "\n")
            os.symlink(os.path.join(place, name), os.path.join(self.folder, "sys/class/block", name))
            with open(os.path.join(self.folder, "udev", name), "w") as file:
                file.write(f"DEVTYPE=partition\nID_PART_ENTRY_UUID={identity}\nID_PART_ENTRY_NAME=root-a\n")

    def sh(self, script, *words, shell="sh"):
        done = subprocess.run(
            [shell, "-c", f". {grub.TOOLS}/disks; {script}", "-", *words], check=True, capture_output=True, text=True,
            env={"PATH": f"{self.folder}/bin:{PATH}", "sys": f"{self.folder}/sys"})
        return done.stdout.split()

    def test_a_partition_is_found_by_its_identity(self):
        self.add("vda", p4=A, p5=B)
        self.add("mmcblk0", p4="cccccccc-0000-4000-8000-000000000000")
        self.assertEqual(self.sh(f"partitions_of_identity {B}"), ["vda5"])
        self.assertEqual(self.sh("partitions_of_identity none"), [])
        self.assertEqual(self.sh("disk_of vda5; disk_of mmcblk0p4"), ["vda", "mmcblk0"])

    def test_of_copies_the_disk_that_stays_is_taken(self):
        self.add("sda", p4=A)  # before vda by its name
        self.add("vda", p4=A)
        self.assertEqual(self.sh(f"choose_fixed $(partitions_of_identity {A})"), ["vda4"])

    def test_a_disk_may_say_itself_that_it_can_be_pulled(self):
        self.add("mmcblk0", removable=True, p4=A)
        self.add("vda", p4=A)
        self.assertEqual(self.sh(f"choose_fixed $(partitions_of_identity {A})"), ["vda4"])

    def test_a_stick_alone_is_taken(self):
        self.add("sda", p4=A)
        self.assertEqual(self.sh(f"choose_fixed $(partitions_of_identity {A})"), ["sda4"])

    def test_the_machine_started_from_a_stick_runs_from_it(self):
        self.add("vda", p4=B)
        self.add("sda", p4=A)
        self.assertEqual(self.sh(f"choose_fixed $(partitions_of_identity {A})"), ["sda4"])

    # own-disk, on a file in place of a disk.

    def table(self):
        return subprocess.run(["sfdisk", "--dump", f"{self.folder}/disk"], check=True, capture_output=True, text=True,
                              env={"PATH": PATH}).stdout

    def own_disk(self, *stock):
        """Returns the table of partitions before and after."""
        disk = os.path.join(self.folder, "disk")
        with open(disk, "wb") as file:
            file.truncate(8 << 20)
        layout = f'label: gpt\nsize=1M, name="esp"\nsize=1M, uuid={A}, name="root-a"\nsize=1M, uuid={B}, name="root-b"\n'
        subprocess.run(["sfdisk", "--quiet", disk], input=layout, check=True, text=True, env={"PATH": PATH})
        # The script calls a disk /dev/NAME.
        self.tool("sfdisk", "#!/bin/bash\nexec " + shutil.which("sfdisk", path=PATH) + ' "${{@/#\\/dev\\/vda/{folder}\\/disk}}"\n')
        with open(os.path.join(self.folder, "run", "disk", "vda"), "w"):
            pass
        before = self.table()
        subprocess.run([os.path.join(grub.TOOLS, "own-disk"), *stock], check=True, capture_output=True, env={
            "PATH": f"{self.folder}/bin:{PATH}", "sys": f"{self.folder}/sys", "PLEINAIR_MACHINE": f"{self.folder}/run",
            "PLEINAIR_LIBRARY": f"{grub.TOOLS}/disks"})
        return before.splitlines(), self.table().splitlines()

    def assertOnlyRootsChange(self, before, after, count):
        changed = [(old, new) for old, new in zip(before, after) if old != new]
        self.assertEqual((len(before), len(changed)), (len(after), count), after)
        for old, new in changed:
            self.assertIn('name="root-', old)
            self.assertEqual([part for part in old.split(",") if "uuid=" not in part],
                             [part for part in new.split(",") if "uuid=" not in part])

    @unittest.skipUnless(shutil.which("sfdisk", path=PATH), "sfdisk is not installed")
    def test_the_identities_of_the_image_are_replaced(self):
        self.add("vda", p2=A, p3=B)
        self.assertOnlyRootsChange(*self.own_disk(A, B), 2)

    @unittest.skipUnless(shutil.which("sfdisk", path=PATH), "sfdisk is not installed")
    def test_those_of_a_copy_are_replaced(self):
        self.add("vda", p2=A, p3=B)
        self.add("sda", p2=A, p3="cccccccc-0000-4000-8000-000000000000")
        self.assertOnlyRootsChange(*self.own_disk("other", "others"), 1)

    @unittest.skipUnless(shutil.which("sfdisk", path=PATH), "sfdisk is not installed")
    def test_identities_of_its_own_stay(self):
        self.add("vda", p2=A, p3=B)
        before, after = self.own_disk("other", "others")
        self.assertEqual(before, after)


if __name__ == "__main__":
    unittest.main()

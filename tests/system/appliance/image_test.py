#!/usr/bin/env python3
"""Scenarios of the machine image and of its updates, in QEMU but for one. Each takes from two minutes to an hour and a half.

    image_test.py FOLDER_OF_IMAGES RESULTS prepare       makes what the others need, from `./dev image`'s root
    image_test.py FOLDER_OF_IMAGES RESULTS SCENARIO      boot, crashes, install, updates, copies, data_corrupted, data_lost,
                                                 data_read_only, data_full, clock, late, wrong_sites, hung, slots_bad, gpu_lost, soak,
                                                 soak_in_chroot, or power_cut:SEED

Exit status: 0; 1; 77, a skip: there is no image (./dev package; ./dev image), or a program is missing.
"""
import contextlib
import fcntl
import hashlib
import os
import random
import shutil
import subprocess
import sys
import time
import traceback

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.path.insert(1, os.path.dirname(sys.path[0]))

import bad_days  # noqa: E402
import kiosk  # noqa: E402
import soak  # noqa: E402
from boot import CONTROL_UNIT, boot  # noqa: E402
from kiosk import ARCH, CONFIRM_MINUTES, Failed, Kiosk, kernel_of, set_up  # noqa: E402

SKIPPED = 77
# Of the machine, whatever its version: software GL, the kernel's virtual camera, and the journal on the serial port.
WORDS = f"{kiosk.check.WORDS} console=ttyS0 systemd.journald.forward_to_console=1"
VERSION_WORDS = "pleinair.trial_minutes={}"
# A real-time thread that the emulation slows down has used up its time, and is killed for it (LimitRTTIME=).
EMULATED = "[Service]\nLimitRTPRIO=0\n"
HANGING_SERVICE = "[Service]\nType=simple\nWatchdogSec=0\nExecStart=\nExecStart=/usr/bin/sleep infinity\n"
# What make-disk takes from the tree.
BOOT_FILES = [os.path.join(kiosk.SOURCE, "appliance", "image", name)
              for name in ("cannot-start.jpg", "cmdline", "genimage.cfg.in", "grub.cfg", "make-disk", "slots.cfg")]
# The program that a preloaded library tells of a lost GPU.
LOSING_SERVICE = EMULATED + "Environment=LD_PRELOAD=/usr/lib/pleinair/lost_gpu.so\n"
CRASHING_SERVICE = "[Service]\nExecStart=\nExecStart=/usr/bin/false\n"
CONFIRMED = r"slot {} is confirmed"


class Images:
    """What `./dev image` has made, and disks and bundles of other versions of the same system."""

    def __init__(self, folder):
        self._folder = folder
        self._made = os.path.join(folder, "scenarios")
        self._keys = os.environ.get("PLEINAIR_UPDATE_KEY", os.path.join(os.path.dirname(folder), "update-key"))
        self._tar = os.path.join(folder, f"root-{ARCH}.tar")

    def missing(self):
        if not os.path.exists(self._tar):
            return f"there is no {self._tar}: ./dev package; ./dev image"
        programs = ("qemu-system-x86_64", "qemu-img", "rauc", "mcopy", "genimage")
        return next((each + " is not installed" for each in programs if not shutil.which(each)), None)

    def _make(self, version, minutes, kiosk_settings=EMULATED, keys=None, control=None, libraries=()):
        """`kiosk_settings`: a drop-in of the service that paints. `control`: a unit of the machine's start. `libraries`: files that
        go beside the program's own."""
        with self._locked(version):
            return self._made_anew_or_kept(version, minutes, kiosk_settings, keys, control, libraries)

    @contextlib.contextmanager
    def _locked(self, name):
        """Against another scenario of the same folder."""
        os.makedirs(self._made, exist_ok=True)
        with open(os.path.join(self._made, name + ".lock"), "w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield

    def _made_anew_or_kept(self, version, minutes, kiosk_settings, keys, control, libraries):
        output = os.path.join(self._made, version)
        done = os.path.join(output, "done")
        stamp = f"{os.path.getmtime(self._tar)} {VERSION_WORDS.format(minutes)} {kiosk_settings} {control} {kiosk.COMMANDS}"
        stamp = " ".join([stamp, *(digest(each) for each in (*libraries, *BOOT_FILES))])
        if os.path.exists(done) and open(done).read() == stamp:
            return output
        shutil.rmtree(output, ignore_errors=True)
        command = [os.path.join(kiosk.SOURCE, "appliance", "image", "make-disk"), ARCH, self._tar, version,
                   keys or self._keys, output]
        overlay = os.path.join(self._made, "overlay-" + version)
        shutil.rmtree(overlay, ignore_errors=True)
        place = os.path.join(overlay, "etc", "systemd", "system", "pleinair-kiosk.service.d")
        os.makedirs(place)
        with open(os.path.join(place, "scenario.conf"), "w") as file:
            file.write(kiosk_settings)
        for each in libraries:
            library = os.path.join(overlay, "usr", "lib", "pleinair", os.path.basename(each))
            os.makedirs(os.path.dirname(library), exist_ok=True)
            shutil.copy(each, library)
        units = os.path.dirname(place)
        for name, content, target in (("control", control, "sysinit"), ("commands", kiosk.COMMANDS, "pleinair-display")):
            if not content:
                continue
            with open(os.path.join(units, name + ".service"), "w") as file:
                file.write(content)
            wanted = os.path.join(units, target + ".target.wants")
            os.mkdir(wanted)
            os.symlink(f"../{name}.service", os.path.join(wanted, name + ".service"))
        began = time.monotonic()
        subprocess.run(command + [overlay], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       env={**os.environ, "PLEINAIR_KERNEL_WORDS": VERSION_WORDS.format(minutes)})
        print(f"version {version} was made in {time.monotonic() - began:.0f} s", flush=True)
        with open(done, "w") as file:
            file.write(stamp)
        return output

    def tar(self):
        """The system, as `./dev image` has installed it."""
        return self._tar

    def disk(self):
        return self._disk("1.0")

    def timed_disk(self):
        """Version 0.6, which says when a unit without dependencies has run."""
        return self._disk("0.6", control=CONTROL_UNIT)

    def crashing_disk(self):
        """Version 0.5, whose service ends at once whenever it is started."""
        return self._disk("0.5", CRASHING_SERVICE)

    def losing_disk(self):
        """Version 0.7, whose GPU is lost for as long as there is /run/lost-gpu (programs/lost_gpu.cpp)."""
        library = os.environ.get("PLEINAIR_TEST_LOST_GPU")
        if not library:
            raise Failed("PLEINAIR_TEST_LOST_GPU is to name tests/system/programs' lost_gpu")
        named = os.path.join(self._made, "lost_gpu.so")
        shutil.copy(library, named)
        return self._disk("0.7", LOSING_SERVICE, libraries=(named,))

    def _disk(self, version, kiosk_settings=EMULATED, control=None, libraries=()):
        with self._locked("disks"):
            certificate = os.path.join(self._made, "certificate")  # without a key there is no bundle, which takes longest
            os.makedirs(certificate, exist_ok=True)
            shutil.copy(os.path.join(self._keys, "update.crt"), certificate)
            folder = self._make(version, 40, kiosk_settings, certificate, control, libraries)
            disk = os.path.join(folder, f"pleinair-{ARCH}.img")
            if boot_block(disk, folder).get("WORDS") != WORDS:
                kiosk.check.add_words(disk, folder, WORDS)
            return disk

    def bundle(self, version="2.0"):
        return os.path.join(self._make(version, 40), f"pleinair-{ARCH}-{version}.raucb")

    def hanging_bundle(self):
        """Version 3.0, which starts and does not paint."""
        return os.path.join(self._make("3.0", 3, HANGING_SERVICE), f"pleinair-{ARCH}-3.0.raucb")

    def small_bundle(self, folder, name, version, keys=None):
        """One of which only the signature and the version matter."""
        content = os.path.join(folder, "content")
        with open(content, "wb") as file:
            file.write(random.Random(1).randbytes(1 << 20))
        path = os.path.join(folder, name)
        keys = keys or self._keys
        kiosk.run(os.path.join(kiosk.SOURCE, "appliance", "update", "make-bundle"), version, ARCH, f"{keys}/update.key",
                  f"{keys}/update.crt", content, content, path)
        return path

    SAVED = "confirmed"

    def confirmed_disk(self):
        """A qcow2 file that holds a machine which has painted for a minute: Kiosk(…, ("-loadvm", SAVED)) goes on from there, and
        spares each power cut of such a machine the minutes until then."""
        raw = self.disk()
        path = os.path.join(os.path.dirname(raw), self.SAVED + ".qcow2")
        with self._locked(self.SAVED):
            # A saved machine goes on in the same one only.
            stamp = " ".join([str(os.path.getmtime(raw)), *kiosk.check.EMULATORS[ARCH][0], subprocess.run(
                ["qemu-system-x86_64", "--version"], check=True, capture_output=True, text=True).stdout])
            stamp_file = path + ".stamp"
            if os.path.exists(path) and os.path.exists(stamp_file) and open(stamp_file).read() == stamp:
                return path
            folder = os.path.join(os.path.dirname(raw), self.SAVED)
            os.makedirs(folder, exist_ok=True)
            disk = kiosk.copy_as_qcow2(raw, os.path.join(folder, "disk.qcow2"))
            with Kiosk(disk, folder) as machine:
                machine.wait_for(CONFIRMED.format("a"), CONFIRM_MINUTES)
                machine.save(self.SAVED)
            os.rename(disk, path)
            with open(stamp_file, "w") as file:
                file.write(stamp)
            return path


def updates(images, folder):
    """Bundles that are wrong are refused; a newer version is installed and stays; one that does not paint goes back."""
    foreign = os.path.join(folder, "foreign-key")
    kiosk.run(os.path.join(kiosk.SOURCE, "appliance", "update", "make-key"), foreign)
    truncated = os.path.join(folder, "cut.raucb")
    with open(images.bundle(), "rb") as whole, open(truncated, "wb") as part:
        part.write(whole.read(30 << 20))
    wrong = kiosk.stick(os.path.join(folder, "wrong.img"), truncated,
                        images.small_bundle(folder, "foreign.raucb", "9.0", foreign),
                        images.small_bundle(folder, "old.raucb", "0.9"))
    good = kiosk.stick(os.path.join(folder, "good.img"), images.bundle())
    hanging = kiosk.stick(os.path.join(folder, "hanging.img"), images.hanging_bundle())
    # Without a site file, the screen says how to set the machine up.
    disk = kiosk.overlay(set_up(images.disk(), folder), os.path.join(folder, "disk.qcow2"))
    with Kiosk(disk, folder) as machine:
        machine.wait_for(CONFIRMED.format("a"), CONFIRM_MINUTES)
        if machine.screen("1-painting").has_caption():
            raise Failed("the screen says something")

        machine.plug_in(wrong)
        machine.wait_for(r"cut\.raucb is not complete", 10)
        for line in ("foreign.raucb is signed with a key that this machine does not know.",
                     "old.raucb is older (version 0.9) than what this machine has (1.0)."):
            machine.wait_for(line.replace("(", r"\(").replace(")", r"\)"), 1)
        machine.shows_caption("2-refused", True)
        machine.pull()
        machine.shows_caption("2-pulled", False)
        if machine.has_said("Installing version"):
            raise Failed("something was installed")

        machine.plug_in(good)
        machine.wait_for("Installing version 2.0", 10)
        machine.shows_caption("3-installing", True)
        machine.wait_for("Version 2.0 is installed", 60)
        machine.wait_for(CONFIRMED.format("b"), CONFIRM_MINUTES)
        machine.screen("4-updated")
        machine.pull()

        machine.plug_in(hanging)
        machine.wait_for("Version 3.0 is installed", 60)
        machine.wait_for("slot a has not painted for a minute", 30)
        machine.pull()
        machine.wait_for("Version 3.0 did not paint here and was taken back", CONFIRM_MINUTES)
        machine.wait_for(CONFIRMED.format("b"), 1)
        machine.shows_caption("5-taken-back", True)


# In place of init: udev and its rules, the mounts that RAUC needs, RAUC's service, and what udev starts for a stick.
INSTALL = """export PATH=/usr/sbin:/usr/bin:/sbin:/bin PLEINAIR_RESTART='echo RESTARTS'
mount -t tmpfs tmp /tmp
mount -t tmpfs var /var
ln -s ../run /var/run
ls /run/pleinair-machine/disk
/lib/systemd/systemd-udevd --daemon
udevadm trigger --action=add
udevadm settle
ls -l /dev/pleinair
mount -t vfat /dev/pleinair/esp /boot/efi
mkdir -p /run/dbus /run/rauc
modprobe -a loop squashfs
dbus-daemon --system --fork
PATH=/usr/lib/pleinair/bin:$PATH rauc --mount=/run/rauc service &
sleep 5
/usr/lib/pleinair/install-update /dev/vdb
echo "STATUS $?"
cat /run/pleinair-machine/notice
umount /boot/efi
sync
echo END
echo o >/proc/sysrq-trigger
sleep 60
"""


def crashes(images, folder):
    """A service that ends at once, over and over, gives way to the rescue picture, and is started again after it."""
    disk = kiosk.overlay(images.crashing_disk(), os.path.join(folder, "disk.qcow2"))
    with Kiosk(disk, folder) as machine:
        machine.wait_for("Started pleinair-rescue@pleinair-kiosk.service", 15)
        machine.screen("1-rescue")
        for again in ("once", "twice"):
            machine.wait_for(r"pleinair-rescue@pleinair-kiosk\.service: Triggering OnSuccess", 15)
            machine.wait_for("Starting pleinair-kiosk.service", 1)
            print(f"the service was started again, {again}", flush=True)
            machine.wait_for("Started pleinair-rescue@pleinair-kiosk.service", 5)


def partition(disk, name, size):
    """The first bytes of a partition of a raw disk."""
    with open(disk, "rb") as file:
        file.seek(kiosk.check.partitions(disk)[name])
        return hashlib.sha256(file.read(size)).hexdigest()


def boot_block(disk, folder):
    file = os.path.join(folder, "grubenv")
    kiosk.run("mcopy", "-n", "-o", "-i", f"{disk}@@{kiosk.check.partitions(disk)['esp']}", "::EFI/BOOT/grubenv", file)
    with open(file, "rb") as content:
        lines = content.read().decode().splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line)


def install(images, folder):
    """RAUC itself installs a bundle into the other slot, called by what udev starts for a stick; refused ones leave it alone."""
    disk = os.path.join(folder, "disk.img")
    kiosk.run("cp", "--sparse=always", images.disk(), disk)
    kernel = kernel_of(images.disk())
    script = os.path.join(folder, "script.sh")
    with open(script, "w") as file:
        file.write(INSTALL)
    made = os.path.dirname(images.bundle())
    sizes = {part: os.path.getsize(os.path.join(made, f"{part}-{ARCH}.{kind}"))
             for part, kind in (("root", "verity"), ("kernel", "vfat"))}
    before = {part: partition(disk, f"{part}-b", size) for part, size in sizes.items()}
    old = kiosk.stick(os.path.join(folder, "old.img"), images.small_bundle(folder, "old.raucb", "0.9"))
    said = kiosk.run_in_system(disk, kernel, script, old, folder, 60)
    if "STATUS 3" not in said or "old.raucb is older (version 0.9)" not in said or "RESTARTS" in said:
        raise Failed(said)
    if before != {part: partition(disk, f"{part}-b", size) for part, size in sizes.items()}:
        raise Failed("slot b was written to")
    good = kiosk.stick(os.path.join(folder, "good.img"), images.bundle())
    said = kiosk.run_in_system(disk, kernel, script, good, folder, 60)
    if "STATUS 0" not in said or "RESTARTS" not in said:
        raise Failed(said)
    for part, kind in (("root", "verity"), ("kernel", "vfat")):
        with open(os.path.join(made, f"{part}-{ARCH}.{kind}"), "rb") as file:
            if hashlib.sha256(file.read()).hexdigest() != partition(disk, f"{part}-b", sizes[part]):
                raise Failed(f"{part}-b is not what the bundle holds")
    block = boot_block(disk, folder)
    if (block["ORDER"], block["b_OK"], block["b_TRY"], block["TRIAL"]) != ("b a", "1", "0", "2.0"):
        raise Failed(str(block))


def digest(file):
    with open(file, "rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()


def copies(images, folder):
    """A stick with a copy of the image beside the machine's disk: not a byte of it is written."""
    copy = os.path.join(folder, "copy.img")
    kiosk.run("cp", "--sparse=always", images.disk(), copy)
    before = digest(copy)
    disk = kiosk.overlay(images.disk(), os.path.join(folder, "disk.qcow2"))
    devices = ("-drive", f"file={copy},if=none,id=copy,format=raw", "-device", "usb-storage,bus=usb.0,drive=copy")
    with Kiosk(disk, folder, devices) as machine:
        machine.wait_for("the root slots of vda have identities of their own now", 30)
        machine.wait_for(CONFIRMED.format("a"), CONFIRM_MINUTES)
    if digest(copy) != before:
        raise Failed("the copy was written to")


# What the machine is at when its power is cut, and for how many seconds the cut may be waited for: a whole first start, a
# painting machine's own writing, the reading of a medium, and an installation with the start of the new version.
PHASES = {"first start": 150, "painting": 60, "provisioning": 60, "update": 240}


def power_cut(images, folder, seed):
    """The emulator is killed at a moment that the seed chooses; the machine then starts and paints. After an update it confirms
    the slot that it runs from. No version has failed."""
    chance = random.Random(seed)
    phase = list(PHASES)[seed % len(PHASES)]
    disk = os.path.join(folder, "disk.qcow2")
    if phase in ("painting", "update"):
        kiosk.run("cp", "--sparse=always", images.confirmed_disk(), disk)
        devices = ("-loadvm", images.SAVED)
    else:
        kiosk.overlay(images.disk() if phase == "first start" else set_up(images.disk(), folder), disk)
        devices = ()
    moment = chance.uniform(0, PHASES[phase])
    with Kiosk(disk, folder, devices) as machine:
        if phase == "provisioning":
            machine.wait_for("Mounted.*set up by", 30)
        if phase == "update":
            machine.plug_in(kiosk.stick(os.path.join(folder, "good.img"), images.bundle()))
            machine.wait_for("Installing version 2.0", 10)
        time.sleep(moment)
        machine.cut_power()
    print(f"seed {seed}: the power was cut {moment:.1f} s into: {phase}", flush=True)
    with Kiosk(disk, os.path.join(folder, "after")) as machine:
        print(f"painting again after {machine.paints(CONFIRM_MINUTES):.0f} s", flush=True)
        if phase == "update":
            machine.wait_for(CONFIRMED.format("[ab]"), CONFIRM_MINUTES)
        if machine.has_said("taken back"):
            raise Failed("a version was taken back")
    raw = os.path.join(folder, "after.img")
    kiosk.run("qemu-img", "convert", "-O", "raw", disk, raw)
    block = boot_block(raw, folder)
    # Before a minute of paintings, nothing says which slot is confirmed; it can only be the first one.
    running = block.get("CONFIRMED", "") if phase in ("painting", "update") else "a"
    if (block.get("FAILED") or not running or (phase != "update" and running != "a") or
            not block.get("ORDER", "").startswith(running) or block.get(f"{running}_OK") != "1"):
        raise Failed(str(block))
    for name in os.listdir(folder):
        if name.endswith((".img", ".qcow2")):
            os.remove(os.path.join(folder, name))


def soak_painting(images, folder):
    """A machine paints for half an hour."""
    disk = kiosk.overlay(images.disk(), os.path.join(folder, "disk.qcow2"))
    with Kiosk(disk, folder) as machine:
        soak.soak_machine(machine, CONFIRMED.format("a"), CONFIRM_MINUTES)


SCENARIOS = {**bad_days.SCENARIOS, "boot": boot, "crashes": crashes, "updates": updates, "copies": copies, "install": install,
             "soak": soak_painting,
             "soak_in_chroot": lambda images, folder: soak.soak_chroot(images.tar(), folder)}


def main():
    images, results, name = Images(os.path.abspath(sys.argv[1])), sys.argv[2], sys.argv[3]
    missing = images.missing()
    if missing:
        print("skipped:", missing)
        return SKIPPED
    if name == "prepare":
        images.disk()
        images.bundle()
        images.hanging_bundle()
        images.confirmed_disk()
        return 0
    if name == "soak_in_chroot" and os.geteuid():
        print("skipped: it takes root to enter the system")
        return SKIPPED
    folder = os.path.join(os.path.abspath(results), name.replace(":", "-"))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    try:
        if name.startswith("power_cut:"):
            power_cut(images, folder, int(name.split(":")[1]))
        else:
            SCENARIOS[name](images, folder)
    except Failed:
        traceback.print_exc(file=sys.stdout)
        print("all it left:", folder)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Bad days of a machine on the built image: its data partition, its clock, its devices, what it is set up by, and a presenter that
hangs. Each ends in a painting."""
import os
import re
import subprocess
import time

import kiosk
from kiosk import Failed, Kiosk, check

MINUTES = 45  # to a painting: 3 on an idle machine
# The watchdog's 10 s and the 5 s in which a stopped process does not end by itself, in the machine's own time.
MOST_TO_RESTART = 15
LOST_MINUTES = 6
REPAIRED = "FILE SYSTEM WAS MODIFIED"
IN_MEMORY = "lie in memory: the data partition cannot be written to"
# Neither the virtual camera's driver nor the card's is loaded by itself. QEMU plugs in no card while a machine runs.
NEITHER = (f"pleinair.software_gl {check.UNMITIGATED} modprobe.blacklist=virtio_gpu console=ttyS0 "
           "systemd.journald.forward_to_console=1")
# A site.toml, and what the journal says of it.
WRONG_SITES = (
    ("[painting\n", r"site\.toml:1: not TOML"),
    ("[painting]\nlok = \"oil\"\nlook = 3\n[output]\nlatency_ms = -5\n", r"site\.toml:2.*lok"),
)


def _copy(disk, folder):
    raw = os.path.join(folder, "disk.img")
    kiosk.run("cp", "--sparse=always", disk, raw)
    return raw


class Partition:
    """A partition of a raw disk as a file of its own, which is written back at the end of `with`."""

    def __init__(self, disk, name):
        self._disk, self._file = disk, os.path.join(os.path.dirname(disk), name + ".part")
        places = check.partitions(disk)
        self._begin = places[name]
        later = [each for each in places.values() if each > self._begin]
        # What lies behind the last one is the table's copy.
        self._end = min(later) if later else os.path.getsize(disk) - (1 << 20)

    def __enter__(self):
        with open(self._disk, "rb") as disk, open(self._file, "wb") as file:
            disk.seek(self._begin)
            file.write(disk.read(self._end - self._begin))
        return self._file

    def __exit__(self, *error):
        with open(self._file, "rb") as file, open(self._disk, "r+b") as disk:
            disk.seek(self._begin)
            disk.write(file.read())
        os.remove(self._file)


def _paints_without_data(disk, folder):
    with Kiosk(kiosk.overlay(disk, os.path.join(folder, "disk.qcow2")), folder) as machine:
        print(f"painting after {machine.paints(MINUTES):.0f} s", flush=True)
        if not machine.has_said(IN_MEMORY):
            raise Failed("the data partition was written to: " + machine.journal()[-2000:])
    os.remove(disk)


def _fill_with_noise(disk, most=None):
    """The data partition, or its first bytes."""
    with Partition(disk, "data") as file, open(file, "r+b") as content:
        content.write(os.urandom(most or os.path.getsize(file)))


def data_corrupted(images, folder):
    """The first megabytes of the data partition are noise: it is repaired from its other superblocks."""
    disk = _copy(images.disk(), folder)
    _fill_with_noise(disk, 4 << 20)
    with Kiosk(kiosk.overlay(disk, os.path.join(folder, "disk.qcow2")), folder) as machine:
        print(f"painting after {machine.paints(MINUTES):.0f} s", flush=True)
        if machine.has_said(IN_MEMORY) or not machine.has_said(REPAIRED):
            raise Failed("the data partition was not repaired: " + machine.journal()[-2000:])
        if "ext4" not in machine.run("findmnt -n -o FSTYPE /data"):
            raise Failed("the data partition is not in use")
    os.remove(disk)


def data_lost(images, folder):
    """All of the data partition is noise."""
    disk = _copy(images.disk(), folder)
    _fill_with_noise(disk)
    _paints_without_data(disk, folder)


def data_read_only(images, folder):
    """The data partition's file system may not be written to."""
    disk = _copy(images.disk(), folder)
    with Partition(disk, "data") as file:
        kiosk.run("/sbin/tune2fs", "-O", "read-only", file)
    _paints_without_data(disk, folder)


def data_full(images, folder):
    """The data partition has no block left, not even root's."""
    disk = _copy(images.disk(), folder)
    filling = os.path.join(folder, "filling")
    with Partition(disk, "data") as file:
        with open(filling, "wb") as content:
            content.write(os.urandom(os.path.getsize(file)))
        subprocess.run(["/sbin/debugfs", "-w", "-R", f"write {filling} filling", file], check=True, capture_output=True)
        said = subprocess.run(["/sbin/debugfs", "-R", "stats", file], check=True, capture_output=True, text=True).stdout
        if not re.search(r"Free blocks:\s+0\b", said):
            raise Failed("it is not full")
    os.remove(filling)
    _paints_without_data(disk, folder)


def _service(machine):
    return machine.run("systemctl show --value -p MainPID pleinair-kiosk").strip()


def clock(images, folder):
    """The clock is at 1970 at power on, and then jumps by a year, forth and back."""
    disk = kiosk.overlay(images.disk(), os.path.join(folder, "disk.qcow2"))
    with Kiosk(disk, folder, ("-rtc", "base=1970-01-01T00:00:10")) as machine:
        print(f"painting after {machine.paints(MINUTES):.0f} s; the clock says " + machine.run("date -u").strip(), flush=True)
        service = _service(machine)
        for jump in ("+1 year", "-1 year", "-30 seconds"):
            machine.run(f"date -s '{jump}'")
            machine.goes_on_painting("after " + jump.replace(" ", "-"))
        if _service(machine) != service:
            raise Failed("the service was started again")


def late(images, folder):
    """The drivers of the card and of the camera come late: the card's half a minute after the service's start, and then the
    camera's."""
    disk = _copy(images.disk(), folder)
    check.add_words(disk, folder, NEITHER)
    with Kiosk(kiosk.overlay(disk, os.path.join(folder, "disk.qcow2")), folder) as machine:
        machine.wait_for("waiting for an output", 15)
        time.sleep(30)
        service = _service(machine)
        if machine.run("systemctl is-active pleinair-kiosk || true").strip() != "activating":
            raise Failed("without a display the service is to go on starting")
        machine.run("modprobe virtio_gpu")
        machine.wait_for("Started pleinair-kiosk.service", 5)
        if machine.screen("waiting").kind() != "picture":
            raise Failed("there is no waiting picture: waiting.ppm")
        machine.run("modprobe vivid")
        print(f"painting {machine.paints(MINUTES):.0f} s after the camera has come", flush=True)
        if _service(machine) != service:
            raise Failed("the service was started again")


def wrong_sites(images, folder):
    """What the machine is set up by has mistakes, and then others: it paints, with a text over it, until they are mended."""
    with _saved(images, folder) as machine:
        for number, (text, said) in enumerate(WRONG_SITES):
            _write_site(machine, text)
            machine.wait_for(said, 5)
            machine.wait_for("Started pleinair-kiosk.service", 5)  # anew, as with every other site.toml
            machine.paints(MINUTES)
            machine.shows_caption(f"{number}-wrong", True)
        _write_site(machine, "[painting]\nlook = \"line_and_wash\"\n")
        machine.wait_for("Started pleinair-kiosk.service", 5)
        machine.paints(MINUTES)
        machine.shows_caption("right", False)


def _write_site(machine, text):
    text = text.replace("\n", "\\n").replace('"', '\\"')
    machine.run("mount -o remount,rw /media/pleinair && "
                f"printf \"{text}\" >/media/pleinair/site.toml && mount -o remount,ro /media/pleinair")


def hung(images, folder):
    """The program stands still: the watchdog has it started again."""
    with _saved(images, folder) as machine:
        before = _service(machine)
        stopped = float(machine.run(f"kill -STOP {before}; cut -d ' ' -f 1 /proc/uptime"))
        restarted = float(machine.wait_for(r"\[ *([0-9.]+)\] systemd\[1\]: Starting pleinair-kiosk\.service", 10).group(1))
        print(f"started again {restarted - stopped:.1f} s after it stood still", flush=True)
        if restarted - stopped > MOST_TO_RESTART:
            raise Failed("that is too late")
        machine.wait_for("Started pleinair-kiosk.service", 10)
        print(f"painting again {machine.paints(MINUTES):.0f} s later", flush=True)


# appliance/image/cannot-start.jpg: paper in the corners, and a sky between them.
def _cannot_start(screen):
    def colour(x, y):
        at = 3 * (int(y * screen.height) * screen.width + int(x * screen.width))
        return screen.pixels[at:at + 3]

    corners = [colour(x, y) for x in (0.004, 0.99) for y in (0.005, 0.99)]
    red, _, blue = colour(0.5, 0.15)
    return all(min(each) > 215 and each[0] > each[2] for each in corners) and 130 < red < blue - 12


def _says_cannot_start(machine, name, minutes):
    """Waits for the boot loader's picture; keeps it as NAME.ppm."""
    end = time.monotonic() + 60 * minutes
    while not _cannot_start(machine.screen(name)):
        if time.monotonic() > end:
            raise Failed(f"the screen does not say that no slot starts: {name}.ppm")
        time.sleep(0.5)


def slots_bad(images, folder):
    """Neither system can be opened, and then neither kernel: a picture says that the machine goes on trying. With one of them
    restored, it paints, and no longer says so."""
    disk = _copy(images.disk(), folder)
    places = check.partitions(disk)
    with open(os.path.join(kiosk.kernel_of(images.disk()), "cmdline")) as file:
        tree = int(re.search(r"pleinair\.hashoffset=(\d+)", file.read()).group(1))
    damaged = {name: places[name] + offset for name, offset in
              (("root-a", tree), ("root-b", tree), ("kernel-a", 0), ("kernel-b", 0))}
    kept = {}

    def damage(*names):
        with open(disk, "r+b") as file:
            for name in names:
                file.seek(damaged[name])
                kept[name] = file.read(65536)
                file.seek(damaged[name])
                file.write(bytes(65536))

    def restore(*names):
        with open(disk, "r+b") as file:
            for name in names:
                file.seek(damaged[name])
                file.write(kept[name])

    damage("root-a", "root-b")
    with Kiosk(disk, folder) as machine:
        for root in ("vda4", "vda5"):
            machine.wait_for(f"{root} cannot be opened", 15)
        _says_cannot_start(machine, "no-root", 10)
        machine.wait_for("vda4 cannot be opened", 5)
        _says_cannot_start(machine, "no-root-again", 5)
    damage("kernel-a", "kernel-b")
    check.set_in_block(disk, folder, EXHAUSTED="", a_TRY=0, b_TRY=0)
    with Kiosk(disk, os.path.join(folder, "kernels")) as machine:
        _says_cannot_start(machine, "no-kernel", 5)
    restore("root-b", "kernel-b")
    with Kiosk(disk, os.path.join(folder, "restored")) as machine:
        print(f"painting after {machine.paints(MINUTES):.0f} s", flush=True)
        machine.wait_for("slot b is confirmed", MINUTES)
        said = machine.run("/usr/lib/pleinair/bin/grub-editenv /boot/efi/EFI/BOOT/grubenv list")
        if "EXHAUSTED=\n" not in said:
            raise Failed("it will still say that no slot starts: " + said)


def gpu_lost(images, folder):
    """The GPU is lost, and so is every context that is made anew: the last painting stays, with a text, until it comes back."""
    with Kiosk(kiosk.overlay(images.losing_disk(), os.path.join(folder, "disk.qcow2")), folder) as machine:
        print(f"painting after {machine.paints(MINUTES):.0f} s", flush=True)
        machine.run("touch /run/lost-gpu")
        service = _service(machine)
        machine.wait_for("GPU: was reset", 5)
        time.sleep(60)
        first = machine.screen("lost-first")
        end = time.monotonic() + 60 * LOST_MINUTES
        while time.monotonic() < end:
            screen = machine.screen("lost")
            if screen.kind() != "picture":
                raise Failed("the screen shows nothing, or a console: lost.ppm")
            if screen.changed(first) > 0:
                raise Failed("its picture does not stay: lost-first.ppm, lost.ppm")
            time.sleep(1)
        if _service(machine) != service:
            raise Failed("the service was started again")
        machine.run("rm /run/lost-gpu")
        print(f"painting {machine.paints(MINUTES):.0f} s after the GPU was there again", flush=True)


def _saved(images, folder):
    """A machine that has painted for a minute goes on."""
    disk = os.path.join(folder, "disk.qcow2")
    kiosk.run("cp", "--sparse=always", images.confirmed_disk(), disk)
    return Kiosk(disk, folder, ("-loadvm", images.SAVED))


SCENARIOS = {each.__name__: each for each in (data_corrupted, data_lost, data_read_only, data_full, clock, late, wrong_sites,
                                                 hung, slots_bad, gpu_lost)}

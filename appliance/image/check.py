#!/usr/bin/env python3
"""Boots a copy of a machine image in QEMU, by UEFI and GRUB and with its own command line, to which only software GL and the
kernel's virtual camera are added, and judges the screen. In its first seconds, up to twice the moment of the firmware's first
mode, it is the firmware's and GRUB's, for 60 seconds where no mode was seen to come; from then on it may change to pictures and
black, and to no text. A waiting picture comes, and then a painting that moves.

    check.py DISK.img OUTPUT_FOLDER [MINUTES]

The screens that differ are kept as .ppm files, named by the second that they were seen at. Exit status 1: what was expected did
not come. Needs OVMF and mtools. Emulates; PLEINAIR_KVM=1 takes the machine's own processor, which within a virtual machine may fail.
"""
import json
import os
import shutil
import socket
import struct
import subprocess
import sys
import time

LEAST_COLOURS = 200  # of a picture on paper; text on black has few
MOVED = 1e-5  # of the bytes: less than the digits of a camera's clock, seen through a text's box
FIRMWARE_SECONDS = 20  # under emulation: 7 on an idle machine, and the kernel needs longer than the rest
LATEST_MODE = 60  # seconds; a quick machine has its mode before the first look, and then none is seen to come
FIRMWARE_MODES = 2  # GRUB is done at 1.3 times the moment of the firmware's first mode, however slow the machine
STUCK_SECONDS = 60
STUCK_SHARE = 0.15  # of a core: looking at the screen takes less, a painting several times as much
HAS_KVM = bool(os.environ.get("PLEINAIR_KVM"))
ACCELERATOR = "kvm" if HAS_KVM else "tcg,thread=multi"
# Emulated without AVX, which is slow, and new in QEMU 7.2: in four of ten starts, llvmpipe's code crashed there at vpgatherdd with
# registers that gave a valid address (docs/measured.md, "The machine image").
PROCESSOR = "host" if HAS_KVM else "Nehalem"
# How each architecture's machine is emulated: the emulator and its machine, with the firmware (Debian's).
EMULATORS = {
    "amd64": (["qemu-system-x86_64", "-M", "q35", "-cpu", PROCESSOR, "-device", "virtio-vga"],
              "/usr/share/OVMF/OVMF_CODE_4M.fd"),
    "arm64": (["qemu-system-aarch64", "-M", "virt", "-cpu", "cortex-a72", "-device", "virtio-gpu-pci"],
              "/usr/share/AAVMF/AAVMF_CODE.fd"),
}
# The processor that is emulated is open to Meltdown: Linux would change page tables at each system call, and the emulator forget
# what it has translated, which takes twice as long.
UNMITIGATED = "mitigations=off"
WORDS = f"pleinair.software_gl modules_load=vivid {UNMITIGATED}"
EDIT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "root", "usr", "lib", "pleinair", "bin", "grub-editenv")


def partitions(disk):
    """Offsets in bytes by name, from the GUID partition table."""
    found = {}
    with open(disk, "rb") as file:
        file.seek(512)
        header = file.read(92)
        first, count, size = struct.unpack("<QII", header[72:88])
        for i in range(count):
            file.seek(512 * first + i * size)
            entry = file.read(size)
            if any(entry[:16]):
                name = entry[56:128].decode("utf-16-le").rstrip("\0")
                found[name] = 512 * struct.unpack("<Q", entry[32:40])[0]
    return found


def add_words(disk, folder, words=WORDS):
    """To what GRUB gives the kernel, of whatever version; folder: for a file in between."""
    set_in_block(disk, folder, WORDS=words)


def set_in_block(disk, folder, **values):
    """Sets variables of GRUB's environment block."""
    place = f"{disk}@@{partitions(disk)['esp']}"
    block = os.path.join(folder, "grubenv")
    subprocess.run(["mcopy", "-n", "-o", "-i", place, "::EFI/BOOT/grubenv", block], check=True)
    subprocess.run([EDIT, block, "set", *(f"{name}={value}" for name, value in values.items())], check=True)
    subprocess.run(["mcopy", "-o", "-i", place, block, "::EFI/BOOT/grubenv"], check=True)


class Machine:
    """A QEMU machine that ends with the `with` block."""

    def __init__(self, disk, folder, restarts=False, arguments=(), arch="amd64"):
        """`restarts`: a restart of the machine does not end it. `arguments`: further ones of QEMU."""
        self._socket = os.path.join(folder, "qmp")
        emulator, firmware = EMULATORS[arch]
        self._process = subprocess.Popen(
            [*emulator, "-accel", ACCELERATOR, "-smp", "2", "-m", "2048", "-nodefaults", "-display", "none",
             *(() if restarts else ("-no-reboot",)),
             "-drive", f"if=pflash,format=raw,readonly=on,file={firmware}",
             "-drive", f"file={disk},if=none,id=disk,format={'raw' if disk.endswith('.img') else 'qcow2'}",
             "-device", "virtio-blk-pci,drive=disk,bootindex=0",
             "-qmp", f"unix:{self._socket},server,nowait", *arguments])

    def __enter__(self):
        connection = socket.socket(socket.AF_UNIX)
        for _ in range(100):
            try:
                connection.connect(self._socket)
                break
            except OSError:
                time.sleep(0.1)
        self._monitor = connection.makefile("rw")
        self._monitor.readline()
        self.command("qmp_capabilities")
        return self

    def __exit__(self, *_):
        self._process.kill()
        self._process.wait()

    def command(self, name, **arguments):
        self._monitor.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self._monitor.flush()
        while True:
            answer = json.loads(self._monitor.readline())
            if "error" in answer:
                raise RuntimeError(f"{name}: {answer['error']['desc']}")
            if "return" in answer:
                return answer["return"]

    def is_running(self):
        return self._process.poll() is None

    def busy_seconds(self):
        """Processor time that the emulator has used."""
        with open(f"/proc/{self._process.pid}/stat") as file:
            user, system = file.read().rsplit(")", 1)[1].split()[11:13]
        return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


class Screen:
    """A PPM file of QEMU's: binary, without comments."""

    def __init__(self, path):
        with open(path, "rb") as file:
            _, size, _, self.pixels = file.read().split(b"\n", 3)
        self.width, self.height = map(int, size.split())

    def colours(self):
        return len({self.pixels[i:i + 3] for i in range(0, len(self.pixels) - 2, 33)})

    def is_off(self):
        """Whether QEMU says so: one line in the middle of a black picture, where a console begins at the top."""
        if (self.width, self.height) != (640, 480):
            return False
        row = 3 * self.width
        above, below = self.pixels[:224 * row], self.pixels[256 * row:]
        return not above.strip(b"\0") and not below.strip(b"\0")

    def kind(self):
        """black, picture, or text."""
        if not self.pixels.strip(b"\0") or self.is_off():
            return "black"
        return "picture" if self.colours() >= LEAST_COLOURS else "text"

    def changed(self, other):
        """The share of the bytes that differ clearly; 1 for another mode of the display."""
        if len(self.pixels) != len(other.pixels):
            return 1.0
        step = 7
        pairs = list(zip(self.pixels[::step], other.pixels[::step]))
        return sum(abs(a - b) > 24 for a, b in pairs) / max(1, len(pairs))

    def _pixel(self, x, y):
        at = 3 * (y * self.width + x)
        return self.pixels[at:at + 3]

    def is_card(self):
        """A waiting picture, or one that says why no painting comes: its texts stand on paper below a picture
        (pipeline/present/waiting_picture.cpp). So would a painting that is all paper there, which those of vivid are not."""
        row = [self._pixel(x, int(0.94 * self.height)) for x in range(self.width // 4, 3 * self.width // 4)]
        return sum(min(each) > 200 and 0 <= each[0] - each[2] < 40 for each in row) > 0.7 * len(row)

    def has_caption(self):
        """Whether a text lies over a painting: white on black that covers 63 %, from its upper left corner on
        (pipeline/present/caption_picture.cpp). Only the box's upper rim is looked at, above the camera's own text."""
        letters = min(self.width, self.height) // 38
        left = next((x for x in range(self.width // 2) if max(self._pixel(x, self.height // 2)) > 60), 0)
        rim = [max(self._pixel(x, y))
               for y in range(3 * letters // 4, letters) for x in range(left + letters, left + 6 * letters)]
        return sum(each <= 110 for each in rim) > 0.7 * len(rim)

    def is_painting(self):
        return self.kind() == "picture" and not self.is_card()

    def is_next_painting(self, other):
        """Whether both are paintings, and differ by more than a text that has come or gone. A display's mode may change with the
        first painting, but not from one to the next."""
        return (self.is_painting() and other.is_painting() and self.has_caption() == other.has_caption() and
                MOVED < self.changed(other) < 1.0)


class Firmware:
    """Tells the screens of the firmware and of GRUB, which may be text, from those that come after them."""

    def __init__(self):
        self._first_size = None
        self._end = None  # not known before the firmware has set its mode, or has had its time for it

    def is_over(self, at, screen):
        """`at`: seconds since power on. For each screen, in their order."""
        size = (screen.width, screen.height)
        if self._first_size is None:
            self._first_size = size
        if self._end is None:
            if at > LATEST_MODE:
                self._end = LATEST_MODE
            elif size != self._first_size:
                self._end = max(FIRMWARE_SECONDS, FIRMWARE_MODES * at)
        return self._end is not None and at > self._end


class Stuck(Exception):
    """The emulated machine does nothing at all, as one has been seen to, once, in its first seconds."""


def watch(machine, folder, seconds):
    """Yields (second, screen) for each screen that differs from the one before. Throws Stuck."""
    began = looked = time.monotonic()
    busy = 0.0
    last = None
    while time.monotonic() - began < seconds and machine.is_running():
        at = time.monotonic() - began
        path = os.path.join(folder, f"{at:06.1f}.ppm")
        machine.command("screendump", filename=path)
        screen = Screen(path)
        if last is None or screen.pixels != last.pixels:
            yield at, screen
            last = screen
        else:
            os.remove(path)
        if time.monotonic() - looked > STUCK_SECONDS:
            used = machine.busy_seconds() - busy
            if used < STUCK_SHARE * STUCK_SECONDS:
                raise Stuck
            busy += used
            looked = time.monotonic()
        time.sleep(0.5)


def judge(disk, folder, minutes, arch):
    """Starts the machine and looks at its screen. Returns the exit status. Throws Stuck."""
    waiting, paintings, texts = None, [], []
    firmware = Firmware()
    with Machine(disk, folder, arch=arch) as machine:
        for at, screen in watch(machine, folder, 60 * minutes):
            kind = screen.kind()
            is_started = firmware.is_over(at, screen)
            if kind == "text" and is_started:
                texts.append(f"{at:.1f}")
            if kind != "picture" or not is_started:
                continue
            if waiting is None:
                waiting = screen
                print(f"first picture after {at:.1f} s", flush=True)
            if screen.is_painting():
                if not paintings or screen.is_next_painting(paintings[-1]):
                    paintings.append(screen)
                    print(f"painting {len(paintings)} after {at:.1f} s", flush=True)
                if len(paintings) == 3:
                    break
    if texts:
        print("text was seen at: " + ", ".join(texts) + " s")
    if len(paintings) < 3:
        print("no moving painting came" if waiting else "no picture came")
    return 0 if len(paintings) == 3 and not texts else 1


def main():
    disk, folder = sys.argv[1:3]
    minutes = float(sys.argv[3]) if len(sys.argv) > 3 else 15
    arch = "arm64" if "arm64" in os.path.basename(disk) else "amd64"
    copy = os.path.join(folder, "disk.img")
    for start in (1, 2):
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        subprocess.run(["cp", "--sparse=always", disk, copy], check=True)
        add_words(copy, folder)
        try:
            status = judge(copy, folder, minutes, arch)
            os.remove(copy)
            return status
        except Stuck:
            print(f"start {start}: the emulated machine does nothing at all", flush=True)
    return 1


if __name__ == "__main__":
    sys.exit(main())

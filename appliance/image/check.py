#!/usr/bin/env python3
"""Boots a machine image in QEMU, with the kernel's own virtual camera, and judges the screen from
power on: nothing but the firmware's text, black, and pictures; first a waiting picture, then a
painting that moves.

    check.py DISK.img KERNEL_FOLDER OUTPUT_FOLDER [MINUTES]

The disk is not written to. The screens that differ are kept as numbered .ppm files, named by the
second that they were seen at. Exit status 1: what was expected did not come.
"""
import json
import os
import shutil
import socket
import subprocess
import sys
import time

LEAST_COLOURS = 200  # of a picture on paper; text on black has few
FIRMWARE_HEIGHTS = (400, 480)  # of the text modes before the kernel draws


class Machine:
    """A QEMU machine that ends with the `with` block."""

    def __init__(self, disk, kernel, folder):
        with open(os.path.join(kernel, "cmdline")) as file:
            words = file.read().strip()
        words += " pleinair.software_gl modules_load=vivid console=ttyS0"
        self._socket = os.path.join(folder, "qmp")
        self._process = subprocess.Popen(
            ["qemu-system-x86_64", "-M", "q35", "-accel",
             "kvm" if os.access("/dev/kvm", os.W_OK) else "tcg,thread=multi", "-cpu", "max",
             "-smp", "2", "-m", "2048", "-nodefaults", "-display", "none", "-no-reboot",
             "-kernel", os.path.join(kernel, "vmlinuz"), "-initrd", os.path.join(kernel, "initrd.img"),
             "-append", words, "-device", "virtio-vga",
             "-drive", f"file={disk},if=virtio,format=raw,snapshot=on",
             "-serial", "file:" + os.path.join(folder, "serial.log"),
             "-qmp", f"unix:{self._socket},server,nowait"])

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
                return

    def is_running(self):
        return self._process.poll() is None


class Screen:
    """A PPM file of QEMU's: binary, without comments."""

    def __init__(self, path):
        with open(path, "rb") as file:
            _, size, _, self.pixels = file.read().split(b"\n", 3)
        self.width, self.height = map(int, size.split())

    def colours(self):
        return len({self.pixels[i:i + 3] for i in range(0, len(self.pixels) - 2, 33)})

    def kind(self):
        """firmware, black, picture, or text: what must not be seen."""
        if self.height in FIRMWARE_HEIGHTS:
            return "firmware"
        if not self.pixels.strip(b"\0"):
            return "black"
        return "picture" if self.colours() >= LEAST_COLOURS else "text"

    def changed(self, other):
        """The share of the bytes that differ clearly."""
        if len(self.pixels) != len(other.pixels):
            return 1.0
        step = 7
        pairs = list(zip(self.pixels[::step], other.pixels[::step]))
        return sum(abs(a - b) > 24 for a, b in pairs) / max(1, len(pairs))


def watch(machine, folder, seconds):
    """Yields (second, screen) for each screen that differs from the one before."""
    began = time.monotonic()
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
        time.sleep(0.5)


def main():
    disk, kernel, folder = sys.argv[1:4]
    minutes = float(sys.argv[4]) if len(sys.argv) > 4 else 15
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    first_picture = waiting = painted = None
    texts = []
    with Machine(disk, kernel, folder) as machine:
        for at, screen in watch(machine, folder, 60 * minutes):
            kind = screen.kind()
            if kind == "text":
                texts.append(f"{at:.1f}")
            if kind != "picture":
                continue
            if first_picture is None:
                first_picture = at
                print(f"first picture after {at:.1f} s", flush=True)
            # The waiting picture is the same for seconds; vivid's bars replace nearly all of it.
            if waiting is not None and screen.changed(waiting) > 0.4:
                painted = at
                print(f"painting after {at:.1f} s", flush=True)
                break
            if waiting is None and screen.colours() > 5 * LEAST_COLOURS:
                waiting = screen
    if texts:
        print("text was seen at: " + ", ".join(texts) + " s")
    if painted is None:
        print("no painting came" if first_picture else "no picture came")
    return 0 if painted is not None and not texts else 1


if __name__ == "__main__":
    sys.exit(main())

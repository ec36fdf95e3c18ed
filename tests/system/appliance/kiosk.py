"""A machine that runs an image of the appliance in QEMU, by UEFI and GRUB: what its screen shows, what its journal says, sticks
that come and go, and its power, which is cut by killing the emulator."""
import base64
import contextlib
import importlib.util
import os
import re
import shutil
import socket
import subprocess
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))


def _check_module():
    spec = importlib.util.spec_from_file_location("check", os.path.join(SOURCE, "appliance", "image", "check.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


check = _check_module()
ARCH = "amd64"
CONFIRM_MINUTES = 45  # to the first painting and a minute more: 6 on an idle machine
OTHER_PICTURE = 0.4  # of the bytes: a painting in place of the waiting picture
SITE = b'[painting]\nlook = "line_and_wash"\n'


class Failed(AssertionError):
    """It did not do what was expected."""


def run(*command):
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


# A unit of the machine's own: it runs what comes on a second serial port, as root, and answers each line by what that said and
# its exit status.
COMMANDS = r"""[Service]
ExecStart=/bin/sh -c 'stty -F /dev/ttyS1 raw -echo; exec 3<>/dev/ttyS1; while read -r line <&3; do \
  sh -c "$$line" >/run/answer 2>&1 </dev/null; status=$$?; echo "$$(base64 -w 0 /run/answer) $$status" >&3; done'
"""


def overlay(disk, path):
    """A disk that begins as another one and keeps what differs."""
    run("qemu-img", "create", "-q", "-f", "qcow2", "-F", "raw" if disk.endswith(".img") else "qcow2",
        "-b", os.path.abspath(disk), path)
    return path


def copy_as_qcow2(disk, path):
    """A disk of its own, which can keep a saved machine."""
    run("qemu-img", "convert", "-O", "qcow2", disk, path)
    return path


def stick(path, *files):
    """A FAT stick without partitions, with these files on it."""
    size = sum(os.path.getsize(each) for each in files) // (1 << 20) + 8
    with contextlib.suppress(FileNotFoundError):
        os.remove(path)
    run("/sbin/mkfs.vfat", "-n", "UPDATE", "-C", path, str(1024 * max(size, 40)))
    for each in files:
        run("mcopy", "-i", path, each, "::")
    return path


def run_in_system(disk, kernel, script, stick_file, folder, minutes):
    """Runs a script in place of init, in the system of an image: its own kernel and initial file system, without firmware and
    boot loader, which takes a minute where a whole start takes five. `kernel`: the folder of vmlinuz, initrd.img and cmdline.
    `stick_file`: a second disk, /dev/vdb. Returns what the script has said."""
    first = stick(os.path.join(folder, "script.img"), script)
    with open(os.path.join(kernel, "cmdline")) as file:
        words = file.read().strip()
    command = f"modprobe -a vfat nls_cp437 nls_ascii; mount -t vfat -o ro /dev/vdc /mnt; exec bash /mnt/{os.path.basename(script)}"
    said = os.path.join(folder, "said.log")
    process = subprocess.Popen([
        "qemu-system-x86_64", "-M", "q35", "-accel", check.ACCELERATOR, "-cpu", check.PROCESSOR,
        "-smp", "2", "-m", "1024", "-nodefaults", "-display", "none", "-no-reboot",
        "-kernel", os.path.join(kernel, "vmlinuz"), "-initrd", os.path.join(kernel, "initrd.img"),
        "-append", f'{words} {check.UNMITIGATED} console=ttyS0 init=/bin/bash -- -c "{command}"', "-serial", f"file:{said}",
        *(word for file in (disk, stick_file, first)
          for word in ("-drive", f"file={file},if=virtio,format={'qcow2' if file.endswith('.qcow2') else 'raw'}"))])
    try:
        process.wait(60 * minutes)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    with open(said, errors="replace") as file:
        return file.read()


def kernel_of(disk):
    """The folder of the kernel, initial file system and command line that belong to a disk of `Images`."""
    return os.path.join(os.path.dirname(disk), f"kernel-{ARCH}")


def set_up(disk, folder):
    """A new machine's disk with a site.toml on the partition that any computer can write."""
    raw = os.path.join(folder, "disk.img")
    run("cp", "--sparse=always", disk, raw)
    site = os.path.join(folder, "site.toml")
    with open(site, "wb") as file:
        file.write(SITE)
    run("mcopy", "-i", f"{raw}@@{check.partitions(raw)['provisioning']}", site, "::")
    return raw


class Kiosk:
    """Switched on from `with` to its end. Restarts of the machine itself are its own matter."""

    def __init__(self, disk, folder, devices=()):
        """`disk`: a qcow2 file. `devices`: further arguments of QEMU, such as ("-loadvm", NAME) for a machine that was saved on
        it."""
        self.folder = folder
        self._disk = disk
        self._devices = devices
        self._journal = os.path.join(folder, "journal.log")
        self._commands = os.path.join(folder, "commands")
        self._machine = None
        self._read = 0

    def __enter__(self):
        os.makedirs(self.folder, exist_ok=True)
        with contextlib.suppress(FileNotFoundError):
            os.remove(self._journal)
        self._read = 0
        self._machine = check.Machine(self._disk, self.folder, restarts=True, arguments=(
            "-serial", f"file:{self._journal}", "-serial", f"unix:{self._commands},server,nowait",
            "-device", "qemu-xhci,id=usb", *self._devices))
        self._machine.__enter__()
        return self

    def __exit__(self, *error):
        self._machine.__exit__(*error)

    def save(self, name):
        """Keeps the machine as it is now, memory and all, on its disk: `-loadvm NAME` goes on from there."""
        said = self._machine.command("human-monitor-command", **{"command-line": f"savevm {name}"})
        if said:
            raise Failed("the machine cannot be saved: " + said)

    def is_running(self):
        return self._machine.is_running()

    def run(self, command, minutes=5):
        """Runs a line of shell in the machine, as root. Returns what it said; anything but success is a failure."""
        answer = b""
        try:
            with socket.socket(socket.AF_UNIX) as port:
                port.settimeout(60 * minutes)
                port.connect(self._commands)
                port.sendall(command.encode() + b"\n")
                while not answer.endswith(b"\n"):
                    part = port.recv(65536)
                    if not part:
                        raise Failed(f"{command}: the machine has ended")
                    answer += part
        except OSError as error:
            raise Failed(f"{command}: {error}") from None
        said, status = answer.decode().rsplit(" ", 1)
        said = base64.b64decode(said).decode(errors="replace")
        if int(status):
            raise Failed(f"{command}: exit status {int(status)}: {said}")
        return said

    def cut_power(self):
        self._machine.__exit__()

    def plug_in(self, file, name="stick"):
        self._machine.command("blockdev-add", **{"node-name": name, "driver": "raw",
                                                 "file": {"driver": "file", "filename": file}})
        self._machine.command("device_add", driver="usb-storage", bus="usb.0", drive=name, id=name + "-device")

    def pull(self, name="stick"):
        self._machine.command("device_del", id=name + "-device")
        for _ in range(100):
            time.sleep(0.2)
            with contextlib.suppress(RuntimeError):  # while it is in use
                self._machine.command("blockdev-del", **{"node-name": name})
                return
        raise Failed("the stick cannot be pulled")

    def journal(self):
        try:
            with open(self._journal, errors="replace") as file:
                return file.read()
        except FileNotFoundError:
            return ""

    def wait_for(self, pattern, minutes):
        """Waits for a line of the journal behind the last one that was waited for. Returns the match."""
        end = time.monotonic() + 60 * minutes
        while time.monotonic() < end:
            match = re.compile(pattern).search(self.journal(), self._read)
            if match:
                self._read = match.end()
                return match
            if not self._machine.is_running():
                break
            time.sleep(0.5)
        raise Failed(f"waited {minutes} minutes for \"{pattern}\" in the journal:\n" + self.journal()[-3000:])

    def has_said(self, text):
        return text in self.journal()

    def screen(self, name):
        """What the screen shows now; kept as NAME.ppm."""
        path = os.path.join(self.folder, name + ".ppm")
        self._machine.command("screendump", filename=path)
        return check.Screen(path)

    def shows_caption(self, name, expected, minutes=5):
        """Waits until a text lies over the painting, or none does: the next painting shows it, which takes seconds under
        emulation. The screen is kept as NAME.ppm."""
        end = time.monotonic() + 60 * minutes
        while self.screen(name).has_caption() != expected:
            if time.monotonic() > end:
                raise Failed(f"the screen {'says nothing' if expected else 'says something'}: {name}.ppm")
            time.sleep(1)

    def goes_on_painting(self, name, minutes=5):
        """Two screens, seconds apart, differ as paintings do. The last is kept as NAME.ppm."""
        end = time.monotonic() + 60 * minutes
        before = self.screen(name)
        while True:
            time.sleep(2)
            now = self.screen(name)
            if now.is_next_painting(before):
                return
            if time.monotonic() > end:
                raise Failed(f"it no longer paints: {name}.ppm")
            before = now

    def paints(self, minutes):
        """Waits until two paintings differ, as those of a camera do. Text is a failure. Screens that differ much from the one
        before are kept as film-SECOND.ppm."""
        end = time.monotonic() + 60 * minutes
        began = time.monotonic()
        last = kept = None
        firmware = check.Firmware()
        while time.monotonic() < end and self._machine.is_running():
            screen = self.screen("now")
            if kept is None or screen.changed(kept) > OTHER_PICTURE or screen.kind() != kept.kind():
                kept = screen
                shutil.copy(os.path.join(self.folder, "now.ppm"),
                            os.path.join(self.folder, f"film-{time.monotonic() - began:05.1f}.ppm"))
            after_firmware = firmware.is_over(time.monotonic() - began, screen)
            if after_firmware and screen.kind() == "text":
                shutil.copy(os.path.join(self.folder, "now.ppm"), os.path.join(self.folder, "text.ppm"))
                raise Failed("there is text on the screen: " + os.path.join(self.folder, "text.ppm"))
            if after_firmware and screen.is_painting():
                if last and screen.is_next_painting(last):
                    return time.monotonic() - began
                last = screen
            time.sleep(1)
        raise Failed(f"no painting came within {minutes} minutes")

"""GRUB's own interpreter (grub-emu) on a disk with a FAT file system, as the machine's first partition is."""
import os
import re
import shutil
import subprocess
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
IMAGE = os.path.join(SOURCE, "appliance", "image")
TOOLS = os.path.join(IMAGE, "root", "usr", "lib", "pleinair")
EDIT = os.path.join(TOOLS, "bin", "grub-editenv")

CONFIGURATION = """
set environment=(hd0)/grubenv
source (hd0)/slots.cfg
next_slot
echo "CHOSEN slot=$slot."
function linux {
  echo "KERNEL $@ END."
  [ x = y ]
}
source (hd0)/boot.cfg
halt
"""


def missing_program():
    """Of those that this needs; None where all are there."""
    path = os.environ["PATH"] + ":/usr/sbin:/sbin"
    return next((each for each in ("grub-emu", "mkfs.vfat", "mcopy", "script") if not shutil.which(each, path=path)), None)


def read_block(file):
    listed = subprocess.run([EDIT, file, "list"], check=True, capture_output=True, text=True).stdout
    return dict(line.split("=", 1) for line in listed.splitlines())


def write_block(file, **values):
    subprocess.run([EDIT, file, "set"] + [f"{name}={value}" for name, value in values.items()], check=True)


class Disk:
    """The file system that holds slots.cfg and the environment block."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = self._folder.name
        self._disk = os.path.join(self.folder, "disk.img")
        self._block = os.path.join(self.folder, "grubenv")
        subprocess.run(["/sbin/mkfs.vfat", "-C", self._disk, "1024"], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([EDIT, self._block, "create"], check=True)
        self._put(os.path.join(IMAGE, "slots.cfg"))
        self._put(self._block)
        self._put(self._boot())
        with open(os.path.join(self.folder, "grub.cfg"), "w") as file:
            file.write(CONFIGURATION)
        with open(os.path.join(self.folder, "device.map"), "w") as file:
            file.write(f"(hd0) {self._disk}\n")

    def _boot(self):
        """boot.cfg as make-disk writes it."""
        with open(os.path.join(IMAGE, "make-disk")) as file:
            lines = re.search(r"^words=.*\necho .*boot.cfg\"$", file.read(), re.M).group(0)
        os.makedirs(os.path.join(self.folder, "input"))
        with open(os.path.join(IMAGE, "cmdline")) as file:
            words = [line.strip() for line in file if not line.startswith("#")]
        with open(os.path.join(self.folder, "input", "cmdline"), "w") as file:
            file.write(" ".join(words) + "\n")
        subprocess.run(["bash", "-c", lines], check=True, env={**os.environ, "work": self.folder})
        return os.path.join(self.folder, "input", "boot.cfg")

    def close(self):
        self._folder.cleanup()

    def _put(self, file):
        subprocess.run(["mcopy", "-o", "-i", self._disk, file, "::"], check=True)

    def block(self):
        subprocess.run(["mcopy", "-n", "-o", "-i", self._disk, "::grubenv", self._block], check=True)
        return self._block

    def values(self):
        return read_block(self.block())

    def set(self, **values):
        write_block(self.block(), **values)
        self.store()

    def store(self):
        """Puts the block that block() gave back."""
        self._put(self._block)

    def spoil(self):
        """What a block looks like that was cut off while it was written."""
        with open(self._block, "wb") as file:
            file.write(b"\0" * 1024)
        self._put(self._block)

    def start(self):
        """What GRUB would start; None where it chooses nothing."""
        command = f"grub-emu --directory='{self.folder}' --device-map='{self.folder}/device.map'"
        said = subprocess.run(["script", "-qec", command, "/dev/null"], stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=60, env={**os.environ, "TERM": "dumb"}).stdout
        plain = re.sub(rb"\x1b\[[0-9;?]*[A-Za-z]|[\r\n]", b"", said)  # lines are wrapped
        self.kernel_words = re.search(rb"KERNEL (.*?) END\.", plain).group(1).decode().split() if b" END." in plain else []
        chosen = re.search(rb"CHOSEN slot=(\w*)\.", said)
        return chosen.group(1).decode() if chosen else None

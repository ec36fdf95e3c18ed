"""A guest: a QEMU machine that runs Debian's stock kernel, driven from here.

    with Guest(image, folder) as guest:
        guest.run("modprobe vivid")
        stream = guest.start("v4l2-ctl --stream-mmap")
        ...

The folder is shared: it is /host in the guest, and commands run in it. Each guest writes into its own
copy of the image. QEMU always ends with the process that started it, and every wait has a deadline.
"""
import contextlib
import ctypes
import json
import os
import signal
import socket
import subprocess
import tempfile
import time

BOOT_SECONDS = 120  # 8 on two idle cores under emulation
# The time of a boot on hardware; the ratio of a boot here to it scales every timeout.
USUAL_BOOT_SECONDS = 1.5
MOST_PATIENCE = 8


class GuestError(Exception):
    """The guest failed: no boot, no answer, or a command with an error."""


class TooBusy(Exception):
    """The machine was too busy with other work for a judgement: a skip."""


class Finished:
    """The result of a command: its exit status (128 + the signal, as in a shell) and its output."""

    def __init__(self, status, output):
        self.status = status
        self.output = output


class Background:
    """A command that runs in the guest in parallel with others."""

    def __init__(self, guest, name):
        self._guest = guest
        self._base = f"/host/.guest/{name}"
        self._here = os.path.join(guest.folder, ".guest", name)

    def signal(self, name):
        """Sends a signal, such as "TERM", to the command itself."""
        self._guest.run(f"kill -{name} $(cat {self._base}.pid)")

    def caught_signals(self):
        """The signals that it catches, as a mask: proc(5), SigCgt."""
        line = self._guest.run(f"grep SigCgt /proc/$(cat {self._base}.pid)/status").output
        return int(line.split()[1], 16)

    def output(self):
        """Its output so far."""
        try:
            with open(self._here + ".out", errors="replace") as file:
                return file.read()
        except FileNotFoundError:
            return ""

    def is_running(self):
        return not os.path.exists(self._here + ".status")

    def wait(self, seconds=20):
        """Waits for its end."""
        self._guest.wait_for(lambda: not self.is_running(), f"the end of {self._base}", seconds)
        with open(self._here + ".status") as file:
            return Finished(int(file.read()), self.output())

    def wait_for_output(self, text, seconds=20):
        """Waits until its output contains this text."""
        self._guest.wait_for(
            lambda: text in self.output() or not self.is_running(), f'"{text}"', seconds)
        if text not in self.output():
            raise GuestError(f'it ended without "{text}":\n{self.output()}')


class Guest:
    """A guest whose boot hangs, which happens under emulation, is restarted with a message;
    `boots` is the number of attempts."""

    def __init__(self, image, folder, accelerator, boot_seconds=BOOT_SECONDS, boots=2, devices=()):
        """`devices`: further ones of QEMU's, as `-device` takes them."""
        self.folder = os.path.abspath(folder)
        self._devices = devices
        self._monitor = None
        self.accelerator = accelerator
        self._patience = 1.0
        self._image = image
        self._boot_deadline = boot_seconds
        self._boots = boots
        self._count = 0
        self._qemu = None
        self._agent = None
        self._received = b""

    def __enter__(self):
        os.makedirs(os.path.join(self.folder, ".guest"), exist_ok=True)
        for left in reversed(range(self._boots)):
            try:
                self._boot()
                return self
            except GuestError as error:
                self.close()
                if left == 0:
                    raise
                print(f"the guest does not boot and is started anew: {error}")
            except BaseException:
                self.close()
                raise

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Switches it off."""
        if self._monitor:
            with contextlib.suppress(OSError):  # it flushes, to a QEMU that may be gone
                self._monitor.close()
            self._monitor = None
        if self._agent:
            self._agent.close()
            self._agent = None
            self._received = b""
        if self._qemu:
            self._qemu.kill()
            self._qemu.wait()
            self._qemu = None

    @property
    def serial_log(self):
        return os.path.join(self.folder, ".guest", "serial.log")

    def run(self, command, seconds=20, check=True):
        """Runs a shell command to its end; with `check`, one that fails is an error."""
        self._count += 1
        base = os.path.join(self.folder, ".guest", str(self._count))
        with open(base + ".sh", "w") as file:
            file.write(command + "\n")
        self._agent.sendall(f"{self._count}\n".encode())
        answer = self._answer("DONE", command, seconds * self._patience)
        while answer[1] != str(self._count):  # of a command that was given up before
            answer = self._answer("DONE", command, seconds * self._patience)
        with open(base + ".out", errors="replace") as file:
            output = file.read()
        status = int(answer[2])
        if check and status != 0:
            raise GuestError(f"status {status} of: {command}\n{output}")
        return Finished(status, output)

    def start(self, command, name=None):
        """Starts a command and returns at once. It is one program with its arguments, so that signals
        reach it; use `sh -c` for a shell's features."""
        self._count += 1
        name = name or f"started-{self._count}"
        base = f"/host/.guest/{name}"
        self.run(
            f"rm -f {base}.status\n"
            f"( {command} & echo $! >{base}.pid; wait $!; echo $? >{base}.status.new; "
            f"mv {base}.status.new {base}.status ) >{base}.out 2>&1 </dev/null &")
        return Background(self, name)

    def qemu(self, command, **arguments):
        """Carries out a command of QEMU's monitor (QMP) and returns its answer."""
        try:
            self._monitor.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
            self._monitor.flush()
        except ConnectionError:
            raise GuestError(f"QEMU is gone at: {command}\n" + self._log("qemu.log")) from None
        while True:
            answer = self._monitor_line(command)
            if "error" in answer:
                raise GuestError(f"{command}: {answer['error']['desc']}")
            if "return" in answer:
                return answer["return"]

    def _monitor_line(self, what):
        try:
            line = self._monitor.readline()
        except ConnectionError:
            line = ""
        if not line:
            raise GuestError(f"QEMU is gone at: {what}\n" + self._log("qemu.log"))
        return json.loads(line)

    def screenshot(self, name, device, head=0):
        """What a display of a graphics card shows, as NAME.ppm in the shared folder. Returns its path."""
        path = os.path.join(self.folder, name + ".ppm")
        self.qemu("screendump", filename=path, device=device, head=head)
        return path

    def wait_for(self, condition, what, seconds=20):
        """Waits until the condition, a function, holds."""
        deadline = time.monotonic() + seconds * self._patience
        while not condition():
            if time.monotonic() > deadline:
                raise GuestError(f"waited {seconds * self._patience:.0f} s for {what}")
            if self._qemu.poll() is not None:
                raise GuestError(f"the guest is gone while waiting for {what}")
            time.sleep(0.05)

    def patient(self, seconds):
        """Scales seconds on real hardware to seconds here."""
        return seconds * self._patience

    def _boot(self):
        begin = time.monotonic()
        # QEMU's sockets live at a short path: their names may have 107 characters.
        with tempfile.TemporaryDirectory(prefix="pleinair-") as sockets:
            agent = os.path.join(sockets, "agent")
            monitor = os.path.join(sockets, "monitor")
            with open(os.path.join(self.folder, ".guest", "qemu.log"), "w") as log:
                self._qemu = start_with_parent(self._command(agent, monitor), log)
            self._agent = self._connect(agent)
            self._monitor = self._connect(monitor).makefile("rw")
        self._monitor_line("its greeting")
        self.qemu("qmp_capabilities")
        try:
            self._answer("READY", "the boot", self._boot_deadline)
        except GuestError as error:
            raise GuestError(f"{error}\nits console:\n{self._log('serial.log')}") from None
        self._patience = min(
            max(1, (time.monotonic() - begin) / USUAL_BOOT_SECONDS), MOST_PATIENCE)

    def _command(self, agent, monitor):
        cpu = "host" if self.accelerator == "kvm" else "Nehalem"  # AVX is slow to emulate
        return [
            "qemu-system-x86_64", "-nodefaults", "-no-user-config", "-no-reboot",
            "-machine", "q35", "-accel", self.accelerator, "-cpu", cpu,
            "-smp", "2", "-m", "1536",
            "-kernel", os.path.join(self._image, "vmlinux"),
            "-initrd", os.path.join(self._image, "initrd.cpio"),
            "-append", "console=ttyS0 quiet panic=-1 mitigations=off nokaslr tsc=reliable "
                       "no_timer_check random.trust_cpu=on audit=0",
            "-drive", f"file={self._image}/root.ext4,if=none,id=root,format=raw,cache=unsafe,"
                      "snapshot=on",
            "-device", "virtio-blk-pci,drive=root", "-device", "virtio-rng-pci",
            "-virtfs", f"local,path={self.folder},mount_tag=host,security_model=none",
            "-device", "virtio-serial-pci",
            "-chardev", f"socket,id=agent,path={agent},server=on,wait=off",
            "-device", "virtserialport,chardev=agent,name=agent",
            "-qmp", f"unix:{monitor},server=on,wait=off",
            "-serial", f"file:{self.serial_log}", "-display", "none", "-vga", "none",
            *(word for device in self._devices for word in ("-device", device))]

    def _connect(self, path):
        deadline = time.monotonic() + 10
        while True:
            agent = socket.socket(socket.AF_UNIX)
            try:
                agent.connect(path)
                return agent
            except OSError:
                agent.close()
            if self._qemu.poll() is not None or time.monotonic() > deadline:
                raise GuestError("QEMU does not start:\n" + self._log("qemu.log"))
            time.sleep(0.02)

    def _answer(self, kind, what, seconds):
        """The words of the agent's next line, which must be of this kind."""
        deadline = time.monotonic() + seconds
        while b"\n" not in self._received:
            self._agent.settimeout(max(0.001, deadline - time.monotonic()))
            try:
                received = self._agent.recv(4096)
            except socket.timeout:
                raise GuestError(f"no answer in {seconds:.0f} s to: {what}") from None
            except ConnectionError:
                received = b""
            if not received:
                raise GuestError(f"the guest is gone at: {what}\n" + self._log("qemu.log"))
            self._received += received
        line, self._received = self._received.split(b"\n", 1)
        words = line.decode().split()
        if not words or words[0] != kind:
            raise GuestError(f'the guest says "{line.decode()}" at: {what}')
        return words

    def _log(self, name):
        try:
            with open(os.path.join(self.folder, ".guest", name), errors="replace") as file:
                return file.read()[-4000:]
        except FileNotFoundError:
            return ""


def start_with_parent(command, log):
    """Starts a process that is killed when this one ends, even by SIGKILL."""
    prctl = ctypes.CDLL(None).prctl
    set_death_signal = 1

    def before_exec():
        prctl(set_death_signal, signal.SIGKILL)

    return subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                            start_new_session=True, preexec_fn=before_exec)


def usable_accelerator(image, folder):
    """"kvm" if a guest boots with it, else "tcg", QEMU's emulation. A KVM that can be opened may
    still fail to run a kernel, so this starts one."""
    if not os.access("/dev/kvm", os.R_OK | os.W_OK):
        return "tcg"
    try:
        with Guest(image, folder, "kvm", boot_seconds=15, boots=1):
            return "kvm"
    except GuestError:
        return "tcg"

"""Soaks: the installed program runs for long, and its memory, its descriptors and what it logs are judged (judges/growth.py)."""
import os
import re
import shutil
import subprocess
import time

from judges import closing_line
from judges.growth import Soak
from kiosk import Failed, check

EVERY = 10  # seconds
CHROOT_MINUTES = 90
CHROOT_FRAMES = 200_000
MACHINE_MINUTES = 30
LEAST_SHARE = 0.9  # of the time, for which there are samples

# A unit of the machine's own. It says which sockets others could reach (first with one of its own, so that none means none), and
# then, over and over, the memory and the descriptors of the service that paints, and what the kernel says of a program that
# has crashed.
WATCH = r"""[Service]
ExecStart=/bin/sh -c 'reachable() { echo "$$1 $$(cat /proc/net/tcp /proc/net/tcp6 | grep -c " 0A ") \
    $$(cat /proc/net/udp /proc/net/udp6 /proc/net/raw /proc/net/raw6 /proc/net/packet | grep -vc -e local_address -e RefCnt)"; }; \
  sleep 45; systemd-socket-activate -l 4711 /bin/true & own=$$!; sleep 10; reachable CONTROL-SOCKETS; kill $$own; wait; \
  reachable SOCKETS; \
  while sleep 30; do dmesg -c | grep -A 1 segfault; \
    pid=$$(systemctl show --value -p MainPID pleinair-kiosk); [ $$pid = 0 ] && continue; \
    set -- $$(grep RssAnon /proc/$$pid/status); echo "SOAK $$pid $$2 $$(ls /proc/$$pid/fd | wc -l)"; done'
"""
SAID = re.compile(r"\[ *([0-9.]+)\] \S+: SOAK (\d+) (\d+) (\d+)")


REACHABLE = re.compile(r"(CONTROL-)?SOCKETS (\d+) +(\d+)")


def judge_sockets(journal):
    """Nobody reaches the machine through a network, and the look at its sockets finds one that is there."""
    found = {bool(control): (int(listening), int(others)) for control, listening, others in REACHABLE.findall(journal)}
    if found.get(True) != (1, 0):
        raise Failed(f"the look at sockets does not find its own: {found}")
    if found.get(False) != (0, 0):
        raise Failed(f"something listens: {found}")
    print("no socket that a network reaches", flush=True)


def _judge(samples, logged, seconds, least_seconds):
    try:
        soak = Soak(samples, logged, seconds)
    except ValueError as error:
        raise Failed(str(error)) from None
    print(soak, flush=True)
    if soak.seconds() < LEAST_SHARE * least_seconds:
        raise Failed(f"it was looked at for {soak.seconds():.0f} s only")
    if soak.violations():
        raise Failed("; ".join(soak.violations()))


def _memory_and_descriptors(pid):
    with open(f"/proc/{pid}/status") as file:
        memory = int(re.search(r"RssAnon:\s+(\d+)", file.read()).group(1))
    return memory, len(os.listdir(f"/proc/{pid}/fd"))


def soak_chroot(tar, folder):
    """The image's system, unpacked, paints the synthetic camera at 160×120. Takes root."""
    root = os.path.join(folder, "root")
    os.mkdir(root)
    subprocess.run(["tar", "-C", root, "-xf", tar, "--exclude=./dev/*"], check=True)
    for place in ("dev", "proc", "tmp"):
        os.makedirs(os.path.join(root, place), exist_ok=True)
    enter = (f"mount --rbind /dev '{root}/dev' && mount -t proc proc '{root}/proc' && mount -t tmpfs tmpfs '{root}/tmp' && "
             f"exec chroot '{root}' /usr/bin/env HOME=/tmp LIBGL_ALWAYS_SOFTWARE=1 /usr/bin/pleinair run --camera synthetic "
             f"--output headless --size 160x120 --set camera.rate=60 --frames {CHROOT_FRAMES}")
    log = os.path.join(folder, "log")
    began = time.monotonic()
    samples = []
    with open(log, "w") as file:
        process = subprocess.Popen(["unshare", "--mount", "sh", "-c", enter], stdout=file, stderr=file)
    try:
        while process.poll() is None and time.monotonic() - began < 60 * CHROOT_MINUTES:
            time.sleep(EVERY)
            try:
                samples.append((time.monotonic() - began, *_memory_and_descriptors(process.pid)))
            except (FileNotFoundError, AttributeError, ProcessLookupError):
                break  # it has ended
        seconds = time.monotonic() - began
        process.terminate()
        status = process.wait(60)
    except subprocess.TimeoutExpired:
        raise Failed("it does not end when it is told to") from None
    finally:
        process.kill()
        process.wait()
        shutil.rmtree(root, ignore_errors=True)
    with open(log) as file:
        said = file.read()
    if status:
        raise Failed(f"exit status {status}: {said[-1500:]}")
    shown = closing_line.ledger(said)["shown"]
    print(f"{shown} frames were shown", flush=True)
    least = seconds if shown >= CHROOT_FRAMES else 60 * CHROOT_MINUTES
    _judge(samples, len(said), seconds, least - Soak.SETTLED)


def soak_machine(machine, confirmed, minutes_until):
    """A machine that has painted for a minute goes on. `confirmed`: the journal's line then."""
    machine.wait_for(confirmed, minutes_until)
    before = len(machine.journal())
    end = time.monotonic() + 60 * MACHINE_MINUTES + Soak.SETTLED
    while time.monotonic() < end:
        if not machine.is_running():
            raise Failed("the machine has ended")
        time.sleep(EVERY)
    said = machine.journal()[before:]
    found = SAID.findall(said)
    if not found or "segfault" in said or len({pid for _, pid, _, _ in found}) != 1:
        raise Failed("the service did not run all the time: " + said[-3000:])
    screen = machine.screen("end")
    time.sleep(60)
    if not check.MOVED < machine.screen("end-a-minute-later").changed(screen) < 1.0:
        raise Failed("it no longer paints")
    first = float(found[0][0])
    samples = [(float(at) - first, int(memory), int(descriptors)) for at, _, memory, descriptors in found]
    own = sum(len(line) + 1 for line in said.splitlines() if " SOAK " not in line)
    _judge(samples, own, samples[-1][0], 60 * MACHINE_MINUTES)

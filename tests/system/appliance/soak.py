"""Soaks: the installed program runs for long, and its memory, its descriptors and what it logs are judged (judges/growth.py)."""
import os
import re
import shutil
import subprocess
import time

from judges import closing_line
from judges.growth import Soak
from kiosk import Failed

EVERY = 10  # seconds
CHROOT_MINUTES = 90
CHROOT_FRAMES = 200_000
MACHINE_MINUTES = 30
MACHINE_EVERY = 30
LEAST_SHARE = 0.9  # of the time, for which there are samples

# The sockets that a network could reach: those that listen, and all that take packets.
SOCKETS = """cat /proc/net/tcp /proc/net/tcp6 | grep -c ' 0A '
cat /proc/net/udp /proc/net/udp6 /proc/net/raw /proc/net/raw6 /proc/net/packet | grep -vc -e local_address -e RefCnt; true"""
MEMORY = """pid=$(systemctl show --value -p MainPID pleinair-kiosk)
set -- $(grep RssAnon /proc/$pid/status)
echo $pid $2 $(ls /proc/$pid/fd | wc -l) $(cut -d ' ' -f 1 /proc/uptime) $(dmesg | grep -c segfault)"""


def _one_line(script):
    return "; ".join(script.splitlines())


def judge_sockets(machine):
    """Nobody reaches the machine through a network. The look at its sockets finds one that is there."""
    own = machine.run("systemd-socket-activate -l 4711 /bin/true & tcp=$!; systemd-socket-activate -d -l 4712 /bin/true & udp=$!; "
                      "sleep 10; " + _one_line(SOCKETS) + "; kill $tcp $udp")
    found = machine.run(_one_line(SOCKETS))
    if own.split()[-2:] != ["1", "1"]:
        raise Failed(f"the look at sockets does not find its own: {own}")
    if found.split() != ["0", "0"]:
        raise Failed(f"something listens: {found}")
    print("no socket that a network reaches", flush=True)


def _judge(samples, logged, seconds, least_seconds, folder):
    """`samples`: (second, KiB, descriptors), which are kept as samples.txt."""
    with open(os.path.join(folder, "samples.txt"), "w") as file:
        file.writelines(f"{at:.0f} {memory} {descriptors}\n" for at, memory, descriptors in samples)
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
             f"exec chroot '{root}' /usr/bin/env -i HOME=/tmp LIBGL_ALWAYS_SOFTWARE=1 /usr/bin/pleinair run --camera synthetic "
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
    _judge(samples, len(said), seconds, least - Soak.SETTLED, folder)


def soak_machine(machine, confirmed, minutes_until):
    """A machine that has painted for a minute goes on. `confirmed`: the journal's line then."""
    machine.wait_for(confirmed, minutes_until)
    before = len(machine.journal())
    began = time.monotonic()
    samples, processes = [], set()
    while time.monotonic() - began < 60 * MACHINE_MINUTES + Soak.SETTLED:
        found = machine.run(_one_line(MEMORY)).split()
        if len(found) != 5:
            raise Failed(f"the service does not run: {found}")
        process, memory, descriptors, at, crashes = found
        processes.add(process)
        samples.append((float(at), int(memory), int(descriptors)))
        if len(processes) != 1 or crashes != "0":
            raise Failed("the service did not run all the time: " + machine.journal()[-3000:])
        time.sleep(MACHINE_EVERY)
    said = machine.journal()[before:]
    screen = machine.screen("end")
    time.sleep(60)
    if not machine.screen("end-a-minute-later").is_next_painting(screen):
        raise Failed("it no longer paints")
    first = samples[0][0]
    samples = [(at - first, memory, descriptors) for at, memory, descriptors in samples]
    _judge(samples, len(said), samples[-1][0], 60 * MACHINE_MINUTES, machine.folder)

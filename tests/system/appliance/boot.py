"""The times of a machine's start, over how much slower the emulated machine is than this one."""
import os
import re
import statistics
import time

import kiosk
import patience
import soak
from kiosk import CONFIRM_MINUTES, Failed, Kiosk, kernel_of, set_up

# Depends on nothing: what the machine itself needs until then is not the program's. The journal's own first lines do not reach
# the serial port.
CONTROL_UNIT = """[Unit]
DefaultDependencies=no
[Service]
Type=oneshot
ExecStart=/bin/sh -c 'read up idle </proc/uptime; echo "CONTROL $$up" >/dev/ttyS0'
"""
FIRST_PICTURE_LIMIT = 1.0  # seconds after the control unit, times the patience
PAINTING_LIMIT = 1.3  # times what the service takes from its own start on
BOOTS = 3  # the emulated machine is at times slower for seconds


def seconds_of(pattern, journal):
    """The uptime that is the pattern's first group, which the journal has once."""
    found = re.findall(pattern, journal)
    if len(found) != 1:
        raise Failed(f"the journal says \"{pattern}\" {len(found)} times")
    return float(found[0])


# In place of init: a fixed program, over and over. The two numbers of a line are its begin and end.
WORK = """mount -t tmpfs tmp /tmp
mount -t vfat /dev/vdb /media/pleinair
cp /media/pleinair/cpu_work /tmp
chmod +x /tmp/cpu_work
for run in 1 2 3 4 5 6; do
  begin=$EPOCHREALTIME
  /tmp/cpu_work >/tmp/said && echo "WORK $begin $EPOCHREALTIME"
done
echo o >/proc/sysrq-trigger
sleep 60
"""


def measured_patience(disk, kernel, folder):
    """How much slower the emulated machine is than this one, right now."""
    program = os.environ.get("PLEINAIR_TEST_CPU_WORK")
    if not program:
        raise Failed("PLEINAIR_TEST_CPU_WORK is to name tests/system/programs' cpu_work")
    script = os.path.join(folder, "work.sh")
    with open(script, "w") as file:
        file.write(WORK)
    medium = kiosk.stick(os.path.join(folder, "work.img"), program)
    said = kiosk.run_in_system(disk, kernel, script, medium, folder, 10)
    runs = [float(end) - float(begin) for begin, end in re.findall(r"WORK ([0-9.]+) ([0-9.]+)", said)]
    if len(runs) < 6:
        raise Failed(said)
    return patience.ratio([patience.host_seconds(program) for _ in runs[1:]], runs[1:])


def first_picture(machine):
    """Seconds after the kernel's start: the control unit, the service's begin, its first picture."""
    machine.wait_for("Started pleinair-kiosk.service", 15)
    journal = machine.journal()
    service = r"\[ *([0-9.]+)\] systemd\[1\]: {} pleinair-kiosk\.service"
    control, begun, picture = (seconds_of(each, journal) for each in (
        r"CONTROL ([0-9.]+)", service.format("Starting"), service.format("Started")))
    if not control < begun:
        raise Failed("the control unit ran after the service: it says nothing")
    print(f"seconds after the kernel: control unit {control:.1f}, service begun {begun:.1f}, its first picture {picture:.1f}",
          flush=True)
    return control, begun, picture


def boot(images, folder):
    """The times of three new machines' starts, beside a unit that depends on nothing; no console is seen, and nothing listens."""
    made = images.timed_disk()
    raw = set_up(made, folder)
    shares = []
    for number in range(BOOTS):
        disk = os.path.join(folder, f"disk-{number}.qcow2")
        slower = measured_patience(kiosk.overlay(raw, disk), kernel_of(made), folder)
        with Kiosk(disk, folder) as machine:
            control, begun, picture = first_picture(machine)
            ready_at = time.monotonic()
            shares.append((picture - control) / slower)
            if number < BOOTS - 1:
                continue
            machine.paints(CONFIRM_MINUTES)
            painting = picture + time.monotonic() - ready_at
            print(f"painting {painting:.1f}", flush=True)
            soak.judge_sockets(machine)
    print("the first picture after the control unit, over the patience: " + ", ".join(f"{each:.2f}" for each in shares), flush=True)
    if statistics.median(shares) > FIRST_PICTURE_LIMIT:
        raise Failed("the first picture comes too late")
    if painting - control > PAINTING_LIMIT * (painting - begun):
        raise Failed(f"the service takes {painting - begun:.1f} s to paint; it was {painting - control:.1f} s after the control "
                     "unit")

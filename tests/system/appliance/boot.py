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
# The first picture's seconds after the control unit, over the patience of starting programs: 0.3 to 0.5 were measured
# (docs/measured.md, "The machine image"). 1.0 is the aim on hardware.
FIRST_PICTURE_LIMIT = 0.75
PAINTING_LIMIT = 1.3  # times what the service takes from its own start on
BOOTS = 3  # the emulated machine is at times slower for seconds


def seconds_of(pattern, journal):
    """The uptime that is the pattern's first group, which the journal has once."""
    found = re.findall(pattern, journal)
    if len(found) != 1:
        raise Failed(f"the journal says \"{pattern}\" {len(found)} times")
    return float(found[0])


# A machine's start is made of the starts of programs. Emulation slows these down two to six times as much as it slows down one
# that runs: their code is translated, and each process begins with empty tables of addresses.
STARTS = "for each in {1..20}; do /bin/true; done"
# In place of init: a fixed program, and the starts, over and over. The two numbers of a line are the begin and the end.
WORK = f"""mount -t tmpfs tmp /tmp
mount -t vfat /dev/vdb /media/pleinair
cp /media/pleinair/cpu_work /tmp
chmod +x /tmp/cpu_work
for run in 1 2 3 4 5 6; do
  begin=$EPOCHREALTIME
  /tmp/cpu_work >/tmp/said && echo "WORK $begin $EPOCHREALTIME"
  begin=$EPOCHREALTIME
  {STARTS}
  echo "STARTS $begin $EPOCHREALTIME"
done
echo o >/proc/sysrq-trigger
sleep 60
"""


def measured_patience(disk, kernel, folder):
    """How much slower the emulated machine is than this one, right now: at running a program, and at starting programs."""
    program = os.environ.get("PLEINAIR_TEST_CPU_WORK")
    if not program:
        raise Failed("PLEINAIR_TEST_CPU_WORK is to name tests/system/programs' cpu_work")
    script = os.path.join(folder, "work.sh")
    with open(script, "w") as file:
        file.write(WORK)
    medium = kiosk.stick(os.path.join(folder, "work.img"), program)
    said = kiosk.run_in_system(disk, kernel, script, medium, folder, 10)
    ratios = []
    for name, command, what in (("WORK", (program,), "a fixed program takes"),
                                ("STARTS", ("bash", "-c", STARTS), "20 starts of programs take")):
        runs = [float(end) - float(begin) for begin, end in re.findall(name + r" ([0-9.]+) ([0-9.]+)", said)]
        if len(runs) < 6:
            raise Failed(said)
        ratios.append(patience.ratio([patience.host_seconds(*command) for _ in runs[1:]], runs[1:], what))
    return ratios


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
    by_work, shares = [], []
    for number in range(BOOTS):
        disk = os.path.join(folder, f"disk-{number}.qcow2")
        at_work, at_starts = measured_patience(kiosk.overlay(raw, disk), kernel_of(made), folder)
        with Kiosk(disk, folder) as machine:
            control, begun, picture = first_picture(machine)
            ready_at = time.monotonic()
            by_work.append((picture - control) / at_work)
            shares.append((picture - control) / at_starts)
            if number < BOOTS - 1:
                continue
            machine.paints(CONFIRM_MINUTES)
            painting = picture + time.monotonic() - ready_at
            print(f"painting {painting:.1f}", flush=True)
            soak.judge_sockets(machine)
    for name, each in (("starting programs", shares), ("running one", by_work)):
        print(f"the first picture after the control unit, over the patience of {name}: " +
              ", ".join(f"{share:.2f}" for share in each), flush=True)
    if statistics.median(shares) > FIRST_PICTURE_LIMIT:
        raise Failed("the first picture comes too late")
    if painting - control > PAINTING_LIMIT * (painting - begun):
        raise Failed(f"the service takes {painting - begun:.1f} s to paint; it was {painting - control:.1f} s after the control "
                     "unit")

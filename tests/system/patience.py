"""How much slower a guest is than the machine that it runs on: what takes one second on hardware may take it this many."""
import os
import statistics
import subprocess
import time

RUNS = 5


def measure(guest):
    """The median of five runs of one fixed program (programs/cpu_work.cpp) in the guest over that of five here, one after the
    other, so that other work of the machine meets both. Nothing else should run in the guest meanwhile."""
    guest.run("cp cpu_work /tmp; /tmp/cpu_work", seconds=60)
    here, there = [], []
    for _ in range(RUNS):
        begin = time.monotonic()
        subprocess.run([os.path.join(guest.folder, "cpu_work")], check=True, stdout=subprocess.DEVNULL)
        here.append(time.monotonic() - begin)
        taken = guest.run("a=$EPOCHREALTIME; /tmp/cpu_work >/dev/null; b=$EPOCHREALTIME; echo $a $b", seconds=60).output
        begin, end = (float(each) for each in taken.split())
        there.append(end - begin)
    patience = max(1, statistics.median(there) / statistics.median(here))
    print(f"a fixed program takes {1000 * statistics.median(here):.0f} ms here and {statistics.median(there):.2f} s in the guest: "
          f"patience {patience:.1f}, at a load of {os.getloadavg()[0]:.1f}")
    return patience

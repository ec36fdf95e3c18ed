"""How much slower a guest is than the machine that it runs on: what takes one second on hardware may take it this many."""
import os
import statistics
import subprocess
import time

RUNS = 5


def host_seconds(*command):
    """How long a program takes on this machine."""
    begin = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def ratio(host, guest, what="a fixed program takes"):
    """Of the seconds that one program's runs took."""
    outside, inside = statistics.median(host), statistics.median(guest)
    patience = max(1, inside / outside)
    print(f"{what} {1000 * outside:.0f} ms here and {inside:.2f} s in the guest: "
          f"patience {patience:.1f}, at a load of {os.getloadavg()[0]:.1f}")
    return patience


def measure(guest):
    """The median of five runs of one fixed program (programs/cpu_work.cpp) in the guest over that of five here, one after the
    other, so that other work of the machine meets both. Nothing else should run in the guest meanwhile."""
    guest.run("cp cpu_work /tmp; /tmp/cpu_work", seconds=60)
    outside, inside = [], []
    for _ in range(RUNS):
        outside.append(host_seconds(os.path.join(guest.folder, "cpu_work")))
        taken = guest.run("a=$EPOCHREALTIME; /tmp/cpu_work >/dev/null; b=$EPOCHREALTIME; echo $a $b", seconds=60).output
        begin, end = (float(each) for each in taken.split())
        inside.append(end - begin)
    return ratio(outside, inside)

"""How long a display waits for its first picture after the program is started, and for the picture of a new state, by
the kernel's own clock: its trace of programs, flips and frames."""
import os
import re
import resource
import statistics
import subprocess
import time

import live
from guest import TooBusy

TRACE = "/sys/kernel/tracing"
EXEC = "sched_process_exec: filename=/tmp/pleinair"
FLIP = r"drm_vblank_event_delivered: file=0*[1-9a-f]"  # one that a program asked for
FRAME = "v4l2_dqbuf"
FIRST_MS = 300  # on hardware
NEXT_MS = 100
RUNS = 5
BUSY = 2.5  # so many times its processor's time a start may take on a machine that does nothing else


def run(guest):
    live.load_drivers(guest)
    guest.run("modprobe vkms; udevadm settle; cp pleinair /tmp; /tmp/pleinair --version", seconds=60)
    live.unplug(guest)
    trace = Trace(guest)
    firsts, here, there = [], [], []
    for i in range(RUNS):
        here.append(start_time_here(guest))
        there.append(start_time_there(guest))
        before = live.uptime(guest)  # after the start that was only timed
        program = start(guest, f"first-{i}")
        begun = trace.wait_for(EXEC, before)
        firsts.append(trace.wait_for(FLIP, begun) - begun)
        watched = live.Watched(guest, program)
        if i < RUNS - 1:
            watched.stop(10)
    wall, processor = (statistics.median(each) for each in zip(*here))
    patience = statistics.median(there) / wall
    first = statistics.median(firsts)
    print(f"the program starts in {wall:.2f} s here, in {patience:.0f} times that in the guest; first flip after",
          *(f"{each:.1f}" for each in firsts), f"s: {1000 * first / patience:.0f} ms × patience")

    guest.run("sleep 2")
    plugged = live.uptime(guest)
    live.plug(guest)
    came = trace.wait_for(FRAME, plugged)
    trace.wait_for(FLIP, came)
    # The camera's name may come first, then what is done with its frames; paintings come much later.
    guest.run("sleep 2")
    told = trace.all_of(FLIP, came)[-1] - came
    print(f"the picture of the camera's first frame after {told:.2f} s: {1000 * told / patience:.0f} ms × patience")
    print(watched.stop(10))
    if wall > BUSY * processor:
        raise TooBusy(f"a start takes {wall:.2f} s here, of which {processor:.2f} s of a processor: other work's time "
                      "cannot be told from the guest's slowness")
    assert 1000 * first <= FIRST_MS * patience
    assert 1000 * told <= NEXT_MS * patience


class Trace:
    """The kernel's trace, read on the host, so that looking at it takes no time of the guest."""

    def __init__(self, guest):
        self._guest = guest
        events = ("sched/sched_process_exec", "drm/drm_vblank_event_delivered", "v4l2/v4l2_dqbuf")
        guest.run(f"mount -t tracefs none {TRACE} 2>/dev/null; cd {TRACE}; echo mono >trace_clock\n" +
                  "\n".join(f"echo 1 >events/{event}/enable" for event in events))
        self._path = os.path.join(guest.folder, "trace.txt")
        guest.start(f"sh -c 'exec cat {TRACE}/trace_pipe >/host/trace.txt'", "trace")

    def wait_for(self, event, after):
        """The time of the first such event after a time, on the guest's monotonic clock."""
        self._guest.wait_for(lambda: self.all_of(event, after), event, seconds=60)
        return self.all_of(event, after)[0]

    def all_of(self, event, after):
        """The times of all such events so far."""
        if not os.path.exists(self._path):
            return []
        with open(self._path, errors="replace") as file:
            lines = [re.match(r".*?\s(\d+\.\d+): (.*)", line) for line in file]
        return [float(line[1]) for line in lines
                if line and re.match(event, line[2]) and float(line[1]) > after]


# Patience is how long the start of pleinair itself takes in the guest, over that on this machine: an emulator translates
# code that runs for the first time, which takes longer than code that is repeated.


def start_time_here(guest):
    """In seconds: of the clock, and of a processor."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    subprocess.run([os.path.join(guest.folder, "pleinair"), "--version"], check=True, stdout=subprocess.DEVNULL)
    after, end = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    return end - begin, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def start_time_there(guest):
    taken = guest.run("a=$EPOCHREALTIME; /tmp/pleinair --version >/dev/null; b=$EPOCHREALTIME; echo $a $b", seconds=60)
    begin, end = (float(each) for each in taken.output.split())
    return end - begin


def start(guest, name):
    return guest.start(
        f"/tmp/pleinair run --camera v4l2:{live.CAMERA} --style none --size 160x90 "
        f"--output display --set output.display.mode=640x480 --set output.keep_last_painting=false "
        f"--set camera.wait=true --set status.listen={live.STATUS}", name)

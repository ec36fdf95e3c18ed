"""How long a display waits for its first picture after the program is started, and for the picture of a new state, by
the kernel's own clock: its trace of programs, flips and frames."""
import os
import re
import statistics
import subprocess
import time

import live

TRACE = "/sys/kernel/tracing"
EXEC = "sched_process_exec: filename=/tmp/pleinair"
FLIP = r"drm_vblank_event_delivered: file=0*[1-9a-f]"  # one that a program asked for
FRAME = "v4l2_dqbuf"
FIRST_MS = 300  # on hardware
NEXT_MS = 100
RUNS = 5


def run(guest):
    live.load_drivers(guest)
    guest.run("modprobe vkms; udevadm settle; cp pleinair /tmp; /tmp/pleinair --version")
    live.unplug(guest)
    patience = measured_patience(guest)
    print(f"this guest takes {patience:.1f} times as long to start the program as this machine")
    trace = Trace(guest)

    firsts = []
    for i in range(RUNS):
        program = start(guest, f"first-{i}")
        begun = trace.wait_for(EXEC)
        firsts.append(1000 * (trace.wait_for(FLIP, begun) - begun))
        watched = live.Watched(guest, program)
        if i < RUNS - 1:
            watched.stop()
    print("first flip after", *(f"{each:.0f}" for each in firsts), "ms")

    guest.run("sleep 2")
    plugged = live.uptime(guest)
    live.plug(guest)
    came = trace.wait_for(FRAME, plugged)
    told = 1000 * (trace.wait_for(FLIP, came) - came)
    print(f"the picture of the camera's first frame after {told:.0f} ms")
    print(watched.stop())
    limit = FIRST_MS * patience
    assert statistics.median(firsts) <= limit, f"first flip: more than {limit:.0f} ms"
    limit = NEXT_MS * patience
    assert told <= limit, f"new state: more than {limit:.0f} ms"


class Trace:
    """The kernel's trace, read on the host, so that looking at it takes no time of the guest."""

    def __init__(self, guest):
        self._guest = guest
        events = ("sched/sched_process_exec", "drm/drm_vblank_event_delivered", "v4l2/v4l2_dqbuf")
        guest.run(f"mount -t tracefs none {TRACE} 2>/dev/null; cd {TRACE}; echo mono >trace_clock\n" +
                  "\n".join(f"echo 1 >events/{event}/enable" for event in events))
        self._path = os.path.join(guest.folder, "trace.txt")
        guest.start(f"sh -c 'exec cat {TRACE}/trace_pipe >/host/trace.txt'", "trace")
        self._last = 0.0

    def wait_for(self, event, after=None):
        """The time of the first such event after a time, else after the one that was asked for last, on the guest's
        monotonic clock."""
        after = self._last if after is None else after
        found = []

        def is_there():
            if not os.path.exists(self._path):
                return False
            with open(self._path, errors="replace") as file:
                for line in file:
                    matched = re.match(r".*?\s(\d+\.\d+): (.*)", line)
                    if matched and re.match(event, matched[2]) and float(matched[1]) > after:
                        found.append(float(matched[1]))
                        return True
            return False

        self._guest.wait_for(is_there, event, seconds=30)
        self._last = found[0]
        return found[0]


def measured_patience(guest):
    """The median time of five runs of one program in the guest over that on this machine. It is the start of pleinair
    itself: an emulator translates code that runs for the first time, which takes longer than code that is
    repeated."""
    program = os.path.join(guest.folder, "pleinair")

    def here():
        begin = time.monotonic()
        subprocess.run([program, "--version"], check=True, stdout=subprocess.DEVNULL)
        return time.monotonic() - begin

    def there():
        taken = guest.run("a=$EPOCHREALTIME; /tmp/pleinair --version >/dev/null; b=$EPOCHREALTIME; echo $a $b")
        begin, end = (float(each) for each in taken.output.split())
        return end - begin

    return statistics.median(there() for _ in range(5)) / statistics.median(here() for _ in range(5))


def start(guest, name):
    return guest.start(
        f"/tmp/pleinair run --camera v4l2:{live.CAMERA} --style none --size 160x90 "
        f"--output display --set output.display.mode=640x480 --set output.keep_last_painting=false "
        f"--set camera.wait=true --set status.listen={live.STATUS}", name)

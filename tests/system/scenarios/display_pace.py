"""vkms, 25 frames a second for a minute through the live pipeline with a painter that costs next to nothing: each frame
is shown at the refresh that it is due at, by the display's own count; and again with both cores loaded, which is
reported, not judged.

A guest under emulation stands still whenever its host does something else, and then no program is in time. Threads
beside the pipeline notice that (programs/standstills.h); frames that were due meanwhile are counted, but not judged."""
import os

import flips
import live
from guest import TooBusy

RATE = 25
FRAMES = 1500
PERIOD = 1 / 60
FEWEST = 30  # frames to judge


def run(guest):
    live.load_drivers(guest)
    guest.run("modprobe vkms; udevadm settle")
    judge("idle", show(guest, "idle"))
    burners = [guest.start("sh -c 'while :; do :; done'", f"burner-{i}") for i in range(2)]
    show(guest, "loaded")
    for each in burners:
        each.signal("KILL")


def show(guest, name):
    program = guest.start(
        f"./paced_display v4l2:{live.CAMERA} {RATE} {FRAMES} /host/{name}.csv", "paced-" + name)
    finished = program.wait(FRAMES / RATE + 30)
    assert finished.status == 0, finished.output
    print(f"{name}:", *finished.output.strip().splitlines()[-2:], sep="\n  ")
    taken = flips.Flips(os.path.join(guest.folder, name + ".csv"), "display")
    taken.check_outcomes()
    taken.write_plot(os.path.join(guest.folder, name + ".svg"),
                     f"{name}: flips against due times, vkms at 60 Hz, {RATE} frames/s", PERIOD)
    report("all frames", taken)
    stills = flips.standstills(os.path.join(guest.folder, name + ".csv.standstills"))
    decided = taken.without(stills, flips.DECISIVE * PERIOD)
    report("due while the machine ran", decided)
    return decided


def report(what, taken):
    off = taken.off()
    print(f"  {what}: {len(taken.rows)}, {len(off)} shown, {sum(each == 0 for each in off)} at their due refresh, "
          f"{sum(each < 0 for each in off)} before and {sum(each > 0 for each in off)} after it; capture to flip "
          f"{1000 * sum(taken.latencies()) / max(1, len(off)):.1f} ms, sd {1000 * taken.spread():.1f} ms; "
          f"{taken.outcomes()}")


def judge(name, taken):
    off = taken.off()
    if len(taken.rows) < FEWEST:
        raise TooBusy(f"{name}: this machine, which emulates the guest, stood still nearly all the time")
    assert min(off) >= 0, f"{name}: a frame was shown before it was due"
    assert len(off) >= 1450 / 1500 * len(taken.rows), f"{name}: {len(off)} of {len(taken.rows)} shown"
    assert sum(each == 0 for each in off) >= 0.99 * len(off), f"{name}: frames missed their refresh"
    assert taken.spread() <= PERIOD / 2, f"{name}: capture to flip varies by {1000 * taken.spread():.1f} ms"

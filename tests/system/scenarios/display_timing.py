"""vkms, a graphics card with exact vertical blanking: what has been painted in time is shown at the refresh that it is due
at, by the display's own count; a minute each of the camera's picture and of watercolor. Under emulation most frames
are replaced by newer ones before they are painted: the ledger says so. Frames that were due while the emulated machine
stood still are counted, but not judged."""
import os

import flips
import live
from guest import TooBusy
from scenarios import display_writeback

SIZE = (320, 240)
RATE = 25
LATENCY_MS = 2000  # the most that can be configured: emulation paints a frame in about a second
PERIOD = 1 / 60
# A frame that was painted by so long before its due time is the display's affair alone.
IN_TIME = 0.1
FEWEST = 5  # frames to judge


def run(guest):
    guest.run("modprobe vkms; udevadm settle")
    display_writeback.write_recording(os.path.join(guest.folder, "camera.y4m"), SIZE, RATE)
    for style, seconds in (("none", 60), ("watercolor", 60)):
        shown = show(guest, style, seconds)
        if len(shown) < FEWEST:
            raise TooBusy(f"{style}: only {len(shown)} frames in {seconds} s were painted in time, which says nothing "
                          "of the display")
        on_time = sum(row["refresh"] == row["due_refresh"] for row in shown)
        assert on_time >= 0.95 * len(shown), \
            f"{style}: {len(shown) - on_time} of {len(shown)} frames that were ready missed their refresh"


def show(guest, style, seconds):
    """The rows of the frames that were painted in time."""
    standstills = guest.start(f"./standstills /host/{style}.standstills", f"standstills-{style}")
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera camera.y4m --style {style} "
        f"--size {SIZE[0]}x{SIZE[1]} --output display --set output.display.mode=640x480 "
        f"--set output.waiting_pictures=false --set runtime.latency={LATENCY_MS} "
        f"--set runtime.max_latency={LATENCY_MS} --set runtime.frame_log={style}.csv "
        f"--set status.listen={live.STATUS}", style)
    watched = live.Watched(guest, program)
    watched.wait_until(lambda status: live.shown_of(status) >= 2, "two frames", seconds=100)
    begin = live.uptime(guest)
    status = watched.wait_until(lambda _: live.uptime(guest) > begin + seconds, "the time to pass",
                                seconds=2 * seconds)
    live.check_sums(status)
    (output,) = status["outputs"]
    assert output["failures"] == 0, output
    assert abs(output["refresh_period_s"] - PERIOD) < 1e-3, output
    assert output["pacing"] == "display", output
    assert output["refresh_phase_s"] > 0, output  # only flips that were counted tell it
    ledger = watched.stop()
    standstills.signal("TERM")
    assert standstills.wait(20).status == 0

    taken = flips.Flips(os.path.join(guest.folder, style + ".csv"), "display")
    taken.check_outcomes()
    taken.write_plot(os.path.join(guest.folder, style + ".svg"),
                     f"{style}: flips against due times, vkms at 60 Hz", PERIOD)
    ready = ready_in_time(taken)
    assert all(int(row["refresh"]) >= int(row["due_refresh"]) for row in ready), "shown early"
    stills = flips.standstills(os.path.join(guest.folder, style + ".standstills"))
    decided = ready_in_time(taken.without(stills, flips.DECISIVE * PERIOD))
    print(f"{style}: painted {status['painting']['frames_per_second']:.1f} frames/s; {len(taken.flipped)} "
          f"flips, {taken.outcomes()}; {told(ready)} were ready in time; {told(decided)} while the machine ran")
    print(style + ":", ledger)
    return decided


def ready_in_time(taken):
    return [row for row in taken.flipped
            if row["due_refresh"] and float(row["ready_s"]) < float(row["due_s"]) - IN_TIME]


def told(rows):
    return f"{len(rows)}, {sum(row['refresh'] == row['due_refresh'] for row in rows)} of them at their due refresh,"

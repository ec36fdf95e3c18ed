"""A sensor behind a pipeline, vimc, through libcamera: found by `auto`, listed once, in the colours of its pattern and the
size that libcamera gives it; unbound in mid-stream, of which libcamera says nothing, and bound again at once, at which it
ends its process."""
import json
import statistics

import colour_bars
import live
import patience

DRIVER = "/sys/bus/platform/drivers/vimc"
# On hardware: 3 frame periods and 200 ms, where vimc tells no period and one of 100 ms is assumed.
NOTICED_SECONDS = 0.5
BACK_SECONDS = 2
TIMES = 5


def run(guest):
    live.load_drivers(guest)
    guest.run("modprobe -r vivid; modprobe vimc; udevadm settle")
    check_listing(guest)
    check_times(guest)
    program = live.Program(guest, "--set camera.size=320x180", camera="auto")
    status = program.wait_for_more(3)
    assert status["camera"]["backend"] == "libcamera", status["camera"]
    print("frames:", status["camera"]["format"])
    check_colours(guest)
    live.check_sums(status)
    for _ in range(2):
        driver(guest, "unbind")
        program.wait_until(live.is_without_camera, "the loss to be seen")
        shown = program.shown()
        driver(guest, "bind")
        status = program.wait_until(lambda status: live.shown_of(status) > shown, "new frames", 60)
        assert status["camera"]["backend"] == "libcamera", status["camera"]
        live.check_sums(program.wait_for_more(2))
    print(program.stop())


def driver(guest, what):
    """Binds or unbinds the device. Gives when the kernel was told to, and when it had done so, by the guest's clock."""
    done = guest.run(f"a=$EPOCHREALTIME; echo vimc.0 >{DRIVER}/{what}; echo $a $EPOCHREALTIME").output
    return [float(each) for each in done.split()]


def check_times(guest):
    """Without a painter, which would take most of the guest's time: camera_states finds and supervises the camera as the
    program does, and tells each change."""
    slowness = patience.measure(guest)
    camera = guest.start("./camera_states auto", "camera")

    def told(state, after):
        """The time at which it was first told to be in a state."""
        def times():
            lines = [line.split(" ", 1) for line in camera.output().splitlines() if line[:1].isdigit()]
            return [float(time) for time, text in lines if text.startswith(state + " (") and float(time) > after]
        guest.wait_for(times, state, 60)
        return times()[0]

    told("streaming", 0)
    noticed, back = [], []
    for _ in range(TIMES):
        guest.run("sleep 5.5")  # from then on a loss is one of a camera that works
        unbound, gone = driver(guest, "unbind")
        noticed.append(told("lost", unbound) - unbound)
        _, bound = driver(guest, "bind")
        back.append(told("streaming", bound) - bound)
        print(f"the driver let go of it within {gone - unbound:.2f} s; noticed {noticed[-1]:.2f} s after it began; "
              f"streams again {back[-1]:.2f} s after it is bound", flush=True)
    camera.signal("TERM")
    for what, seconds, limit in (("noticed", noticed, NOTICED_SECONDS), ("streams again", back, BACK_SECONDS)):
        print(f"{what}: median {statistics.median(seconds):.2f} s, at most {max(seconds):.2f} s, "
              f"{max(seconds) / slowness:.3f} s × patience of {limit} s")
        assert max(seconds) <= limit * slowness, camera.output()


def check_listing(guest):
    """Every camera once, and none of the pipeline's nodes."""
    devices = json.loads(guest.run("./pleinair devices --json 2>/dev/null", seconds=40).output)
    found = [f"{camera['backend']}:{camera['id']}" for camera in devices["cameras"]]
    print("cameras:", ", ".join(found))
    assert len(set(found)) == len(found), found
    assert found and all(name.startswith("libcamera:") for name in found), (found, devices["problems"])


def check_colours(guest):
    # Above the text that the driver writes over its pattern.
    frame = live.read_frames(guest, 2, name="sensor")[-1]
    worst, text = colour_bars.farthest(frame, top=0.03, bottom=0.2)
    print(f"off by {worst:.1f} at most")
    assert worst <= colour_bars.TOLERANCE, text

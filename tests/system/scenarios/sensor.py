"""A sensor behind a pipeline, vimc, through libcamera: found by `auto`, listed once, in the colours of its pattern and the
size that libcamera gives it; unbound in mid-stream, of which libcamera says nothing, and bound again at once, at which it
ends its process."""
import json

import colour_bars
import live

DRIVER = "/sys/bus/platform/drivers/vimc"
# Of the guest's real time; on hardware well below.
BACK_SECONDS = 5


def run(guest):
    live.load_drivers(guest)
    guest.run("modprobe -r vivid; modprobe vimc; udevadm settle")
    check_listing(guest)
    program = live.Program(guest, "--set camera.size=320x180", camera="auto")
    status = program.wait_for_more(3)
    assert status["camera"]["backend"] == "libcamera", status["camera"]
    print("frames:", status["camera"]["format"])
    check_colours(guest)
    live.check_sums(status)

    for time in (1, 2):
        guest.run(f"echo vimc.0 >{DRIVER}/unbind")
        program.wait_until(live.is_without_camera, "the loss to be seen")
        shown = program.shown()
        begin = live.uptime(guest)
        guest.run(f"echo vimc.0 >{DRIVER}/bind; udevadm settle")
        status = program.wait_until(lambda status: live.shown_of(status) > shown, "new frames", 60)
        took = live.uptime(guest) - begin
        print(f"bound: a new frame is shown after {took:.2f} s or less")
        assert status["camera"]["backend"] == "libcamera", status["camera"]
        live.check_sums(program.wait_for_more(2))
    print(program.stop())


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

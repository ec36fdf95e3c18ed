"""The GPU, here Mesa's software rasteriser, draws straight into buffers of a virtual card (virtio-gpu) that were
allocated through GBM: the card shows the painted picture, turned and between bars, and the last painting is read back from
there. `devices` says so, and that pictures are copied to a second card (vkms), whose memory that GPU does not take."""
import json
import os

import live
import screens
from scenarios import display_writeback

DEVICES = ("virtio-gpu-pci,id=card",)
SIZE = (640, 480)


def run(guest):
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    film(guest, SIZE)
    painted = display_writeback.paint_once(guest, SIZE)
    for turns in (0, 2):
        shown, output = show(guest, f"direct-{turns}", f"--set output.display.rotation={90 * turns}")
        assert output["scan_out"] == "direct", output
        assert output["direct"] >= 4, output
        worst = shown.farthest(painted.turned(turns))
        print(f"turned by {90 * turns} degrees, {output['scan_out_reason']}, after a trial of "
              f"{output['scan_out_trial_ms']:.0f} ms: off by {worst} levels at most")
        assert worst <= 1, f"{worst} levels off the painting"
        assert shown.farthest(painted.turned(turns + 2)) > 100, "blind to a wrong turn"

    upright = (480, 360)  # between bars, once it is turned
    film(guest, upright)
    painted = display_writeback.on_display(display_writeback.paint_once(guest, upright).turned(1))
    shown, output = show(guest, "direct-1", "--set output.display.rotation=90", upright)
    assert output["scan_out"] == "direct", output
    assert shown.farthest(painted) <= 1, f"{shown.farthest(painted)} levels off the painting"
    assert shown.farthest(painted.turned(2)) > 100, "blind to a wrong turn"
    kept = screens.read_png(os.path.join(guest.folder, "state-direct-1", "last-painting.png"))
    assert (kept.width, kept.height) == upright, f"{kept.width}x{kept.height}"
    original = screens.read_png(os.path.join(guest.folder, f"{upright[0]}x{upright[1]}.png"))
    assert kept.farthest(original) <= 1, f"the kept painting is {kept.farthest(original)} levels off"
    print("upright between bars, and as the painting that is kept: as painted")

    shown, output = show(guest, "copied", "--set output.display.scan_out=copied", upright)
    assert output["scan_out"] == "copied" and output["direct"] == 0, output

    guest.run("modprobe vkms; udevadm settle")
    devices = json.loads(guest.run("env GALLIVM_PERF=nopt ./pleinair devices --json 2>/dev/null", seconds=60).output)
    paths = {each["target"]: each["scan_out"] for each in devices["outputs"] if each["kind"] == "display"}
    print(paths)
    (own,) = [path for target, path in paths.items() if "card0" in target]
    (other,) = [path for target, path in paths.items() if "card1" in target]
    assert own.startswith("the GPU draws straight"), own
    assert other.startswith("pictures are copied: GPU"), other


def film(guest, size):
    display_writeback.write_recording(os.path.join(guest.folder, f"{size[0]}x{size[1]}.y4m"), size)


def start(guest, name, arguments, size):
    return guest.start(
        f"env GALLIVM_PERF=nopt STATE_DIRECTORY=/host/state-{name} ./pleinair run "
        f"--camera {size[0]}x{size[1]}.y4m --style none --size {size[0]}x{size[1]} "
        f"--set output.display.mode={SIZE[0]}x{SIZE[1]} --set runtime.quality=full "
        f"--set status.listen={live.STATUS} {arguments}", name)


def show(guest, name, arguments, size=SIZE):
    """What the card shows once the trial is over and some frames were drawn, and the output's status."""
    program = start(guest, name, "--output display " + arguments, size)
    watched = live.Watched(guest, program)
    wanted = "copied" if name == "copied" else "direct"

    def is_there(status):
        (output,) = status["outputs"] or ({},)
        is_decided = output.get("scan_out") is not None
        drawn = output.get("direct", 0) >= 4 if wanted == "direct" else True
        return is_decided and (output["scan_out"] != wanted or drawn) and live.shown_of(status) >= 4

    status = watched.wait_until(is_there, "the trial and frames", seconds=90)
    (output,) = status["outputs"]
    assert output["failures"] == 0, output
    shown = screens.read_ppm(guest.screenshot("shown-" + name, "card"))
    print(watched.stop())
    return shown, output

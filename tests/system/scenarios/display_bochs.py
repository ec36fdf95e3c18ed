"""bochs, a graphics card that only shows buffers which the processor has written: its display shows the painted
picture, and afterwards what it showed before."""
import os

import live
import screens
from scenarios import display_writeback

DEVICES = ("bochs-display,id=card",)
SIZE = (640, 480)


def run(guest):
    guest.run("modprobe bochs; until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    driver = os.path.basename(guest.run("readlink /sys/class/drm/card0/device/driver").output.strip())
    assert driver.startswith("bochs"), driver
    before = screens.read_ppm(guest.screenshot("before", "card"))
    display_writeback.write_recording(os.path.join(guest.folder, f"{SIZE[0]}x{SIZE[1]}.y4m"), SIZE)
    painted = display_writeback.paint_once(guest, SIZE)

    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera {SIZE[0]}x{SIZE[1]}.y4m --style none "
        f"--size {SIZE[0]}x{SIZE[1]} --output display --set output.display.mode={SIZE[0]}x{SIZE[1]} "
        f"--set output.display.scan_out=copied "
        f"--set output.waiting_pictures=false --set runtime.quality=full --set status.listen={live.STATUS}",
        "bochs")
    watched = live.Watched(guest, program)
    status = watched.wait_until(lambda status: live.shown_of(status) >= 2, "two frames", seconds=60)
    (output,) = status["outputs"]
    assert output["failures"] == 0, output
    shown = screens.read_ppm(guest.screenshot("shown", "card"))
    worst = shown.farthest(painted)
    print(f"off by {worst} levels at most")
    assert worst <= 1, f"{worst} levels off the painting"
    assert shown.farthest(painted.turned(2)) > 100, "blind to a wrong turn"
    print(watched.stop())

    def is_back():
        now = screens.read_ppm(guest.screenshot("after", "card"))
        return (now.width, now.height) == (before.width, before.height) and now.farthest(before) == 0

    guest.wait_for(is_back, "what was shown before")
    print("afterwards the display shows what it showed before")

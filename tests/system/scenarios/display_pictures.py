"""A virtual graphics card (virtio-gpu, without vertical blanking): its display shows the painted picture, at
the right place, turned as asked, and afterwards what it showed before."""
import os

import live
import screens

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=2",)
# One of the card's modes; the painting has the same size, so that nothing is scaled.
SIZE = (640, 480)


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)  # a still picture
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    before = screens.read_ppm(guest.screenshot("before", "card"))

    painted = paint_once(guest)
    for turns, fit in ((0, "letterbox"), (2, "fill")):
        shown = show(guest, f"{90 * turns}-{fit}", turns, fit)
        worst = shown.farthest(painted.turned(turns))
        print(f"turned by {90 * turns} degrees: off by {worst} levels at most")
        assert worst <= 1, f"{worst} levels off the painting"
        assert shown.farthest(painted.turned(turns + 1).turned(1)) > 100, "blind to a wrong turn"

    # Upright, it is smaller, between bars.
    shown = show(guest, "90-letterbox", 1, "letterbox")
    check_bars(shown)
    area = shown.part((SIZE[0] - 360) // 2, 0, 360, 480)
    upright = painted.turned(1)
    for part in range(8):
        box = (0.2, (part + 0.3) / 8, 0.8, (part + 0.7) / 8)
        off = max(abs(a - b) for a, b in zip(area.mean(*box), upright.mean(*box)))
        assert off < 6, f"bar {part}: {off:.1f} levels off"

    guest.wait_for(lambda: screens.read_ppm(guest.screenshot("after", "card")).farthest(before) == 0
                   if has_size_of(guest, before) else False, "what was shown before")
    print("afterwards the display shows what it showed before")


def has_size_of(guest, before):
    now = screens.read_ppm(guest.screenshot("after", "card"))
    return (now.width, now.height) == (before.width, before.height)


def paint_once(guest):
    guest.run(f"env GALLIVM_PERF=nopt ./pleinair run --camera v4l2:{live.CAMERA} --style none "
              f"--size {SIZE[0]}x{SIZE[1]} --output painted.png --frames 1", seconds=60)
    return screens.read_png(os.path.join(guest.folder, "painted.png"))


def show(guest, name, turns, fit):
    """What the display shows once a few frames have been shown on it."""
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera v4l2:{live.CAMERA} --style none "
        f"--size {SIZE[0]}x{SIZE[1]} --output display:Virtual-1 "
        f"--set output.display.mode={SIZE[0]}x{SIZE[1]} --set output.display.fit={fit} "
        f"--set output.display.rotation={90 * turns} --set runtime.quality=full --set status.listen={live.STATUS}", "display-" + name)
    watched = live.Watched(guest, program)
    watched.wait_for_more(1)
    guest.run("sleep 1")  # the painting fades in
    status = watched.wait_for_more(5)
    (output,) = status["outputs"]
    assert output["failures"] == 0, output
    assert output["pacing"] == "clock", output
    shown = screens.read_ppm(guest.screenshot("shown-" + name, "card"))
    print(watched.stop())
    return shown


def check_bars(shown):
    assert (shown.width, shown.height) == SIZE, f"{shown.width}x{shown.height}"
    for x in (0, 139, 500, 639):
        assert shown.at(x, 240) == (0, 0, 0), f"column {x} is {shown.at(x, 240)}"

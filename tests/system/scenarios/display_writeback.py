"""vkms writes back what it shows: it is the painted picture to the bit, turned, between bars or with its overhang cut
off. Pictures are copied there: Mesa's software rasteriser shares memory with virtio-gpu and vgem only, and display_direct
draws into that of virtio-gpu."""
import os
import random

import live
import screens

DISPLAY = (640, 480)
# Of the painting, so that nothing is scaled; by fit and whether it is turned upright.
SIZES = {("letterbox", False): (512, 480), ("letterbox", True): (480, 360),
         ("fill", False): (640, 500), ("fill", True): (500, 640)}


def run(guest):
    guest.run("modprobe vkms; udevadm settle")
    painted = {}
    for (fit, upright), size in SIZES.items():
        write_recording(os.path.join(guest.folder, f"{size[0]}x{size[1]}.y4m"), size)
        painted[fit, upright] = paint_once(guest, size)
    for fit in ("letterbox", "fill"):
        for turns in range(4):
            upright = turns % 2 == 1
            shown = show(guest, SIZES[fit, upright], fit, turns)
            expected = on_display(painted[fit, upright].turned(turns))
            assert shown.farthest(expected) == 0, \
                f"{fit}, {90 * turns} degrees: {shown.farthest(expected)} levels off"
            assert shown.farthest(on_display(painted[fit, upright].turned(turns + 2))) > 100, \
                "blind to a wrong turn"
            print(f"{fit}, {90 * turns} degrees: equal to the bit")


def write_recording(path, size, rate=2):
    """Frames of noise, which compares every pixel."""
    width, height = size
    noise = random.Random(1)
    with open(path, "wb") as file:
        file.write(f"YUV4MPEG2 W{width} H{height} F{rate}:1 Ip A1:1 C420jpeg\nFRAME\n".encode())
        file.write(noise.randbytes(width * height + 2 * (width // 2) * (height // 2)))


def paint_once(guest, size):
    name = f"{size[0]}x{size[1]}"
    guest.run(f"env GALLIVM_PERF=nopt ./pleinair run --camera {name}.y4m --style none --size {name} "
              f"--set runtime.quality=full --output {name}.png --frames 1", seconds=60)
    return screens.read_png(os.path.join(guest.folder, name + ".png"))


def on_display(picture):
    """The picture in the middle of a black display, its overhang cut off."""
    width, height = DISPLAY
    left, top = max(0, (picture.width - width) // 2), max(0, (picture.height - height) // 2)
    part = picture.part(left, top, min(width, picture.width), min(height, picture.height))
    x, y = (width - part.width) // 2, (height - part.height) // 2
    black = bytes(3 * width)
    rows = [bytes(3 * x) + row + bytes(3 * (width - x - part.width)) for row in part.rows]
    return screens.Picture(width, height, [black] * y + rows + [black] * (height - y - part.height))


def show(guest, size, fit, turns):
    name = f"{fit}-{90 * turns}"
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera {size[0]}x{size[1]}.y4m --style none "
        f"--size {size[0]}x{size[1]} --output display --set output.display.mode={DISPLAY[0]}x{DISPLAY[1]} "
        f"--set output.display.fit={fit} --set output.display.rotation={90 * turns} "
        f"--set output.waiting_pictures=false --set runtime.quality=full --set status.listen={live.STATUS}",
        "show-" + name)
    watched = live.Watched(guest, program)
    watched.wait_until(lambda status: live.shown_of(status) >= 2, "two frames", seconds=90)
    guest.run(f"./writeback $(cat /host/.guest/show-{name}.pid) /dev/dri/card0 {name}.ppm")
    shown = screens.read_ppm(os.path.join(guest.folder, name + ".ppm"))
    watched.wait_for_more(1)  # it has not minded
    (output,) = watched.status()["outputs"]
    assert output["failures"] == 0, output
    assert output["scan_out"] == "copied" and output["scan_out_reason"], output
    watched.stop()
    return shown

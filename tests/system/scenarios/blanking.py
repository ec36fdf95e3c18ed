"""A screen that is switched off when nothing has moved before the camera, and on by a movement and by a key."""
import time

import live

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1", "virtio-keyboard-pci")
DPMS = "cat /sys/class/drm/card0-Virtual-1/dpms"
# Of vivid's menu "Horizontal Movement".
STILL, LEFT_FAST = 3, 0


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2, horizontal_movement=LEFT_FAST)
    guest.run("until [ -e /dev/dri/card0 ] && [ -e /dev/input/event0 ]; do sleep 0.1; done; udevadm settle")
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera v4l2:{live.CAMERA} --style none "
        f"--size 160x90 --output display --set output.display.mode=640x480 "
        f"--set output.display.blank_after=4 --set status.listen={live.STATUS}", "pleinair")
    watched = live.Watched(guest, program)
    watched.wait_for_more(3)
    watched.wait_until(lambda s: s["camera"]["quiet_s"] < 1, "a movement")
    stays_on(guest, seconds=6)
    print("on while something moves")

    for name, somebody in (("movement", lambda: live.control(guest, horizontal_movement=LEFT_FAST)),
                           ("key", lambda: guest.qemu("send-key", keys=[{"type": "qcode", "data": "z"}]))):
        live.control(guest, horizontal_movement=STILL)
        status = watched.wait_until(lambda s: display(s)["state"] == "blanked", "the blanking")
        assert display(status)["suspension"] == "nothing has moved for 4.0 s", status
        assert guest.run(DPMS).output.strip() == "Off", "the display is not off"
        blanked = display(status)["ended"]["blanked"]
        watched.wait_until(lambda s: display(s)["ended"]["blanked"] > blanked + 3, "blanked frames")
        began = time.monotonic()
        somebody()
        watched.wait_until(lambda s: display(s)["state"] == "taking", "the picture")
        print(f"on by a {name} after {time.monotonic() - began:.1f} s at most, "
              f"in which the guest answered {'a call' if name == 'key' else 'two calls'}")
        assert guest.run(DPMS).output.strip() == "On"
    status = watched.status()
    assert display(status)["failures"] == 0, status
    live.check_sums(status)
    print(watched.stop())


def stays_on(guest, seconds):
    """Fails if the display goes off meanwhile."""
    deadline = time.monotonic() + guest.patient(seconds)
    while time.monotonic() < deadline:
        assert guest.run(DPMS).output.strip() == "On", "it went off"


def display(status):
    return status["outputs"][0]

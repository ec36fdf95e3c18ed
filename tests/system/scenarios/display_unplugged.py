"""A display that is switched off and on, and a whole card that is pulled out and plugged in again: the loopback
beside it goes on, and the picture is back."""
import live
import screens

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1",)
CONNECTOR = "/sys/class/drm/card0-Virtual-1/status"


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera v4l2:{live.CAMERA} --style none "
        f"--size 160x90 --output display --set output.display.mode=640x480 "
        f"--output loopback:{live.LOOPBACK} --set status.listen={live.STATUS}", "pleinair")
    watched = live.Watched(guest, program)
    watched.wait_for_more(5)

    # No event is sent for this: the program looks for itself.
    guest.run(f"echo off >{CONNECTOR}")
    watched.wait_until(lambda s: display(s)["state"] != "taking", "the loss of the display")
    before = shown_on(loopback(watched.status()))
    watched.wait_until(lambda s: shown_on(loopback(s)) > before + 5, "more on the loopback")
    guest.run(f"echo on >{CONNECTOR}; echo detect >{CONNECTOR}")
    shown = shown_on(display(watched.status()))
    watched.wait_until(lambda s: shown_on(display(s)) > shown + 3, "the picture again")
    print("switched off and on: the loopback went on, the picture is back")

    # QEMU does not unplug such a card; the kernel can be told to let go of it.
    guest.run("echo 1 >/sys/class/drm/card0/device/remove")
    watched.wait_until(lambda s: display(s)["state"] != "taking", "the loss of the card")
    guest.wait_for(lambda: guest.run("ls /dev/dri/card0", check=False).status != 0, "the card's end")
    before = shown_on(loopback(watched.status()))
    watched.wait_until(lambda s: shown_on(loopback(s)) > before + 5, "more on the loopback")
    shown = shown_on(display(watched.status()))
    guest.run("echo 1 >/sys/bus/pci/rescan")
    watched.wait_until(lambda s: shown_on(display(s)) > shown + 3, "the picture again", seconds=60)
    picture = screens.read_ppm(guest.screenshot("back", "card"))
    assert max(picture.mean(0.2, 0.4, 0.4, 0.6)) > 30, "the display is black"
    live.check_sums(watched.status())
    print(watched.stop())


def display(status):
    return next(each for each in status["outputs"] if each["name"].startswith("display"))


def loopback(status):
    return next(each for each in status["outputs"] if each["name"].startswith("loopback"))


def shown_on(output):
    return output["ended"]["shown"] + output["ended"]["shown_off_schedule"]

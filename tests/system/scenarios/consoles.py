"""A screen without a desktop: keys of a keyboard, consoles that are switched by keys and by chvt, and what a
killed program leaves."""
import live
import screens

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1", "virtio-keyboard-pci")


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)
    guest.run("until [ -e /dev/dri/card0 ] && [ -e /dev/input/event0 ]; do sleep 0.1; done; udevadm settle")
    guest.run("for i in 1 2; do echo this is console $i >/dev/tty$i; done")
    assert "/dev/input/event0" in guest.run("./pleinair devices").output
    before = shot(guest, "1-before")

    watched = start(guest, "first")
    watched.wait_for_more(5)
    assert is_painted(shot(guest, "2-painted")), "no picture"

    pauses(guest, watched)
    print("a key pauses")

    # More keys than the kernel keeps (SYN_DROPPED), while the program does not read.
    watched.command.signal("STOP")
    for _ in range(80):
        press(guest, "shift", "z")
    watched.command.signal("CONT")
    watched.wait_for_more(3)
    pauses(guest, watched)
    print("and again after an overrun")

    for name, there, back in (("chvt", chvt(2), chvt(1)),
                              ("keys", keys("ctrl", "alt", "f2"), keys("ctrl", "alt", "f1"))):
        there(guest)
        status = watched.wait_until(lambda s: display(s)["state"] == "suspended", "the suspension")
        assert "console" in display(status)["suspension"], status
        assert not is_painted(shot(guest, f"3-{name}-away")), "the picture is still there"
        press(guest, "q")  # of the other console
        suspended = display(status)["ended"]["suspended"]
        watched.wait_until(lambda s: display(s)["ended"]["suspended"] > suspended + 3,
                           "frames that end as suspended")
        shown = shown_on(watched.status())
        back(guest)
        watched.wait_until(lambda s: shown_on(s) > shown + 3, "the picture again")
        assert is_painted(shot(guest, f"4-{name}-back")), "no picture"
        print(f"away and back by {name}")
    status = watched.status()
    assert display(status)["failures"] == 0, status
    live.check_sums(status)

    watched.command.signal("KILL")
    watched.command.wait()
    guest.run("echo still here >/dev/tty1")
    guest.wait_for(lambda: not is_painted(shot(guest, "5-killed")), "the console after SIGKILL")
    assert shot(guest, "5-killed").farthest(before) > 100, "nothing is written on it"
    chvt(2)(guest)
    chvt(1)(guest)
    print("killed: the console is back, and switches")

    watched = start(guest, "second")
    watched.wait_for_more(3)
    press(guest, "q")
    ended = watched.command.wait()
    assert ended.status == 0, ended.output
    guest.wait_for(lambda: not is_painted(shot(guest, "6-ended")), "the console after the end")
    print("a key ends it")


def start(guest, name):
    program = guest.start(
        f"env GALLIVM_PERF=nopt ./pleinair run --camera v4l2:{live.CAMERA} --style none "
        f"--size 160x90 --output display --set output.display.mode=640x480 "
        f"--set status.listen={live.STATUS}", name)
    return live.Watched(guest, program)


def pauses(guest, watched):
    """Fails unless Space pauses and goes on."""
    press(guest, "spc")
    repeats = display(watched.status())["repeats"]
    watched.wait_until(lambda s: display(s)["repeats"] > repeats + 3, "a pause by a key")
    press(guest, "spc")
    watched.wait_for_more(3)


def press(guest, *names):
    guest.qemu("send-key", keys=[{"type": "qcode", "data": name} for name in names])


def keys(*names):
    return lambda guest: press(guest, *names)


def chvt(number):
    return lambda guest: guest.run(f"busybox chvt {number}")


def shot(guest, name):
    return screens.read_ppm(guest.screenshot(name, "card"))


def is_painted(picture):
    """The camera's bars; a console is dark, but for its letters."""
    return max(picture.mean(0.2, 0.4, 0.4, 0.6)) > 30


def display(status):
    return status["outputs"][0]


def shown_on(status):
    ended = display(status)["ended"]
    return ended["shown"] + ended["shown_off_schedule"]

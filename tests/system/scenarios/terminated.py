"""SIGTERM at several moments: within two seconds the program has ended with status 0, its ledger adds up,
and nothing of it is left. Under emulation a shader's compilation takes longer than a stop may: then, at the
start only, the program says that it left the painter behind."""
import live


def run(guest):
    live.load_drivers(guest)
    for name, wait in (("at once", at_once), ("with its first frame", with_first_frame),
                       ("while a reader reads", while_read), ("without a camera", without_camera)):
        program = live.Program(guest)
        wait(guest, program)
        print(f"terminated {name}: {program.stop(may_leave_painter=wait is at_once)}")
        check_nothing_left(guest)


def at_once(guest, program):
    """As soon as it listens for signals: its libraries are loaded, its GPU is not yet set up."""
    sigterm = 1 << 14
    guest.wait_for(lambda: program.command.caught_signals() & sigterm, "it to listen for signals")


def with_first_frame(guest, program):
    program.wait_for_more(1)


def while_read(guest, program):
    program.wait_for_more(2)
    guest.start(f"v4l2-ctl -d {live.LOOPBACK} --stream-mmap", "reader")
    program.wait_for_more(2)


def without_camera(guest, program):
    program.wait_for_more(2)
    live.unplug(guest)
    program.wait_until(live.is_without_camera, "the loss")


def check_nothing_left(guest):
    guest.run("for pid in $(pidof v4l2-ctl); do kill $pid; done", check=False)
    left = guest.run("pidof pleinair", check=False)
    assert left.status != 0, f"processes are left: {left.output}"
    # The camera and the loopback are free: others can take them.
    guest.run(f"[ -e {live.CAMERA} ] || echo vivid.0 >/sys/bus/platform/drivers/vivid/bind")
    guest.run("udevadm settle")
    live.set_camera(guest, "NV12")
    live.set_camera(guest, "YUYV")
    guest.wait_for(lambda: "Video Output" in guest.run(
        f"v4l2-ctl -d {live.LOOPBACK} --info").output, "the loopback to be free", 5)

"""Shared by the scenarios: the drivers, the running program, and the readers of its outputs."""
import json
import os

import closing_line
import frames

CAMERA = "/dev/video0"
LOOPBACK = "/dev/video50"
VIVID = "/sys/devices/platform/vivid.0/video4linux"
CAMERA_SIZE = (320, 180)  # the smallest of vivid's as a webcam
SIZE = (160, 90)  # of the painting
STATUS = "127.0.0.1:9117"


def load_drivers(guest, vivid="", loopbacks=1):
    """vivid, with more parameters, as /dev/video0, and v4l2loopback as /dev/video50 and on. Frames are
    small; readers see a loopback only while a program writes to it."""
    numbers = [str(50 + i) for i in range(loopbacks)]
    guest.run(
        f"modprobe vivid n_devs=1 node_types=0x1 {vivid}\n"
        f"modprobe v4l2loopback video_nr={','.join(numbers)} "
        f"card_label={','.join('loop' + n for n in numbers)} "
        f"exclusive_caps={','.join('1' for _ in numbers)}\n"
        "udevadm settle")
    set_camera(guest, "YUYV")


def set_camera(guest, fourcc, size=CAMERA_SIZE):
    """The driver's default format."""
    guest.run(f"v4l2-ctl -d {CAMERA} "
              f"--set-fmt-video=width={size[0]},height={size[1]},pixelformat={fourcc}")


def control(guest, **values):
    """Sets vivid's controls. One that is plugged in while frames of the one before are held has another node."""
    listing = ",".join(f"{name}={value}" for name, value in values.items())
    guest.run(f"v4l2-ctl -d /dev/$(ls {VIVID} | head -n1) --set-ctrl {listing}")


def unplug(guest):
    guest.run("echo vivid.0 >/sys/bus/platform/drivers/vivid/unbind")


def plug(guest):
    guest.run("echo vivid.0 >/sys/bus/platform/drivers/vivid/bind")


def uptime(guest):
    """The guest's monotonic clock in seconds, which V4L2's timestamps use, too."""
    return float(guest.run("cut -d' ' -f1 /proc/uptime").output)


class Watched:
    """A running `pleinair run`, a Background, with its status server at STATUS."""

    def __init__(self, guest, command):
        self._guest = guest
        self.command = command

    def status(self):
        """The JSON of its status page; None until the page exists."""
        host, port = STATUS.split(":")
        page = self._guest.run(
            f"exec 3<>/dev/tcp/{host}/{port} || exit 1\n"
            "printf 'GET /status HTTP/1.0\\r\\n\\r\\n' >&3; cat <&3", check=False)
        return json.loads(page.output.split("\n\n", 1)[1]) if page.status == 0 else None

    def shown(self):
        status = self.status()
        ended = status["frames"]["ended"] if status else {}
        return ended.get("shown", 0) + ended.get("shown_off_schedule", 0)

    def wait_until(self, condition, what, seconds=30):
        """Waits until a condition on its status holds; returns that status."""
        seen = []

        def holds():
            assert self.command.is_running(), "the program ended:\n" + self.command.output()
            status = self.status()
            if status is not None:
                seen.append(status)
            return status is not None and condition(status)

        try:
            self._guest.wait_for(holds, what, seconds)
        except Exception:
            print("its last status:", json.dumps(seen[-1]) if seen else "none")
            raise
        return seen[-1]

    def wait_for_more(self, count, seconds=60):
        """Waits until it has shown this many more frames; returns its status."""
        goal = self.shown() + count
        return self.wait_until(lambda status: shown_of(status) >= goal, f"{goal} frames shown",
                               seconds)

    def stop(self, seconds=2):
        """Ends it by SIGTERM. It must end in time, with status 0 and consistent frame counts, which this
        returns. Under emulation one GL call may take longer than the time to stop; then the program
        reports that it abandoned the painter, with status 1."""
        begin = uptime(self._guest)
        self.command.signal("TERM")
        finished = self.command.wait(seconds + 5)
        took = uptime(self._guest) - begin
        is_left = finished.status == 1 and "paint did not end in time" in finished.output
        assert finished.status == 0 or (is_left and self._guest.accelerator != "kvm"), \
            f"status {finished.status}:\n{finished.output}"
        if is_left:
            print("too slow here for a clean end: the painter was left behind")
        assert took < self._guest.patient(seconds), f"it took {took:.1f} s to end"
        return closing_line.ledger(finished.output)


class Program(Watched):
    """`pleinair run` with a V4L2 camera and loopbacks."""

    def __init__(self, guest, arguments="", camera=f"v4l2:{CAMERA}", outputs=(LOOPBACK,),
                 style="none"):
        targets = " ".join(f"--output loopback:{node}" for node in outputs)
        # Under emulation, compiling shaders costs more than running them: Mesa's compiler does not
        # optimise, which halves the time to start.
        super().__init__(guest, guest.start(
            f"env GALLIVM_PERF=nopt ./pleinair run --camera {camera} {targets} --style {style} "
            f"--size {SIZE[0]}x{SIZE[1]} --set status.listen={STATUS} {arguments}", "pleinair"))


def shown_of(status):
    ended = status["frames"]["ended"]
    return ended["shown"] + ended["shown_off_schedule"]


def is_without_camera(status):
    return status["camera"]["state"] != "streaming"


def check_sums(status):
    """Every captured frame is in flight or has ended, under one name."""
    sums = status["frames"]
    total = sums["in_flight"] + sum(sums["ended"].values())
    assert sums["captured"] == total, f"captured {sums['captured']}, accounted for {total}: {sums}"


def read_frames(guest, count, device=LOOPBACK, name="read", skip=0, seconds=60):
    """Reads `count` frames from a device with v4l2-ctl, like another program."""
    form = frames.Format(guest.run(f"v4l2-ctl -d {device} --get-fmt-video").output)
    guest.run(f"timeout {guest.patient(seconds):.0f} v4l2-ctl -d {device} --stream-mmap "
              f"--stream-skip={skip} --stream-count={count} --stream-to=/host/{name}.raw",
              seconds + 5)
    with open(os.path.join(guest.folder, name + ".raw"), "rb") as file:
        taken = frames.split(file.read(), form)
    assert len(taken) == count, f"{len(taken)} frames, not {count}"
    taken[-1].write_png(os.path.join(guest.folder, name + ".png"))
    return taken

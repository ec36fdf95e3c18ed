"""A machine that is suspended and resumed: the display shows the painting again, the camera's frames go on, and nothing was
lost on the way.

Programs are frozen, all drivers put their devices to sleep and wake them, the second processor is switched off and on,
and the clock is told how long that took. The firmware's part alone is left out (pm_test=core), because a guest that is
emulated is reset where it should wake from S3. The card is bochs, whose driver sets its mode again."""
import os

import live
import screens
from guest import Finished

DEVICES = ("bochs-display,id=card",)
SIZE = (640, 480)

# The folder shared with the host does not survive this kernel's sleep, so nothing may use it meanwhile.
SLEEP = """cd /
until umount /host; do sleep 0.2; done
device=$(basename $(ls -d /sys/bus/virtio/drivers/9pnet_virtio/virtio*))
echo $device >/sys/bus/virtio/drivers/9pnet_virtio/unbind
echo core >/sys/power/pm_test
cut -d' ' -f1 /proc/uptime >/tmp/asleep
echo mem >/sys/power/state; echo $? >/tmp/slept
cut -d' ' -f1 /proc/uptime >/tmp/awake
echo $device >/sys/bus/virtio/drivers/9pnet_virtio/bind
mount -t 9p -o trans=virtio,version=9p2000.L,msize=262144,cache=none host /host
echo awake >/dev/ttyS0
"""


def run(guest):
    guest.run("modprobe bochs; until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)
    states = guest.run("cat /sys/power/mem_sleep").output
    assert "deep" in states, f"this machine cannot sleep: {states}"
    guest.run("cp pleinair /tmp; cd /tmp; cat >run.sh <<'END'\n"
              f"env GALLIVM_PERF=nopt /tmp/pleinair run --camera v4l2:{live.CAMERA} --style none "
              f"--size {SIZE[0]}x{SIZE[1]} --output display --set output.display.mode={SIZE[0]}x{SIZE[1]} "
              f"--set output.keep_last_painting=false --set status.listen={live.STATUS} &\n"
              "echo $! >/tmp/pid; wait $!; echo $? >/tmp/status\nEND\n"
              "setsid bash /tmp/run.sh >/tmp/out 2>&1 </dev/null &", seconds=60)
    watched = live.Watched(guest, Sleeper(guest))
    watched.wait_for_more(5)
    before = screens.read_ppm(guest.screenshot("before", "card"))
    assert is_painting(before), "no painting before"
    begun = watched.status()

    with open(os.path.join(guest.folder, "sleep.sh"), "w") as file:
        file.write(SLEEP)
    guest.run("cp sleep.sh /tmp; cd /tmp; echo deep >/sys/power/mem_sleep; "
              "setsid bash /tmp/sleep.sh >/tmp/sleep.out 2>&1 </dev/null &")
    guest.wait_for(lambda: "awake" in serial(guest), "the shared folder again", seconds=60)
    asleep, awake, status = guest.run("cat /tmp/asleep /tmp/awake /tmp/slept").output.split()
    assert status == "0", "the kernel did not go to sleep: " + guest.run("dmesg | tail -30").output
    kernel = guest.run("dmesg | grep -E 'PM: suspend|ACPI: PM: (Preparing|Waking)'").output
    assert "suspend entry (deep)" in kernel, kernel
    woken = live.uptime(guest)
    status = watched.wait_until(lambda s: shown(s) > shown(begun) + 3, "paintings again", seconds=60)
    print(f"asleep for {float(awake) - float(asleep):.1f} s; more paintings were shown within "
          f"{live.uptime(guest) - woken:.1f} s")

    def is_seen():
        return is_painting(screens.read_ppm(guest.screenshot("after", "card")))

    guest.wait_for(is_seen, "the painting on the card's display")
    live.check_sums(status)
    assert status["painting"]["context_losses"] == 0, status["painting"]
    assert watched.command.is_running(), watched.command.output()
    print(watched.stop(10))


def shown(status):
    ended = status["outputs"][0]["ended"]
    return ended["shown"] + ended["shown_off_schedule"]


def serial(guest):
    with open(guest.serial_log, errors="replace") as file:
        return file.read()


def is_painting(picture):
    """Whether vivid's bars, of which the first is white and the last black, are there."""
    if (picture.width, picture.height) != SIZE:
        return False
    left = picture.mean(0.02, 0.4, 0.06, 0.6)
    right = picture.mean(0.94, 0.4, 0.98, 0.6)
    return min(left) > 150 and max(right) < 30


class Sleeper:
    """The program, of which nothing lies in the shared folder; as guest.Background."""

    def __init__(self, guest):
        self._guest = guest

    def signal(self, name):
        self._guest.run(f"kill -{name} $(cat /tmp/pid)")

    def is_running(self):
        return self._guest.run("kill -0 $(cat /tmp/pid)", check=False).status == 0

    def output(self):
        return self._guest.run("cat /tmp/out").output

    def wait(self, seconds):
        self._guest.wait_for(lambda: self._guest.run("cat /tmp/status", check=False).status == 0, "its end", seconds)
        return Finished(int(self._guest.run("cat /tmp/status").output), self.output())

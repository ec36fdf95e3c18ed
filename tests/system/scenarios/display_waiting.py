"""What a display shows from the program's start to its end: a camera that comes late, goes and returns, and the run after
that, which begins with the last painting of this one. Never black, never the console."""
import live
import screens

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1",)
SIZE = (640, 480)
# Where the text stands: the margin of the sheet.
MARGIN = (0.1, 0.84, 0.9, 0.99)


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)
    live.unplug(guest)
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    before = live.uptime(guest)
    watched = start(guest, "first")
    first = wait_for(guest, "1-first", is_paper, "the first picture")
    print(f"the first picture was seen after {live.uptime(guest) - before:.1f} s")
    assert ink(first) > 300, "the first picture says nothing"
    watched.wait_until(lambda s: s["camera"]["state"] != "streaming", "a wait for the camera")
    assert is_paper(take(guest, "2-still-waiting")), "the picture did not stay"

    live.plug(guest)
    live.control(guest, osd_text_mode=2)
    watched.wait_until(lambda s: s["outputs"] and shown_on(s) > 0, "a painting", seconds=90)
    take(guest, "3-fading")
    painted = wait_for(guest, "4-live", is_bars, "the painting, faded in")

    live.unplug(guest)
    lost = wait_for(guest, "5-lost", is_paper, "a picture that says that the camera is gone")
    assert ink(lost) > 300, "it says nothing"
    assert reddest(lost) == reddest(painted), "it does not show the last painting"
    live.plug(guest)
    live.control(guest, osd_text_mode=2)
    wait_for(guest, "6-back", is_bars, "the painting again", seconds=60)
    status = watched.status()
    live.check_sums(status)
    assert status["outputs"][0]["failures"] == 0, status["outputs"]
    print(watched.stop())

    live.unplug(guest)
    watched = start(guest, "second")
    again = wait_for(guest, "7-next-run", is_paper, "the first picture of the next run")
    assert reddest(again) == reddest(painted), "it does not show the painting of the run before"
    print(watched.stop())


def start(guest, name):
    return live.Watched(guest, guest.start(
        f"env GALLIVM_PERF=nopt XDG_STATE_HOME=/tmp/state ./pleinair run --camera v4l2:{live.CAMERA} "
        f"--style none --size {SIZE[0]}x{SIZE[1]} --output display "
        f"--set output.display.mode={SIZE[0]}x{SIZE[1]} --set camera.wait=true "
        f"--set runtime.quality=full --set status.listen={live.STATUS}", "pleinair-" + name))


def take(guest, name):
    return screens.read_ppm(guest.screenshot(name, "card"))


def wait_for(guest, name, condition, what, seconds=30):
    """The display's first picture with that property."""
    seen = []

    def holds():
        picture = take(guest, name)
        if (picture.width, picture.height) != SIZE or not condition(picture):
            return False
        seen.append(picture)
        return True

    guest.wait_for(holds, what, seconds)
    return seen[-1]


def is_paper(picture):
    """Whether there is bare paper in the margin and at the corners."""
    return min(picture.mean(*MARGIN)) > 215 and min(picture.at(2, picture.height - 3)) > 225


def is_bars(picture):
    """Whether vivid's bars, of which a picture of this shape shows yellow to blue, reach the lower corners undimmed."""
    left = picture.mean(0.01, 0.9, 0.06, 0.98)
    right = picture.mean(0.94, 0.9, 0.99, 0.98)
    return left[0] > 150 and left[2] < 80 and right[2] > 120 and max(right[:2]) < 60


def ink(picture):
    top = round(0.82 * picture.height)
    return sum(1 for row in picture.rows[top:] for red in row[::3] if red < 150)


def reddest(picture):
    """Which of eight columns is the reddest."""
    colours = [picture.mean((i + 0.3) / 8, 0.3, (i + 0.7) / 8, 0.6) for i in range(8)]
    return max(range(8), key=lambda i: colours[i][0] - (colours[i][1] + colours[i][2]) / 2)


def shown_on(status):
    ended = status["outputs"][0]["ended"]
    return ended["shown"] + ended["shown_off_schedule"]

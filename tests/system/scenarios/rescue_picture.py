"""`pleinair rescue` on a display without a camera and without GL: a sheet of paper with a text. A configuration that is wrong is
what it says. A control: without it the console is seen."""
import live
import screens
from scenarios import display_waiting as waiting

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1",)


def run(guest):
    live.load_drivers(guest)
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    assert not waiting.is_paper(waiting.take(guest, "0-console")), "a control: there is no picture yet"
    guest.run("printf '[style.watercolor]\\ncell_size = -3\\n' > /tmp/wrong.toml")
    began = live.uptime(guest)
    # No GL is found: the picture does not need any.
    rescue = guest.start("env XDG_STATE_HOME=/tmp/state EGL_PLATFORM=none LIBGL_DRIVERS_PATH=/nowhere ./pleinair rescue "
                         "--config /tmp/wrong.toml --seconds 300", "rescue")
    seen = []

    def is_shown():
        picture = screens.read_ppm(guest.screenshot("1-rescue", "card"))
        seen.append(picture)
        return waiting.is_paper(picture)

    guest.wait_for(is_shown, "the rescue picture", 30)
    print(f"the rescue picture was seen after {live.uptime(guest) - began:.1f} s")
    assert waiting.ink(seen[-1]) > 300, "it says nothing"
    rescue.signal("TERM")
    finished = rescue.wait(10)
    assert finished.status == 0, f"it did not end in order:\n{finished.output}"
    assert "wrong.toml:2" in finished.output, finished.output

"""The camera's format changes: in mid-stream (an HDMI source with other timings, V4L2_EVENT_SOURCE_CHANGE),
and while it is unplugged. What the program puts out keeps its size, and shows the picture still."""
import colour_bars
import live

# Names of VESA timings in vivid's menu; their colours are sRGB's, as those of the bars.
FIRST, SECOND = ("640x350p85", (640, 350)), ("640x400p85", (640, 400))
AFTER_RESET = (1280, 720)


def run(guest):
    # One input, HDMI, which gives frames of the source's size and no other.
    live.load_drivers(guest, "num_inputs=1 input_types=3 ccs_cap_mode=0")
    live.control(guest, osd_text_mode=2)
    send(guest, FIRST[0])
    guest.run(f"v4l2-ctl -d {live.CAMERA} --set-dv-bt-timings query")
    program = live.Program(guest)
    program.wait_for_more(3)
    assert size(program.status()) == FIRST[1], program.status()["camera"]

    send(guest, SECOND[0])
    program.wait_until(lambda status: size(status) == SECOND[1], "the second format")
    live.check_sums(program.wait_for_more(3))
    check_picture(guest, "changed")

    live.unplug(guest)
    program.wait_until(live.is_without_camera, "the loss")
    live.plug(guest)
    program.wait_until(lambda status: size(status) == AFTER_RESET, "the format after a reset")
    live.check_sums(program.wait_for_more(3))
    print(program.stop())


def size(status):
    form = status["camera"].get("format", {})
    return form.get("width"), form.get("height")


def send(guest, timings):
    """The source sends these timings from now on; the driver says so to whoever listens."""
    menu = guest.run(f"v4l2-ctl -d {live.CAMERA} -L").output
    number = next(line.split(":")[0].strip() for line in menu.splitlines()
                  if line.endswith(": " + timings))
    live.control(guest, dv_timings_signal_mode=4)  # "Selected DV Timings"
    live.control(guest, dv_timings=number)


def check_picture(guest, name):
    frame = live.read_frames(guest, 2, name=name)[-1]
    assert (frame.width, frame.height) == live.SIZE, frame.form.text
    worst, text = colour_bars.farthest(frame)
    assert worst <= colour_bars.TOLERANCE, text

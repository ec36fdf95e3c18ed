"""The camera's format changes in mid-stream (an HDMI source with other timings, V4L2_EVENT_SOURCE_CHANGE),
and while it is unplugged."""
import colour_bars
import live


def run(guest):
    live.load_drivers(guest, inputs="num_inputs=1 input_types=3")  # one input: HDMI
    live.control(guest, osd_text_mode=2)
    program = live.Program(guest)
    program.wait_for_more(3)
    assert size(program) == (640, 480), program.status()["camera"]

    change_source(guest, "720x480p59")
    program.wait_until(lambda _: size(program) == (720, 480), "the other format")
    live.check_sums(program.wait_for_more(3))
    check_picture(guest, "changed")

    live.unplug(guest)
    program.wait_until(lambda status: status["camera"]["state"] != "streaming", "the loss")
    live.plug(guest)  # its timings are 640x480 again, as after any reset
    live.control(guest, osd_text_mode=2)
    program.wait_until(lambda _: size(program) == (640, 480), "the first format again")
    live.check_sums(program.wait_for_more(3))
    check_picture(guest, "replugged")
    print(program.stop())


def size(program):
    form = program.status()["camera"].get("format", {})
    return form.get("width"), form.get("height")


def change_source(guest, timings):
    """The source sends other timings from now on, and the driver says so to whoever listens."""
    menu = guest.run(f"v4l2-ctl -d {live.CAMERA} -L").output
    number = next(line.split(":")[0].strip() for line in menu.splitlines()
                  if line.endswith(": " + timings))
    live.control(guest, dv_timings=number)
    live.control(guest, dv_timings_signal_mode=4)  # "Selected DV Timings"


def check_picture(guest, name):
    frame = live.read_frames(guest, 2, name=name)[-1]
    assert (frame.width, frame.height) == live.SIZE, frame.form.text
    worst, text = colour_bars.farthest(frame)
    assert worst <= colour_bars.TOLERANCE, text

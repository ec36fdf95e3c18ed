"""vivid's colour bars through the program, unpainted, into each layout of a loopback: as another program
reads them, every bar has the colour that the pattern's definition gives it."""
import colour_bars
import live

# A loopback's layout, its fourcc, and how the camera's own frames are encoded: vivid's controls for BT.601
# in limited range, BT.709, and full range.
LAYOUTS = (("yuyv", "YUYV", {"y_cbcr_encoding": 1, "quantization": 2}),
           ("nv12", "NV12", {"y_cbcr_encoding": 2, "quantization": 2}),
           ("i420", "YU12", {"y_cbcr_encoding": 1, "quantization": 1}))


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)  # no text over the bars
    check_oracle(guest)
    for layout, fourcc, camera in LAYOUTS:
        live.control(guest, **camera)
        program = live.Program(guest, f"--set output.loopback.format={layout}")
        program.wait_for_more(2)
        frame = live.read_frames(guest, 2, name=layout)[-1]
        assert frame.form.fourcc == fourcc, frame.form.text
        assert (frame.width, frame.height) == live.SIZE, frame.form.text
        check(frame, layout)
        program.stop()


def check_oracle(guest):
    """The judge's own eyes: the driver's picture as it is. And it must see what a judge is for."""
    frame = live.read_frames(guest, 1, live.CAMERA, "camera")[-1]
    check(frame, "vivid itself")
    form = frame.form
    form.matrix = (0.2126, 0.0722)
    assert colour_bars.farthest(frame)[0] > 2 * colour_bars.TOLERANCE, "blind to a wrong matrix"
    form.matrix, form.is_full_range = (0.299, 0.114), True
    assert colour_bars.farthest(frame)[0] > colour_bars.TOLERANCE, "blind to a wrong range"


def check(frame, what):
    worst, text = colour_bars.farthest(frame)
    print(f"{what}: off by {worst:.1f} at most")
    assert worst <= colour_bars.TOLERANCE, f"{what}:\n{text}"

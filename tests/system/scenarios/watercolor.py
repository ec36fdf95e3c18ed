"""vivid → watercolor → loopback → a second process: its frames are a painting of what the camera shows,
and they change as that moves."""
import colour_bars
import live

# Pigment on paper is another colour than the bar's, but the same channels lead: how far at least they are
# before the others, how light black may be, and how dark white.
LEAD = 60
BLACK = 90
WHITE = 140


def run(guest):
    live.load_drivers(guest)
    program = live.Program(guest, "--set camera.rate=5", style="watercolor")
    program.wait_for_more(3, seconds=120)  # its shaders are compiled first
    still = live.read_frames(guest, 3, name="watercolor")
    for frame in still:
        check_painting(frame)
    live.control(guest, horizontal_movement=6)  # right, fast
    program.wait_for_more(3)
    moving = live.read_frames(guest, 5, name="watercolor_moving")
    changes = [a.difference(b) for a, b in zip(moving, moving[1:])]
    print("mean changes while it moves:", *(f"{change:.1f}" for change in changes))
    assert max(changes) > 2, f"the painting stands still: {changes}"
    status = program.status()
    live.check_sums(status)
    ledger = program.stop()
    assert ledger["shown"] >= 6, ledger


def check_painting(frame):
    assert (frame.width, frame.height) == live.SIZE, frame.form.text
    below_text = colour_bars.bars_of(frame, 0.75, 0.95)
    for (name, bar), found in zip(colour_bars.BARS, below_text):
        text = f"{name}: {tuple(round(c) for c in found)}"
        leading = [value for value, part in zip(found, bar) if part > 0]
        others = [value for value, part in zip(found, bar) if part == 0]
        if leading and others:
            assert min(leading) > max(others) + LEAD, text
        elif others:
            assert max(others) < BLACK, text
        else:
            assert min(leading) > WHITE, text

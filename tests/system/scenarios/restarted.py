"""A video call over restarts of the program: one reader stays with the loopback while the program ends, is killed, and begins
again. With the device's `sustain_framerate` and `keep_format` it sees the last picture meanwhile and the new ones
after, in one format. Without the first it waits: the control."""
import re

import live

# How long the reader waits for a picture: with sustain_framerate at most half a second on hardware.
LONGEST_WAIT_SECONDS = 0.5
PATTERNS = ("75% Colorbar", "100% Red", "100% Blue")


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)
    waited = call(guest, "alone", keeps=False)
    away = waited["away"]
    assert waited["longest"] >= min(away), f"it did not wait for the program: {waited}"
    kept = call(guest, "kept", keeps=True)
    limit = guest.patient(LONGEST_WAIT_SECONDS)
    print(f"the program was away for {', '.join(f'{each:.1f}' for each in kept['away'])} s: the reader waited for "
          f"{kept['longest']:.2f} s at most (limit {limit:.1f}), without sustain_framerate {waited['longest']:.1f} s")
    assert kept["longest"] <= limit, kept


def call(guest, name, keeps):
    """One reader over two restarts, one of them after a kill. Returns how long the program was away each time, and the longest wait
    for a picture."""
    if keeps:
        guest.run(f"v4l2-ctl -d {live.LOOPBACK} -c sustain_framerate=1 -c keep_format=1")
    show(guest, PATTERNS[0])
    program = live.Program(guest)
    program.wait_for_more(3)
    reader = guest.start(f"./picture_reader {live.LOOPBACK}", f"reader-{name}")
    reader.wait_for_output("reads", 20)
    away = []
    for how, pattern in zip((terminate, kill), PATTERNS[1:]):
        begin = live.uptime(guest)
        how(program)
        changes = reader.output().count("changed")
        show(guest, pattern)  # so that the new program's pictures are told from the old one's
        program = live.Program(guest)
        program.wait_for_more(3)
        away.append(live.uptime(guest) - begin)
        guest.wait_for(lambda: reader.output().count("changed") > changes, f"{pattern} at the reader", 20)
        assert reader.is_running(), reader.output()
    reader.signal("TERM")
    told = reader.wait(20)
    assert told.status == 0, told.output
    first = re.search(r"^reads (.*)$", told.output, re.M).group(1)
    pictures, longest, last = re.search(r"^ended (\d+) (\S+) (.*)$", told.output, re.M).groups()
    assert first == last == f"{live.SIZE[0]} {live.SIZE[1]} YUYV", told.output
    print(f"{name}: {pictures} pictures, {program.stop()}")
    return {"away": away, "longest": float(longest)}


def terminate(program):
    program.stop()


def kill(program):
    program.command.signal("KILL")
    program.command.wait(10)


def show(guest, pattern):
    menu = guest.run(f"v4l2-ctl -d {live.CAMERA} -L").output
    number = next(line.split(":")[0].strip() for line in menu.splitlines() if line.endswith(": " + pattern))
    live.control(guest, test_pattern=number)

"""Readers of a loopback that never read, and that come and go: the program goes on, and so does its other
output."""
import live

OTHER = "/dev/video51"


def run(guest):
    live.load_drivers(guest, loopbacks=2)
    program = live.Program(guest, outputs=(live.LOOPBACK, OTHER))
    program.wait_for_more(3)

    # It starts to stream and sleeps for ever.
    idle = guest.start(f"v4l2-ctl -d {live.LOOPBACK} --stream-mmap --stream-sleep=0", "idle")
    program.wait_for_more(10)
    assert idle.is_running(), idle.output()
    live.read_frames(guest, 5, OTHER, "other")
    idle.signal("KILL")

    for _ in range(5):
        guest.run(f"v4l2-ctl -d {live.LOOPBACK} --stream-mmap --stream-count=1")
    live.read_frames(guest, 3)

    status = program.status()
    live.check_sums(status)
    for output in status["outputs"]:
        assert output["state"] == "taking", output
        assert output["failures"] == 0, output
    print(program.stop())

"""A camera with faults, which vivid can inject: damaged buffers, dropped ones, a stream that breaks."""
import live

DAMAGED = 3


def run(guest):
    live.load_drivers(guest)
    program = live.Program(guest)
    program.wait_for_more(3)

    for _ in range(DAMAGED):
        live.control(guest, inject_v4l2_buf_flag_error=1)
        program.wait_for_more(1)
    status = program.wait_until(
        lambda status: status["frames"]["ended"]["corrupt"] >= DAMAGED, "corrupt frames")
    assert status["frames"]["ended"]["corrupt"] == DAMAGED, status["frames"]

    before = status["frames"]["ended"]["dropped_by_driver"]
    live.control(guest, percentage_of_dropped_buffers=50)
    live.check_sums(program.wait_for_more(5))
    live.control(guest, percentage_of_dropped_buffers=0)
    dropped = program.status()["frames"]["ended"]["dropped_by_driver"] - before
    assert dropped > 0, "the gaps in the driver's numbers are not counted"

    opens = program.status()["camera"]["opens"]
    live.control(guest, inject_fatal_streaming_error=1)
    status = program.wait_until(lambda status: status["camera"]["opens"] > opens, "another opening")
    live.check_sums(program.wait_for_more(3))
    print(program.stop())

"""The camera is unplugged and comes back, twice, in mid-stream: the program goes on by itself."""
import live

# Of the guest's real time; on hardware well below.
BACK_SECONDS = 5


def run(guest):
    live.load_drivers(guest)
    program = live.Program(guest)
    program.wait_for_more(5)
    for time in (1, 2):
        live.unplug(guest)
        status = program.wait_until(live.is_without_camera, "the loss to be seen")
        live.check_sums(status)
        shown = program.shown()
        begin = live.uptime(guest)
        live.plug(guest)
        status = program.wait_until(lambda status: live.shown_of(status) > shown, "new frames")
        took = live.uptime(guest) - begin
        print(f"plugged in: a new frame is shown after {took:.2f} s or less")
        assert took < guest.patient(BACK_SECONDS), f"{took:.1f} s"
        assert status["camera"]["state"] == "streaming", status["camera"]
        assert status["camera"]["losses"] == time, status["camera"]
        live.check_sums(program.wait_for_more(5))
    live.read_frames(guest, 2)
    print(program.stop())

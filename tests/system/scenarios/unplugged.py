"""The camera is unplugged and comes back, twice, in mid-stream: the program goes on by itself. The second
time its old node is still held by another program, so that the driver gives it another one."""
import live

# Of the guest's real time; on hardware well below.
BACK_SECONDS = 5


def run(guest):
    live.load_drivers(guest)
    program = live.Program(guest)
    program.wait_for_more(5)
    for time in (1, 2):
        if time == 2:
            node = camera_node(guest)
            holder = guest.start(f"sleep 1000 <{node}", "holder")
            guest.wait_for(lambda: has_open(guest, "holder", node), "a program that holds the node")
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
    assert camera_node(guest) != node, f"the driver gave {node} again"
    live.read_frames(guest, 2)
    print(program.stop())
    holder.signal("TERM")


def camera_node(guest):
    """The only node of the driver, whose number has one digit."""
    (node,) = guest.run("ls /dev/video[0-9]").output.split()
    return node


def has_open(guest, program, node):
    """Whether a started program has this node as its standard input."""
    return guest.run(f"readlink /proc/$(cat /host/.guest/{program}.pid)/fd/0",
                     check=False).output.strip() == node

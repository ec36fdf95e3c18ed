"""vkms, a graphics card with exact vertical blanking: frames of the synthetic camera are shown at the refresh
that they are due at, by the display's own count."""
import live

FRAMES = 250


def run(guest):
    guest.run("modprobe vkms; udevadm settle")
    program = guest.start(
        "env GALLIVM_PERF=nopt ./pleinair run --camera synthetic:still --set camera.size=320x240 "
        "--set camera.rate=25 --style none --output display "
        f"--frames {FRAMES} --set status.listen={live.STATUS}", "pleinair")
    watched = live.Watched(guest, program)
    status = watched.wait_until(lambda status: live.shown_of(status) >= FRAMES * 0.9,
                                "nearly all frames", seconds=120)
    live.check_sums(status)
    (output,) = status["outputs"]
    print(output)
    ended = output["ended"]
    shown, off = ended["shown"], ended["shown_off_schedule"]
    print(f"{shown} on their due refresh, {off} on another, of {output['submitted']}")
    if guest.accelerator == "kvm":
        assert shown >= 0.99 * (shown + off), "too many at another refresh"
    assert shown > 0, "none was shown in time"
    print(program.wait(120).output[-400:])

"""vkms, a graphics card with exact vertical blanking: frames of the synthetic camera are shown at the refresh
that they are due at, by the display's own count."""
import live

FRAMES = 40


def run(guest):
    guest.run("modprobe vkms; udevadm settle")
    program = guest.start(
        "env GALLIVM_PERF=nopt ./pleinair run --camera synthetic:still --set camera.size=160x120 "
        "--set camera.rate=10 --style none --output display --set output.display.mode=640x480 "
        f"--set runtime.latency=400 --set status.listen={live.STATUS}", "pleinair")
    watched = live.Watched(guest, program)
    status = watched.wait_until(lambda status: live.shown_of(status) >= FRAMES, f"{FRAMES} frames",
                                seconds=100)
    live.check_sums(status)
    (output,) = status["outputs"]
    assert output["failures"] == 0, output
    assert abs(output["refresh_period_s"] - 1 / 60) < 1e-3, output
    assert output["refresh_phase_s"] > 0, output  # only flips that were counted tell it
    shown, off = output["ended"]["shown"], output["ended"]["shown_off_schedule"]
    ready = status["painting"]["stages"]["until_ready"]["p95_ms"]
    latency = status["painting"]["latency_ms"]
    print(f"{shown} at their due refresh, {off} at another; painted within {ready:.0f} ms of "
          f"{latency:.0f}")
    # A machine that is too slow to paint in time says nothing of the display.
    if ready < latency - 100:
        assert shown >= 0.95 * (shown + off), "frames that were ready missed their refresh"
    print(watched.stop())

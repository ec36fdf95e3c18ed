"""Frames that a GPU reads where they lie: memory of vgem, imported by Mesa's software rasteriser as hardware would import it, equals
uploads to the bit. The program itself imports nothing into a software renderer: what vivid fills in lent memory, and what it
exports, is read in place, with the reason, and painted in the right colours."""
import colour_bars
import live

DECIDED = ("imported", "uploaded")


def run(guest):
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)  # no text over the bars
    guest.run("modprobe vgem; until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle")
    check_memory(guest)
    for layout in ("NV12", "YUYV"):
        live.set_camera(guest, layout)
        check_lent(guest, layout)
    live.set_camera(guest, "NV12")
    check_exported(guest)


def check_memory(guest):
    """Real dma-bufs, plane by plane."""
    tests = guest.run("env GALLIVM_PERF=nopt ./gpu_frames_tests --gtest_filter='*RealImports*'",
                      seconds=300, check=False)
    print("\n".join(line for line in tests.output.splitlines() if "[" in line)[-1500:])
    assert tests.status == 0, tests.output
    assert "SKIPPED" not in tests.output, tests.output


def check_lent(guest, layout):
    """vivid in memory of vgem."""
    program = live.Program(guest, "--set camera.v4l2.memory=vgem")
    status = program.wait_until(lambda status: status["painting"].get("frame_path") in DECIDED,
                                "the trial", 120)
    painting = status["painting"]
    assert status["camera"]["memory"] == "lent", status["camera"]
    assert painting["frame_path"] == "uploaded", painting
    assert "software renderer" in painting["frame_path_reason"], painting
    after = program.wait_for_more(3)["painting"]
    frame = live.read_frames(guest, 2, name="lent-" + layout)[-1]
    worst, text = colour_bars.farthest(frame)
    print(f"{layout}: {status['camera']['memory']} memory ({status['camera']['memory_note']}), "
          f"colours off by {worst:.1f}; luma: {after['luma']}")
    assert worst <= colour_bars.TOLERANCE, text
    print(program.stop())


def check_exported(guest):
    """The trap, were it imported: no error, and then a crash or other pixels."""
    program = live.Program(guest)
    status = program.wait_until(lambda status: status["painting"].get("frame_path") in DECIDED,
                                "the trial", 120)
    assert status["camera"]["memory"] == "exported", status["camera"]
    print("vivid's own memory:", status["painting"]["frame_path"], "-",
          status["painting"]["frame_path_reason"])
    program.wait_for_more(2)
    frame = live.read_frames(guest, 2, name="exported")[-1]
    worst, text = colour_bars.farthest(frame)
    assert worst <= colour_bars.TOLERANCE, text
    print(program.stop())

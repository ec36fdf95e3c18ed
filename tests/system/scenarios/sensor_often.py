"""A sensor behind a pipeline, vimc through libcamera, started and stopped a hundred times, and 300 frames of the last start:
descriptors, threads and processes are as many as after the first stop, and memory does not go on growing."""
import os

STARTS = int(os.environ.get("PLEINAIR_STARTS", 100))
FRAMES = 300
GROWTH_KB = 1000  # of resident memory, from half of the starts to all of them


def run(guest):
    guest.run("modprobe vimc; udevadm settle; cp camera_starts pleinair-libcamera /tmp")
    program = guest.start(f"/tmp/camera_starts libcamera {STARTS} {FRAMES}", "starts")
    finished = program.wait(60 + 10 * STARTS + FRAMES)
    assert finished.status == 0, finished.output
    rows = [[int(each) for each in line.split()] for line in finished.output.splitlines()
            if line[:1].isdigit()]
    for starts, descriptors, threads, resident, processes in rows:
        print(f"after {starts}: {descriptors} descriptors, {threads} threads, {resident} kB resident, "
              f"{processes} processes")
    assert rows[-1][0] == STARTS, finished.output
    first, half, last = rows[0], rows[len(rows) // 2], rows[-1]
    for name, at in (("descriptors", 1), ("threads", 2), ("processes", 4)):
        assert last[at] == first[at], f"{name}: {first[at]} after the first start, {last[at]} after the last"
    assert last[3] - half[3] < GROWTH_KB, "memory goes on growing"
    print(f"{FRAMES} frames came after the last start")

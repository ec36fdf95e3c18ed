"""A monitor that is switched off and on a hundred times: buffers, descriptors and threads are as many as before, and memory does
not go on growing."""
import json
import os

import live

DEVICES = ("virtio-gpu-pci,id=card,max_outputs=1",)
TIMES = int(os.environ.get("PLEINAIR_UNPLUGS", 100))
SAMPLES = 4
# Of resident memory, in kB, from half of the times to all of them: the play of the allocators, of ours and the driver's.
GROWTH_KB = 6000

# Runs in the guest, so that a look at the program's state costs no round trip.
UNPLUG = """
status() { exec 3<>/dev/tcp/127.0.0.1/9117; printf 'GET /status HTTP/1.0\\r\\n\\r\\n' >&3; tr -d ' \\n' <&3; exec 3>&-; }
display() { status | grep -o '"pacing":"[a-z]*","state":"[a-z_]*"' | grep -o '[a-z_]*"$'; }
await() { # a state, or any other but it
  for _ in $(seq 1200); do
    case $1 in
      taking) [ "$(display)" = 'taking"' ] && return 0 ;;
      gone) [ "$(display)" != 'taking"' ] && return 0 ;;
    esac
    sleep 0.05
  done
  return 1
}
monitor() {
  echo off >/sys/class/drm/card0-Virtual-1/status
  await gone || return 1
  echo on >/sys/class/drm/card0-Virtual-1/status; echo detect >/sys/class/drm/card0-Virtual-1/status
  await taking
}
for _ in $(seq $1); do monitor || { echo "stuck: $(display)"; exit 1; }; done
"""


def run(guest):
    live.load_drivers(guest)
    guest.run("until [ -e /dev/dri/card0 ]; do sleep 0.1; done; udevadm settle; cp pleinair /tmp; mount -t debugfs none /sys/kernel/debug",
              seconds=60)
    program = guest.start(
        f"env GALLIVM_PERF=nopt /tmp/pleinair run --camera v4l2:{live.CAMERA} --style none --size 160x90 --output display "
        f"--set output.display.mode=640x480 --set output.display.scan_out=copied --set output.keep_last_painting=false "
        f"--set status.listen={live.STATUS}", "pleinair")
    watched = live.Watched(guest, program)
    watched.wait_for_more(5)
    with open(os.path.join(guest.folder, "unplug.sh"), "w") as file:
        file.write(UNPLUG)
    check(guest, watched)
    print(watched.stop(10))


def check(guest, watched):
    unplug(guest, watched, 1)  # what is allocated once
    samples = [sample(guest, watched)]
    print("after 1:", text(samples[0]))
    for i in range(1, SAMPLES + 1):
        unplug(guest, watched, TIMES // SAMPLES)
        samples.append(sample(guest, watched))
        print(f"after {i * TIMES // SAMPLES} more:", text(samples[-1]), flush=True)
    first, half, last = samples[0], samples[SAMPLES // 2], samples[-1]
    for name in ("descriptors", "threads", "framebuffers"):
        assert last[name] == first[name], f"{name}: {first[name]} before, {last[name]} after"
    growth = last["resident"] - half["resident"]
    print(f"{first['resident'] // 1024} MiB resident, {growth:+} kB in the second half")
    assert growth < GROWTH_KB, "memory goes on growing"


def unplug(guest, watched, times):
    shown = watched.shown()
    done = guest.run(f"bash /host/unplug.sh {times}", seconds=20 * times + 60, check=False)
    assert done.status == 0, done.output + watched.command.output()[-2000:]
    watched.wait_until(lambda status: live.shown_of(status) > shown + 2, "the picture", 60)


def sample(guest, watched):
    """Counts of the program's; memory in kB, by its kind."""
    listing = guest.run(
        "pid=$(pidof pleinair); ls /proc/$pid/fd | wc -l; ls /proc/$pid/task | wc -l; "
        "cat /sys/kernel/debug/dri/*/framebuffer 2>/dev/null | grep -c '^framebuffer'; cat /proc/$pid/smaps", seconds=60).output
    lines = listing.split("\n")
    counts = {"descriptors": int(lines[0]), "threads": int(lines[1]), "framebuffers": int(lines[2])}
    kinds, kind = {"heap": 0, "anonymous": 0, "files": 0}, None
    for line in lines[3:]:
        words = line.split()
        if len(words) >= 5 and "-" in words[0] and not words[0].endswith(":"):
            name = words[5] if len(words) > 5 else ""
            kind = "heap" if name == "[heap]" else "files" if name.startswith("/") else "anonymous"
        elif words and words[0] == "Rss:":
            kinds[kind] += int(words[1])
    return counts | kinds | {"resident": sum(kinds.values())}


def text(counts):
    return json.dumps(counts).replace('"', "")

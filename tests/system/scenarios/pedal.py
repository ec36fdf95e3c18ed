"""A pedal's press to the changed step, from the kernel's event, which a second reader of the device sees too: to the first page of
/status that tells the next step, and to the first picture at a reader of the loopback that shows another
instruction."""
import os
import re
import statistics

import live
import patience

DEVICES = ("virtio-keyboard-pci",)  # to the kernel a pedal is a keyboard with few keys
STEPS = 23
TOLD = 11  # of these are asked for in /status, the rest are looked for in the picture
CHANGED_SECONDS = 0.1  # on hardware; in the picture beside the latency in force

# Runs in the guest: waits for an event of the device, then asks for the status until the step's number is the wanted one.
WATCH = """
exec 4<$2
dd bs=24 count=1 <&4 >/dev/null 2>&1; pressed=$EPOCHREALTIME
echo "an event" >&2
for _ in $(seq 300); do
  exec 3<>/dev/tcp/127.0.0.1/9117; printf 'GET /status HTTP/1.0\\r\\n\\r\\n' >&3
  page=$(cat <&3); exec 3>&-
  [[ $page =~ '"procedure_step_number"':[[:space:]]*'"'?([0-9]+) ]] && number=${BASH_REMATCH[1]}
  [ "$number" = "$1" ] && { echo $pressed $EPOCHREALTIME; exit 0; }
done
echo "the step is still $number"; exit 1
"""


def run(guest):
    slowness = patience.measure(guest)
    live.load_drivers(guest)
    live.control(guest, osd_text_mode=2)  # or the picture changes by itself
    node = guest.run("until grep -q 'Virtio Keyboard' /sys/class/input/event*/device/name; do sleep 0.1; done; udevadm settle; "
                     "grep -l 'Virtio Keyboard' /sys/class/input/event*/device/name | cut -d/ -f5 | head -n1").output.strip()
    pedal = f"/dev/input/{node}"
    write(guest, "work/procedure.toml", 'name = "work"\nversion = "1"\nlanguages = ["en"]\n[model]\nsource = "builtin:gearbox"\n'
          + "".join(f'[[step]]\nid = "s{i}"\nparts = ["housing"]\n' for i in range(STEPS)))
    write(guest, "work/en.md", "# Work\n" + "".join(f"## s{i}: Step {i}\nDo it.\n" for i in range(STEPS)))
    write(guest, "inputs.toml", f'[[device]]\ndevice = "{pedal}"\nlabel = "pedal"\ngrab = false\n'
          '[device.buttons]\nKEY_F7 = "next"\n')
    write(guest, "watch.sh", WATCH)
    program = live.Program(guest, "--set procedure.folder=/host/work --set procedure.records=none "
                           "--set input.map=/host/inputs.toml")
    first = int(program.wait_for_more(3)["procedure_step_number"])
    seconds = [press_to_status(guest, step, pedal) for step in range(first + 1, first + 1 + TOLD)]
    report("told", seconds, CHANGED_SECONDS, slowness)
    assert statistics.median(seconds) <= CHANGED_SECONDS * slowness, seconds

    seconds = presses_to_pictures(guest, program, pedal, STEPS - 1 - TOLD)
    report("seen", seconds, CHANGED_SECONDS, slowness)
    assert statistics.median(seconds) <= CHANGED_SECONDS * slowness, seconds
    print(program.stop())


def press_to_status(guest, step, pedal):
    watch = guest.start(f"bash /host/watch.sh {step} {pedal}", f"watch-{step}")
    guest.run("sleep 0.5")  # it reads by then, and no answer is taken for one that bounces
    press(guest, "f7")
    told = watch.wait(60)
    assert told.status == 0, told.output
    pressed, changed = (float(each) for each in told.output.split()[-2:])
    return changed - pressed


def presses_to_pictures(guest, program, pedal, count):
    """Seconds from each press to the picture, less the latency in force. A key that is in no map is the control: nothing changes."""
    reader = guest.start(f"./picture_reader {live.LOOPBACK} {pedal}", "reader")
    reader.wait_for_output("reads")
    come_to_rest(guest)
    seconds = []
    for key in ["f8"] + ["f7"] * count:
        before = len(reader.output())
        latency = program.status()["painting"]["latency_ms"] / 1000
        press(guest, key)
        come_to_rest(guest)
        lines = reader.output()[before:]
        pressed = float(re.search(r"^pressed (\S+)", lines, re.M).group(1))
        changes = [float(each) for each in re.findall(r"^changed (\S+)", lines, re.M)]
        if key == "f8":
            assert not changes, f"the picture changes by itself:\n{lines}"
        else:
            assert changes, f"the picture does not change:\n{lines}"
            seconds.append(changes[0] - pressed - latency)
    reader.signal("TERM")
    assert reader.wait(20).status == 0
    return seconds


def come_to_rest(guest):
    guest.run(f"sleep {guest.patient(0.5):.1f}", seconds=60)


def press(guest, key):
    guest.qemu("send-key", keys=[{"type": "qcode", "data": key}])


def report(what, seconds, limit, slowness):
    print(f"{len(seconds)} steps, each {what} after {1000 * statistics.median(seconds):.0f} ms (median), "
          f"{1000 * min(seconds):.0f} to {1000 * max(seconds):.0f} ms; "
          f"{1000 * statistics.median(seconds) / slowness:.0f} ms x patience, limit {1000 * limit:.0f}")


def write(guest, name, text):
    path = os.path.join(guest.folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)

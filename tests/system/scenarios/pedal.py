"""A pedal's press to the changed step in /status: from the kernel's event, which a second reader of the device sees too, to the
first page that tells the next step."""
import os
import statistics

import live
import patience

DEVICES = ("virtio-keyboard-pci",)  # to the kernel a pedal is a keyboard with few keys
STEPS = 12
CHANGED_SECONDS = 0.1  # on hardware

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
    seconds = []
    for step in range(first + 1, first + STEPS):
        watch = guest.start(f"bash /host/watch.sh {step} {pedal}", f"watch-{step}")
        guest.run("sleep 0.5")  # it reads by then, and no answer is taken for one that bounces
        guest.qemu("send-key", keys=[{"type": "qcode", "data": "f7"}])
        told = watch.wait(60)
        assert told.status == 0, told.output
        pressed, changed = (float(each) for each in told.output.split()[-2:])
        seconds.append(changed - pressed)
    print(f"{len(seconds)} steps, each told after {1000 * statistics.median(seconds):.0f} ms (median), "
          f"{1000 * max(seconds):.0f} ms (most); {1000 * statistics.median(seconds) / slowness:.0f} ms x patience")
    assert statistics.median(seconds) <= CHANGED_SECONDS * slowness, seconds
    print(program.stop())


def write(guest, name, text):
    path = os.path.join(guest.folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(text)

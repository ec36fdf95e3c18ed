#!/usr/bin/env python3
"""Called by CTest: prepares a guest, or runs one scenario in it.

usage: system_test.py FOLDER prepare PROGRAM ...     builds the guest's image, tests it
       system_test.py FOLDER SCENARIO                one of scenarios/

FOLDER, in the build tree, holds the results of `prepare` and all files of each scenario.
Exit status: 0; 1 with the failure and the guest's logs; 77, a skip, if no guest can run here.
"""
import importlib
import json
import os
import shutil
import subprocess
import sys
import traceback

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, name) for name in ("guest", "judges", "")]
sys.dont_write_bytecode = True

import guest as machine  # noqa: E402
import image as images  # noqa: E402

SKIPPED = 77


def prepare(folder, programs):
    """Writes guest.json: the image and the accelerator, or the reason why there is none; and the programs."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(os.path.join(folder, "programs"))
    for program in programs:  # without debug information they load faster in the guest
        stripped = os.path.join(folder, "programs", os.path.basename(program))
        subprocess.run(["strip", "-o", stripped, program], check=True)
    try:
        image = images.ready_image(programs, os.path.join(folder, "build.log"))
        accelerator = machine.usable_accelerator(image, os.path.join(folder, "trial"))
        state = {"image": image, "accelerator": accelerator}
        print(f"{image}, run with {accelerator}")
    except images.Unavailable as reason:
        state = {"unavailable": str(reason)}
    with open(os.path.join(folder, "guest.json"), "w") as file:
        json.dump(state, file)
    return skip(state)


def skip(state):
    if "unavailable" not in state:
        return 0
    print("skipped: there is no guest:", state["unavailable"])
    return SKIPPED


def run_scenario(folder, name):
    with open(os.path.join(folder, "guest.json")) as file:
        state = json.load(file)
    if "unavailable" in state:
        return skip(state)
    scenario = importlib.import_module("scenarios." + name)
    shared = os.path.join(folder, name)
    shutil.rmtree(shared, ignore_errors=True)
    shutil.copytree(os.path.join(folder, "programs"), shared)
    guest = machine.Guest(state["image"], shared, state["accelerator"],
                          devices=getattr(scenario, "DEVICES", ()))
    try:
        with guest:
            try:
                scenario.run(guest)
            except (AssertionError, machine.GuestError):
                show_logs(guest)
                raise
    except machine.TooBusy as reason:
        print("skipped:", reason)
        return SKIPPED
    except (AssertionError, machine.GuestError):
        traceback.print_exc(file=sys.stdout)
        print("all it left:", shared)
        return 1
    return 0


def show_logs(guest):
    """The last lines of the kernel's log and of the output of each started command."""
    try:
        guest.run("dmesg >/host/dmesg.log", seconds=5)
    except machine.GuestError as error:
        print("dmesg:", error)
    logs = [os.path.join(guest.folder, "dmesg.log"), guest.serial_log]
    hidden = os.path.join(guest.folder, ".guest")
    logs += sorted(os.path.join(hidden, name) for name in os.listdir(hidden)
                   if name.endswith(".out") and not name[:-4].isdigit())
    for log in logs:
        if os.path.exists(log) and os.path.getsize(log) > 0:
            with open(log, errors="replace") as file:
                print(f"---- {os.path.basename(log)}", *file.read().splitlines()[-25:], sep="\n")


def main():
    folder, what, *programs = sys.argv[1:]
    if what == "prepare":
        return prepare(folder, programs)
    return run_scenario(folder, what)


if __name__ == "__main__":
    sys.exit(main())

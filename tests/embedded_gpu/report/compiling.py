"""Compiles recorded programs with a driver, in several processes that each own a part of the programs."""
import concurrent.futures
import dataclasses
import json
import os
import signal
import subprocess

import drivers
import programs
import shader_statistics


@dataclasses.dataclass
class Compiled:
    """What one driver made of one program, over all of its states."""
    stages: dict  # by stage: Statistics
    milliseconds: float  # processor time
    problem: str  # empty: none


def context_limits(replay, tree, place, gpu):
    """What the driver offers: the first line of a replay of nothing."""
    done = subprocess.run([str(replay), str(tree), "60"], input="", capture_output=True, text=True, check=False,
                          env=drivers.environment(place, gpu))
    if done.returncode != 0:
        raise RuntimeError(f"{gpu}: no context over the shim: {done.stderr[-2000:]}")
    return json.loads(done.stdout.splitlines()[0])


def compile_program(replay, tree, place, gpu, records, patience):
    """Compiled, of the records of one program."""
    lines = "".join(json.dumps(record) + "\n" for record in records)
    done = subprocess.run([str(replay), str(tree), str(patience)], input=lines, capture_output=True, text=True,
                          check=False, env=drivers.environment(place, gpu))
    answers = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    ends = [answer for answer in answers if "ends" in answer]
    problem = next((answer["problem"] for answer in ends if answer["problem"]), "")
    if done.returncode == -signal.SIGALRM:
        problem = f"still compiling after {patience} s"
    elif done.returncode != 0 and not problem:
        problem = f"the driver died ({done.returncode}): {done.stderr.strip()[-300:]}"
    messages = [message for answer in ends for message in answer["messages"]]
    stages = shader_statistics.worst_by_stage(messages)
    if records[0]["program"].split()[0].endswith(".comp"):  # a driver's own draws are none of the program's
        stages = {stage: one for stage, one in stages.items() if stage == "compute"}
    return Compiled(stages, sum(answer["cpu_ms"] for answer in ends), problem)


def compile_all(replay, tree, place, gpu, records, patience=600, tell=None):
    """{name: Compiled} of all programs; `tell` is called with each name that is done."""
    groups = programs.by_name(records)
    results = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        waiting = {pool.submit(compile_program, replay, tree, place, gpu, group, patience): name
                   for name, group in groups.items()}
        for future in concurrent.futures.as_completed(waiting):
            results[waiting[future]] = future.result()
            if tell:
                tell(waiting[future])
    return dict(sorted(results.items()))

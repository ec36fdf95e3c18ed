"""Prints what compilers came to."""
import drivers
import tables

SHOWN = 20  # programs, where not all are asked for


def _change(now, was, name):
    """"512 (+12)", or the number alone where it is the kept one or there is none."""
    value = getattr(now, name)
    if value is None:
        return "-"
    before = getattr(was, name) if was else None
    shown = f"{value:.0f}" if isinstance(value, float) else str(value)
    return shown if before is None or before == value else f"{shown} ({value - before:+.0f})"


def _spills(now, was):
    shown = f"{now.spills}:{now.fills}"
    return shown if not was or (was.spills, was.fills) == (now.spills, now.fills) else \
        f"{shown} (was {was.spills}:{was.fills})"


def print_table(gpu, compiled, kept, everything):
    """The largest programs, or all, and sums over all."""
    few = drivers.GPUS[gpu].full_threads
    rows = sorted(((stage, one, name, result) for name, result in compiled.items() for stage, one in result.stages.items()),
                  key=lambda row: -row[1].instructions)
    print(f"\n## {gpu}: {drivers.GPUS[gpu].title}\n")
    print("| program | stage | instructions | threads | registers | spills:fills | cycles | CPU ms |\n|---|---|---|---|---|---|---|---|")
    for stage, one, name, result in rows if everything else rows[:SHOWN]:
        row = kept.get(name, {}).get(stage)
        was = row.statistics if row else None
        cells = [_change(one, was, "instructions"), _change(one, was, "threads"), _change(one, was, "registers"),
                 _spills(one, was), _change(one, was, "cycles"), f"{result.milliseconds:.0f}"]
        print(f"| {name} | {stage} | " + " | ".join(cells) + " |")
    spilling = [f"{name} ({stage} {one.spills}:{one.fills})" for stage, one, name, _ in rows if one.spills + one.fills]
    short = [f"{name} ({stage}, {one.registers} registers)" for stage, one, name, _ in rows
             if few and one.threads is not None and one.threads < few]
    print(f"\n{len(compiled)} programs, {sum(r.milliseconds for r in compiled.values()) / 1000:.1f} s of processor time")
    print(f"spilling: {len(spilling)}{': ' if spilling else ''}{', '.join(spilling)}")
    if few:
        print(f"with fewer than {few} threads: {len(short)}{': ' if short else ''}{', '.join(short)}")
    for name, result in compiled.items():
        if result.problem:
            print(f"FAILED: {name}: {result.problem}")
        elif name in kept:
            for line in tables.regressions(kept[name], result):
                print(f"WORSE: {name}: {line}")


def print_limits(limits):
    """One column for each GPU."""
    print("| | " + " | ".join(limits) + " |\n|---" + "|---" * len(limits) + "|")
    for key in ("renderer", "version"):
        print(f"| {key} | " + " | ".join(str(one[key]) for one in limits.values()) + " |")
    first = next(iter(limits.values()))
    for name in first["limits"]:
        print(f"| {name} | " + " | ".join(str(one["limits"][name]) for one in limits.values()) + " |")
    for name in sorted({name for one in limits.values() for name in one["extensions"]}):
        print(f"| {name} | " + " | ".join("yes" if name in one["extensions"] else "no" for one in limits.values()) + " |")

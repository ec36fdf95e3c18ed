#!/usr/bin/env python3
"""Compiles the product's shader programs for GPUs that are not in this machine: README.md.

usage: gpu_report.py BUILD report [--gpu NAME ...] [--only TEXT] [--all] [--renew]
       gpu_report.py BUILD record          records programs and states anew, into programs.jsonl
       gpu_report.py BUILD limits [--gpu NAME ...]
       gpu_report.py BUILD check           the test of ./dev test long: everything, recorded anew
       gpu_report.py BUILD check-changed   the test of ./dev test: programs whose text changed
       gpu_report.py BUILD cost [--size WxH ...]  what a frame's passes move and compute, on paper
       gpu_report.py BUILD build           builds the drivers only

BUILD is the build folder (build/dev). Exit status: 0; 1 where a program got worse; 77, a skip, with the reason.
"""
import argparse
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "report"))
sys.dont_write_bytecode = True

import compiling  # noqa: E402
import cost  # noqa: E402
import drivers  # noqa: E402
import printing  # noqa: E402
import programs  # noqa: E402
import recording  # noqa: E402
import tables  # noqa: E402

SKIPPED = 77
TREE = HERE.parent.parent
CHANGED_SECONDS = 100  # of which ./dev test spends at most so much on compiling


class Report:
    """One run: where the programs are, and what was asked for."""

    def __init__(self, options):
        self.options = options
        self.build = options.build.resolve()
        self.replay = self.build / "tests/embedded_gpu/program_replay"
        self.gpus = options.gpu or list(drivers.GPUS)

    def drivers(self):
        return drivers.build(self.build / "embedded-gpu-drivers.log")

    def kept_gpus(self):
        """Those that a table is kept of."""
        return [gpu for gpu in self.gpus if tables.path_of(gpu).exists()]

    def compile(self, gpu, records, patience=600):
        def tell(name):
            print(f"  {gpu}: {name}", file=sys.stderr, flush=True)
        return compiling.compile_all(self.replay, TREE, self.place, gpu, records, patience, tell)

    def report(self):
        """Prints the table of each GPU beside the kept one; --renew keeps the new one."""
        self.place = self.drivers()
        records = [r for r in programs.read() if self.options.only in programs.name(r)]
        digests = programs.digests(self.replay, TREE, records)
        for gpu in self.gpus:
            kept = tables.read(gpu)
            compiled = self.compile(gpu, records)
            printing.print_table(gpu, compiled, kept, self.options.all)
            if self.options.renew:
                rows = {name: {stage: tables.Row(digests[name], one) for stage, one in result.stages.items()}
                        for name, result in compiled.items() if not result.problem}
                whole = {} if not self.options.only else kept
                tables.write(gpu, whole | rows)
        return 0

    def limits(self):
        self.place = self.drivers()
        printing.print_limits({gpu: compiling.context_limits(self.replay, TREE, self.place, gpu) for gpu in self.gpus})
        return 0

    def cost(self):
        cost.print_costs(self.build, self.options.size)
        return 0

    def record(self):
        records = recording.record(self.build)
        programs.write(records)
        print(f"{len(records)} states of {len(programs.by_name(records))} programs in {programs.KEPT}")
        return 0

    def check(self):
        """Fails where the recording has what programs.jsonl has not, and where a program got worse."""
        self.place = self.drivers()
        complaints = recording.missing(programs.read(), recording.record(self.build))
        for gpu in self.kept_gpus():
            complaints += self._regressions(gpu, programs.read())
        return self._answer(complaints)

    def check_changed(self):
        """Compiles the programs whose text is not the kept tables' one, as far as the time allows."""
        self.place = drivers.built()
        records = programs.read()
        digests = programs.digests(self.replay, TREE, records)
        began = time.monotonic()
        complaints = []
        for gpu in self.kept_gpus():
            kept = tables.read(gpu)
            changed = [r for r in records if programs.name(r) in kept
                       if next(iter(kept[programs.name(r)].values())).source != digests[programs.name(r)]]
            left = CHANGED_SECONDS - (time.monotonic() - began)
            print(f"{gpu}: {len(programs.by_name(changed))} programs changed")
            if left <= 0:
                print(f"{gpu}: not compiled, the {CHANGED_SECONDS} s are over; ./dev gpu-report {gpu} does it")
            else:
                complaints += self._regressions(gpu, changed, patience=max(1, int(left)))
        return self._answer(complaints)

    def _regressions(self, gpu, records, patience=600):
        kept = tables.read(gpu)
        complaints = []
        for name, compiled in self.compile(gpu, records, patience).items():
            if name not in kept:
                print(f"{gpu}: {name}: has no row in the table yet; ./dev gpu-report {gpu} --renew")
                continue
            complaints += [f"{gpu}: {name}: {line}" for line in tables.regressions(kept[name], compiled)]
        return complaints

    @staticmethod
    def _answer(complaints):
        for line in complaints:
            print(line)
        if complaints:
            print("fix the shader, or renew the tables (./dev gpu-report --renew) and say why in the commit")
        return 1 if complaints else 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("what", choices=["report", "record", "limits", "check", "check-changed", "cost", "build"])
    parser.add_argument("--size", nargs="*", default=["640x480", "1280x720"], help="of frames, for cost")
    parser.add_argument("--gpu", nargs="*", choices=list(drivers.GPUS))
    parser.add_argument("--only", default="", help="programs whose names have this")
    parser.add_argument("--all", action="store_true", help="print all programs, not the largest")
    parser.add_argument("--renew", action="store_true", help="keep the new tables")
    options = parser.parse_args()
    report = Report(options)
    try:
        if options.what == "build":
            print(report.drivers())
            return 0
        return getattr(report, options.what.replace("-", "_"))()
    except drivers.Unavailable as reason:
        print(f"skipped: {reason}")
        return SKIPPED


if __name__ == "__main__":
    sys.exit(main())

"""The kept tables, tables/GPU.tsv: what each program came to when the table was last renewed."""
import dataclasses
import pathlib

from shader_statistics import Statistics

FOLDER = pathlib.Path(__file__).resolve().parent.parent / "tables"
COLUMNS = ["program", "source", *(field.name for field in dataclasses.fields(Statistics))]
GROWTH = 1.10  # instructions that a program may grow by
SLACK = 16  # instructions that a small program may grow by


@dataclasses.dataclass(frozen=True)
class Row:
    """A shader of a program in a kept table, by the digest of what was compiled."""
    source: str
    statistics: Statistics


def path_of(gpu):
    return FOLDER / f"{gpu}.tsv"


def read(gpu):
    """{program: {stage: Row}}; empty where there is no table."""
    table = {}
    if not path_of(gpu).exists():
        return table
    lines = path_of(gpu).read_text(encoding="utf-8").splitlines()
    for line in lines[1:]:
        program, source, stage, *counts = line.split("\t")
        values = [None if text == "-" else float(text) if "." in text else int(text) for text in counts]
        table.setdefault(program, {})[stage] = Row(source, Statistics(stage, *values))
    return table


def write(gpu, table):
    """Keeps a table in the shape that read() gives."""
    def text(value):
        return "-" if value is None else f"{value:.1f}" if isinstance(value, float) else str(value)
    lines = ["\t".join(COLUMNS)]
    for program, stages in sorted(table.items()):
        for row in sorted(stages.values(), key=lambda row: row.statistics.stage):
            lines.append("\t".join([program, row.source, *map(text, dataclasses.astuple(row.statistics))]))
    path_of(gpu).parent.mkdir(exist_ok=True)
    path_of(gpu).write_text("\n".join(lines) + "\n", encoding="utf-8")


def regressions(kept, compiled):
    """Lines that say where a compiled program is worse than its kept rows ({stage: Row}) allow."""
    if compiled.problem:
        return [compiled.problem]
    lines = []
    for stage, now in compiled.stages.items():
        if stage not in kept:
            lines.append(f"{stage}: not in the table")
            continue
        was = kept[stage].statistics
        if now.spills + now.fills > was.spills + was.fills:
            lines.append(f"{stage}: spills {now.spills}:{now.fills}, before {was.spills}:{was.fills}")
        if now.threads is not None and was.threads is not None and now.threads < was.threads:
            lines.append(f"{stage}: {now.threads} threads, before {was.threads}")
        if now.instructions > max(was.instructions * GROWTH, was.instructions + SLACK):
            lines.append(f"{stage}: {now.instructions} instructions, before {was.instructions}")
    return lines

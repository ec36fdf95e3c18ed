"""What a frame's passes move and compute, on paper: README.md, "Costs"."""
import collections
import dataclasses
import math
import pathlib
import tempfile

import programs
import recording
import tables

SHORT, LONG = 4, 8  # frames of the two runs, whose difference is that of ordinary frames
LOOKS = {"watercolor": "line_and_wash", "painterly": "oil", "hatching": "pen"}


@dataclasses.dataclass(frozen=True)
class Board:
    """A GPU's rates, as its makers or drivers tell them; lanes or cycles, by what its compiler counts."""
    title: str
    table: str
    lanes: float | None  # of all cores: lanes of an instruction in a second
    cycles: float | None  # of all cores in a second
    memory: tuple[float, float]  # bytes a second: what a GPU gets of it at least and at most

# V3D: a QPU does an instruction for 16 lanes in 4 cycles. Two slices of four QPUs at 500 MHz; three at 800 MHz.
# Mali-G52 MP2 at 800 MHz. Memory: between a third and two thirds of LPDDR4's 12.8 GB/s, LPDDR4X's 17.1, 12.8.
BOARDS = [Board("Pi 4", "v3d42", 8 * 4 * 500e6, None, (3e9, 6e9)),
          Board("Pi 5", "v3d71", 12 * 4 * 800e6, None, (5e9, 11e9)),
          Board("Mali-G52", "g52", None, 2 * 800e6, (4e9, 8e9))]
# A loop counts once in a compiler's counts: it runs once at best, and on the average of this tree's loops (rings of
# points, cells of a block, taps) not more often than this.
LOOP_ROUNDS = 4
# Of the target, what the triangles of a program's draws other than whole passes cover together in a frame: from a
# little to twice over.
COVERED = (0.1, 2.0)
# Texels of each texture that an invocation of a dispatch along a list (of anchors, strokes, points) reads at most.
LIST_TEXELS = 64


@dataclasses.dataclass
class Pass:
    """A program's work in a frame."""
    runs: float = 0.0
    invocations: dict = dataclasses.field(default_factory=lambda: collections.defaultdict(lambda: [0.0, 0.0]))  # by stage
    read: list = dataclasses.field(default_factory=lambda: [0.0, 0.0])  # bytes: the least, the most
    written: list = dataclasses.field(default_factory=lambda: [0.0, 0.0])


def _bytes(size):
    width, height, texel = size
    return width * height * texel


def _add(pair, least, most):
    pair[0] += least
    pair[1] += most


def _is_whole_pass(record):
    return record["program"].startswith("pipeline/gpu/shaders/fullscreen.vert")


def _invocations(work):
    return math.prod(work["groups"]) * math.prod(work["group_size"])


def _is_along_a_list(work):
    return "listed" in work or work["groups"][1] * work["group_size"][1] == 1


def _texels_read(record, texels):
    """Of a texture, at least and at most: each texel at least once; where neighbours share reads by the cache alone,
    some twice. Dispatches along a list read what is around its members."""
    work = record["work"]
    if "groups" in work and _is_along_a_list(work):
        count = _invocations(work)
        return min(texels, count), min(2 * texels, LIST_TEXELS * count)
    return texels, 2 * texels


def _add_draw(one, record, share, draws):
    """`draws`: of the program in a frame."""
    work = record["work"]
    width, height = work["viewport"]
    covered = (1.0, 1.0) if _is_whole_pass(record) else tuple(part / max(1.0, draws) for part in COVERED)
    pixels = width * height
    _add(one.invocations["fragment"], share * pixels * covered[0], share * pixels * covered[1])
    vertices = work["vertices"] * work["instances"]
    _add(one.invocations["vertex"], share * vertices, share * vertices)
    written = sum(size[2] for size in work["targets"]) * pixels + work["depth"][2] * pixels
    reads_target = "blend" in record["state"] or "depth_test" in record["state"]
    _add(one.written, share * written * covered[0], share * written * covered[1])
    if reads_target:
        _add(one.read, share * written * covered[0], share * written * covered[1])


def _add_dispatch(one, record, share):
    work = record["work"]
    invocations = _invocations(work)
    _add(one.invocations["compute"], share * invocations, share * invocations)
    for name, size in work["images"].items():
        access = record["state"]["images"][name][1]
        moved = _bytes(size)
        if "listed" in work:
            moved = min(moved, invocations * size[2])
        if access != 0x88B9:  # GL_WRITE_ONLY
            _add(one.read, share * moved, share * moved)
        if access != 0x88B8:  # GL_READ_ONLY
            _add(one.written, share * moved, share * moved)


def passes_of(short, long, frames):
    """{name: Pass} of a frame: the difference of the records of two runs, divided by the frames that it is of."""
    runs = collections.Counter()
    examples = {}
    for sign, records in ((-1, short), (1, long)):
        for record in records:
            key = programs.identity(record) + str(sorted(record["work"].items(), key=str))
            runs[key] += sign * record["count"]
            examples[key] = record
    passes = collections.defaultdict(Pass)
    draws = collections.Counter()
    for key, count in runs.items():
        draws[programs.name(examples[key])] += max(0, count) / frames
    for key, count in runs.items():
        if count <= 0:
            continue
        record, share = examples[key], count / frames
        name = programs.name(record)
        one = passes[name]
        one.runs += share
        for width, height, texel in record["work"]["textures"].values():
            least, most = _texels_read(record, width * height)
            _add(one.read, share * texel * least, share * texel * most)
        if "groups" in record["work"]:
            _add_dispatch(one, record, share)
        else:
            _add_draw(one, record, share, draws[name])
    return dict(passes)


def seconds_on(board, one, stages):
    """The least and the most time of a pass on a board, by the counts of its table: computing or moving bytes,
    whichever takes longer at best; both one after the other at worst."""
    compute = [0.0, 0.0]
    for stage, (least, most) in one.invocations.items():
        if stage not in stages:
            continue
        statistics = stages[stage].statistics
        rounds = LOOP_ROUNDS if statistics.loops else 1
        if board.lanes:
            # 16 lanes at a time; a spilled register costs about as much as ten instructions.
            each = statistics.instructions + 10 * (statistics.spills + statistics.fills)
            _add(compute, least * each / board.lanes, most * rounds * each / board.lanes)
        elif statistics.cycles is not None:
            _add(compute, least * statistics.cycles / board.cycles, most * rounds * statistics.cycles / board.cycles)
    moved = [(one.read[0] + one.written[0]) / board.memory[1], (one.read[1] + one.written[1]) / board.memory[0]]
    return max(compute[0], moved[0]), compute[1] + moved[1]


def film_of(build, size, folder):
    """Records the workbench; the arguments that paint it with its models."""
    film, scene = folder / f"{size}.mp4", folder / f"{size}.toml"
    recording.call(build, ["record", "--camera", "synthetic", "--frames", str(LONG), "--size", size,
                           "--output", str(film), "--write-scene", str(scene)])
    return [str(film), "--scene", str(scene)]


def frame_of(build, film, style, look, folder):
    """The passes of an ordinary frame."""
    runs = []
    for frames in (SHORT, LONG):
        runs.append(recording.run(build, ["render", *film, "--frames", str(frames), "--style", style, "--look", look,
                                          "--output", str(folder / f"{frames}.mkv")], folder / f"{frames}.jsonl"))
    return passes_of(*runs, LONG - SHORT)


def print_costs(build, sizes):
    """Tables of the passes, and of a frame's time on each board."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for size in sizes:
            film = film_of(build, size, folder)
            for style, look in LOOKS.items():
                print(f"\n## {style}, {look}, {size}\n")
                _print_passes(frame_of(build, film, style, look, folder))


def _range(pair, scale):
    return f"{pair[0] * scale:.2f} to {pair[1] * scale:.2f}"


def _print_passes(passes):
    kept = {board.table: tables.read(board.table) for board in BOARDS}
    print("| pass | runs | MB read | MB written | " + " | ".join(f"{board.title}, ms" for board in BOARDS) +
          " |\n|---|---|---|---|" + "---|" * len(BOARDS))
    sums = {board.title: [0.0, 0.0] for board in BOARDS}
    read, written = [0.0, 0.0], [0.0, 0.0]
    for name, one in sorted(passes.items(), key=lambda item: -(item[1].read[0] + item[1].written[0])):
        cells = []
        for board in BOARDS:
            times = seconds_on(board, one, kept[board.table].get(name, {}))
            _add(sums[board.title], *times)
            cells.append(_range(times, 1e3))
        _add(read, *one.read)
        _add(written, *one.written)
        print(f"| {name} | {one.runs:.1f} | {_range(one.read, 1e-6)} | {_range(one.written, 1e-6)} | " + " | ".join(cells) + " |")
    print(f"| **frame** | | {_range(read, 1e-6)} | {_range(written, 1e-6)} | " +
          " | ".join(_range(times, 1e3) for times in sums.values()) + " |")

"""Records the programs that the product uses: runs it with the recorder before its GL."""
import os
import pathlib
import subprocess
import tempfile

import programs

SIZE = "160x120"  # states do not depend on it, and small frames are painted sooner
FRAMES = "4"
# What the workbench has not: a real thing that hides models, and a plane.
MORE = """
[[model]]
name = "box"
source = "builtin:box"
attach = "tag:0"
size_m = [0.08, 0.05, 0.1]
position_m = [0.1, 0.1, 0.05]
occluder = true

[[plane]]
name = "bench"
attach = "tag:0"
size_m = [1.2, 0.8]
"""


def call(build, arguments, **environment):
    """Runs the program on the software rasteriser, with a configuration of its own."""
    done = subprocess.run([str(build / "firmware_app/pleinair"), *arguments], check=False, capture_output=True, text=True,
                          env=dict(os.environ, PLEINAIR_CONFIG="", LIBGL_ALWAYS_SOFTWARE="1",
                                   MESA_EXTENSION_OVERRIDE="-GL_EXT_float_blend", **environment))
    if done.returncode != 0:
        raise RuntimeError(f"pleinair {' '.join(arguments)}: {done.stderr.strip()[-500:]}")


def run(build, arguments, file):
    """The records of one run of the program, with their work and counts."""
    call(build, arguments, LD_PRELOAD=str(build / "tests/embedded_gpu/libgl_recorder.so"), GL_RECORDER_FILE=str(file))
    return programs.read(file)


def record(build):
    """The distinct records: `warm-up` paints every look, quality level, debug view, camera layout and output layout
    of the workbench; a short film has what that lacks."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        records = run(build, ["warm-up", "--size", SIZE], folder / "warm-up.jsonl")
        film, scene = folder / "film.mp4", folder / "scene.toml"
        call(build, ["record", "--camera", "synthetic", "--frames", FRAMES, "--size", SIZE, "--output", str(film),
                     "--write-scene", str(scene)])
        scene.write_text(scene.read_text(encoding="utf-8") + MORE, encoding="utf-8")
        for style in ("watercolor", "painterly"):
            records += run(build, ["render", str(film), "--scene", str(scene), "--style", style, "--output",
                                   str(folder / "painted.mkv")], folder / f"{style}.jsonl")
    return programs.distinct(records)


def missing(kept, recorded):
    """Lines that say which recorded programs and states the kept list has not."""
    known = {programs.identity(record) for record in kept}
    names = {programs.name(record) for record in recorded if programs.identity(record) not in known}
    return [f"{name}: a program or state that programs.jsonl has not; ./dev gpu-report --record" for name in sorted(names)]

#!/usr/bin/env python3
"""Compiles what calls libcamera against header trees of several versions: README.md.

usage: compile.py TREE ...

TREE is a folder of installed headers (it has libcamera/libcamera.h), or a source tree of libcamera (it has
meson.build), whose generated headers are made by the tree's own scripts; these need PyYAML, and Jinja2 from 0.5 on.
CXX is the compiler, c++ if unset.

Exit status: 0; 1 where a file does not compile; 2 where a tree cannot be used.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "hal/cameras/libcamera"
# As the build has them (cmake/PleinairBuild.cmake).
FLAGS = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wold-style-cast",
         "-Wnon-virtual-dtor", "-Woverloaded-virtual", "-Wcast-qual", "-Wmissing-declarations",
         "-Wno-missing-field-initializers", "-Werror"]


class Unusable(Exception):
    """A tree that is none, or whose headers cannot be made."""


def sources():
    """The files that call libcamera."""
    found = sorted(FOLDER.glob("lc_*.cpp")) + [FOLDER / "libcamera_library.cpp"]
    callers = [each for each in FOLDER.glob("*.cpp") if "<libcamera/" in each.read_text()]
    strays = sorted(set(callers) - set(found))
    if strays:
        raise Unusable(f"{strays[0].name} calls libcamera; only lc_*.cpp and libcamera_library.cpp may")
    return found


def run(tree, *command):
    environment = dict(os.environ, PYTHONDONTWRITEBYTECODE="1")
    done = subprocess.run([sys.executable, *map(str, command)], cwd=tree, env=environment, text=True,
                          capture_output=True, check=False)
    if done.returncode != 0:
        raise Unusable(f"{tree}: {command[0]} failed: {done.stderr.strip().splitlines()[-1:]}")


def make_ids(tree, into, name, mode):
    """control_ids.h or property_ids.h: one list before 0.3, lists of vendors and ranges of numbers from then on."""
    library, headers = tree / "src/libcamera", tree / "include/libcamera"
    tool = next(each for each in [tree / "utils/codegen/gen-controls.py", tree / "utils/gen-controls.py"] if each.exists())
    template = headers / f"{name}.h.in"
    if not template.exists():
        template = headers / "control_ids.h.in"  # of both, from 0.5 on
    single = library / f"{name}.yaml"
    if single.exists():
        run(tree, tool, "-o", into / f"{name}.h", single, template)
        return
    # Those of every build; vendors have headers of their own choice.
    lists = [library / f"{name}_{part}.yaml" for part in ("core", "debug", "draft")]
    run(tree, tool, "-o", into / f"{name}.h", "--mode", mode, "-t", template, "-r", library / "control_ranges.yaml",
        *[each for each in lists if each.exists()])


def make_headers(tree, into):
    """What a build of the source tree would install, as far as programs include it."""
    public = into / "libcamera"
    shutil.copytree(tree / "include/libcamera", public, ignore=shutil.ignore_patterns("internal", "ipa", "*.in", "meson.build"))
    make_ids(tree, public, "control_ids", "controls")
    make_ids(tree, public, "property_ids", "properties")
    tool = next(each for each in [tree / "utils/codegen/gen-formats.py", tree / "utils/gen-formats.py"] if each.exists())
    run(tree, tool, "-o", public / "formats.h", tree / "src/libcamera/formats.yaml",
        tree / "include/libcamera/formats.h.in", tree / "include/linux/drm_fourcc.h")
    version = re.search(r"version\s*:\s*'(\d+)\.(\d+)\.(\d+)'", (tree / "meson.build").read_text())
    if version is None:
        raise Unusable(f"{tree}: meson.build names no version")
    text = (tree / "include/libcamera/version.h.in").read_text()
    for name, number in zip(("MAJOR", "MINOR", "PATCH"), version.groups()):
        text = text.replace(f"@LIBCAMERA_VERSION_{name}@", number)
    (public / "version.h").write_text(text)
    names = sorted(each.name for each in public.glob("*.h"))
    (public / "libcamera.h").write_text("#pragma once\n" + "".join(f"#include <libcamera/{each}>\n" for each in names))


def headers_of(tree, scratch):
    """The folder to include from."""
    if (tree / "libcamera/libcamera.h").exists():
        return tree
    if not (tree / "meson.build").exists():
        raise Unusable(f"{tree}: neither headers (libcamera/libcamera.h) nor a source tree (meson.build)")
    into = scratch / f"{len(list(scratch.iterdir()))}"
    into.mkdir()
    make_headers(tree, into)
    return into


def version_of(headers):
    text = (headers / "libcamera/version.h").read_text()
    return ".".join(re.search(rf"LIBCAMERA_VERSION_{part}\s+(\d+)", text).group(1) for part in ("MAJOR", "MINOR", "PATCH"))


def compiles(source, headers):
    command = [os.environ.get("CXX", "c++"), *FLAGS, "-I", str(ROOT), "-isystem", str(headers), str(source)]
    done = subprocess.run(command, text=True, capture_output=True, check=False)
    if done.returncode != 0:
        print(done.stderr)
    return done.returncode == 0


def main(trees):
    if not trees or trees[0].startswith("-"):
        print(__doc__)
        return 2
    failed = 0
    try:
        files = sources()
        with tempfile.TemporaryDirectory() as scratch:
            for tree in trees:
                headers = headers_of(pathlib.Path(tree).resolve(), pathlib.Path(scratch))
                results = {each.name: compiles(each, headers) for each in files}
                failed += sum(not each for each in results.values())
                broken = [name for name, works in results.items() if not works]
                print(f"libcamera {version_of(headers)}: "
                      + (f"does not compile: {', '.join(broken)}" if broken else f"{len(files)} files compile"))
    except Unusable as problem:
        print(problem, file=sys.stderr)
        return 2
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

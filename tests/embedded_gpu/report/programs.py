"""The programs that the product uses, with the states that they meet: programs.jsonl beside this folder.

Each line is one program in one state, as the recorder writes it (README.md), without how much work it did.
"""
import collections
import hashlib
import json
import pathlib
import re
import subprocess

KEPT = pathlib.Path(__file__).resolve().parent.parent / "programs.jsonl"


def identity(record):
    """Text that is equal for records of the same program in the same state."""
    return json.dumps([record["program"], record["defines"], record["state"]], sort_keys=True)


def distinct(records):
    """The records without their work, once each, in the order of their programs."""
    kept = {identity(r): {"program": r["program"], "defines": r["defines"], "state": r["state"]} for r in records}
    return [kept[key] for key in sorted(kept)]


def read(path=KEPT):
    """The records of a file."""
    with open(path, encoding="utf-8") as file:
        return [json.loads(line) for line in file if line.strip()]


def write(records, path=KEPT):
    with open(path, "w", encoding="utf-8") as file:
        file.writelines(json.dumps(record, sort_keys=True) + "\n" for record in records)


def name(record):
    """The name of a program in tables: "watercolor: guide.frag", with its flags."""
    words = record["program"].split()
    shaders = [word for word in words if "/" in word]
    flags = [word for word in words if "/" not in word]
    path = pathlib.PurePosixPath(shaders[-1])
    folder = path.parent.name if path.parent.name != "shaders" else path.parent.parent.name
    return " ".join([f"{folder}: {path.name}", *flags])


def by_name(records):
    """{name: records}, in the order of names."""
    groups = collections.defaultdict(list)
    for record in records:
        groups[name(record)].append(record)
    return dict(sorted(groups.items()))


def digests(replay, tree, records):
    """{name: digest} of what a compiler would see: texts without comments, and states."""
    answer = subprocess.run([str(replay), "--sources", str(tree)], input=_lines(records), capture_output=True, text=True,
                            check=True).stdout
    seen = collections.defaultdict(hashlib.sha256)
    for record, line in zip(records, answer.splitlines(), strict=True):
        for text in json.loads(line)["sources"]:
            seen[name(record)].update(without_comments(text).encode())
        seen[name(record)].update(identity(record).encode())
    return {key: digest.hexdigest()[:12] for key, digest in seen.items()}


def without_comments(text):
    """A shader's text without comments, blank lines and indentation."""
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    return "\n".join(line.strip() for line in text.splitlines() if line.strip())


def _lines(records):
    return "".join(json.dumps(record) + "\n" for record in records)

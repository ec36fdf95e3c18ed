"""The last line of the program's output:

showed 90 frames in 3.0 s (30.0 frames/s), 1 off schedule; dropped 3 (1 late, 2 while starting): OUTPUTS
"""
import re

LINE = re.compile(r"^showed (\d+) frames? in [\d.]+ s \([\d.]+ frames/s\)(?:, \d+ off schedule)?"
                  r"; dropped (\d+)(?: \(([^)\n]*)\))?: \S.*$", re.MULTILINE)
REASON = re.compile(r"(\d+) (\D+)")


def ledger(output):
    """Its numbers, from the program's whole output: shown, dropped, and each reason. Checks the
    sums."""
    match = LINE.search(output)
    assert match, "no ledger in:\n" + output
    reasons = {}
    for part in match[3].split(", ") if match[3] else []:
        reason = REASON.fullmatch(part)
        assert reason, f'"{part}" is no reason in:\n{match[0]}'
        reasons[reason[2]] = int(reason[1])
    assert sum(reasons.values()) == int(match[2]), "the reasons do not add up:\n" + match[0]
    return {"shown": int(match[1]), "dropped": int(match[2]), **reasons}

"""vivid's pattern "75% Colorbar": ITU-R BT.471's 75/0/75/0 bars, as R'G'B' in [0, 255].

A picture of them that went through a wrong matrix, a wrong range or swapped chroma is off by far more than
TOLERANCE: green that is written by BT.601's matrix and read by BT.709's is (0, 161, 0) instead of
(0, 191, 0); full range read as limited makes 204 of white."""

BARS = [("white", (191, 191, 191)), ("yellow", (191, 191, 0)), ("cyan", (0, 191, 191)),
        ("green", (0, 191, 0)), ("magenta", (191, 0, 191)), ("red", (191, 0, 0)),
        ("blue", (0, 0, 191)), ("black", (0, 0, 0))]
# vivid's own error is 3, in 8 bits of limited range; the program may add twice as much.
TOLERANCE = 8


def bars_of(frame, top=0.3, bottom=0.9):
    """The mean colour of each bar's middle, away from its neighbours."""
    count = len(BARS)
    return [frame.mean_rgb((i + 0.25) / count, top, (i + 0.75) / count, bottom)
            for i in range(count)]


def farthest(frame, grey=False, top=0.3, bottom=0.9):
    """The largest error of any bar in any channel, and all errors as text. `grey`: the camera
    delivered luma only (BT.601)."""
    worst, lines = 0.0, []
    for (name, expected), found in zip(BARS, bars_of(frame, top, bottom)):
        if grey:
            expected = (0.299 * expected[0] + 0.587 * expected[1] + 0.114 * expected[2],) * 3
        off = max(abs(a - b) for a, b in zip(expected, found))
        worst = max(worst, off)
        lines.append(f"{name:8} expected {tuple(round(c) for c in expected)}, "
                     f"found {tuple(round(c) for c in found)}: off by {off:.1f}")
    return worst, "\n".join(lines)

"""Parses what displays show (QEMU's screendump, PPM) and painted pictures (PNG), without any of the program's
libraries."""
import struct
import zlib


class Picture:
    """RGB, 8 bits."""

    def __init__(self, width, height, rows):
        self.width, self.height = width, height
        self.rows = rows  # bytes of 3 * width each

    def at(self, x, y):
        return tuple(self.rows[y][3 * x:3 * x + 3])

    def mean(self, left, top, right, bottom):
        """Mean colour of a box, given in parts of the width and height."""
        x0, x1 = round(left * self.width), round(right * self.width)
        y0, y1 = round(top * self.height), round(bottom * self.height)
        rows = [row[3 * x0:3 * x1] for row in self.rows[y0:y1]]
        count = sum(len(row) // 3 for row in rows)
        return tuple(sum(sum(row[c::3]) for row in rows) / count for c in range(3))

    def part(self, x, y, width, height):
        return Picture(width, height,
                       [row[3 * x:3 * (x + width)] for row in self.rows[y:y + height]])

    def turned(self, quarter_turns):
        """Clockwise."""
        picture = self
        for _ in range(quarter_turns % 4):
            rows = []
            for x in range(picture.width):
                rows.append(b"".join(picture.rows[y][3 * x:3 * x + 3]
                                     for y in reversed(range(picture.height))))
            picture = Picture(picture.height, picture.width, rows)
        return picture

    def farthest(self, other):
        """The largest difference of a channel, in levels."""
        assert (self.width, self.height) == (other.width, other.height), \
            f"{self.width}x{self.height}, not {other.width}x{other.height}"
        return max(max(abs(a - b) for a, b in zip(mine, theirs))
                   for mine, theirs in zip(self.rows, other.rows))


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    words, at = [], 0
    while len(words) < 4:
        end = at
        while not data[end:end + 1].isspace():
            end += 1
        words.append(data[at:end])
        at = end + 1
    assert words[0] == b"P6" and words[3] == b"255", words
    width, height = int(words[1]), int(words[2])
    return Picture(width, height, [data[at + 3 * width * y:at + 3 * width * (y + 1)]
                                   for y in range(height)])


def read_png(path):
    """RGB or RGBA, 8 bits, not interlaced."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            assert depth == 8 and colour in (2, 6) and interlace == 0, body
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = 3 if colour == 2 else 4
    stride, raw = width * channels, zlib.decompress(packed)
    rows, before = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = _unfiltered(raw[start], bytearray(raw[start + 1:start + 1 + stride]), before, channels)
        rows.append(bytes(value for i, value in enumerate(row) if i % channels < 3))
        before = row
    return Picture(width, height, rows)


def _unfiltered(kind, row, before, channels):
    for i, value in enumerate(row):
        left = row[i - channels] if i >= channels else 0
        up = before[i]
        corner = before[i - channels] if i >= channels else 0
        if kind == 1:
            guess = left
        elif kind == 2:
            guess = up
        elif kind == 3:
            guess = (left + up) // 2
        elif kind == 4:
            guess = min((left, up, corner), key=lambda each: abs(left + up - corner - each))
        else:
            guess = 0
        row[i] = (value + guess) % 256
    return row

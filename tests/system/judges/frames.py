"""Parses raw frames of a V4L2 device, without any of the program's libraries."""
import re
import struct
import zlib

# Kr and Kb of a matrix (ITU-R BT.601, BT.709), by the name that v4l2-ctl prints.
MATRICES = {"ITU-R 601": (0.299, 0.114), "Rec. 709": (0.2126, 0.0722)}


class Format:
    """A device's format, from the output of `v4l2-ctl --get-fmt-video`."""

    def __init__(self, text):
        self.text = text
        self.width, self.height = (int(n) for n in self._find(r"Width/Height\s*: (\d+)/(\d+)"))
        (self.fourcc,) = self._find(r"Pixel Format\s*: '(....)'")
        self.stride = int(self._find(r"Bytes per Line\s*: (\d+)")[0])
        self.frame_bytes = int(self._find(r"Size Image\s*: (\d+)")[0])
        # "ITU-R 601" or "Default (maps to ITU-R 601)"
        (encoding,) = self._find(r"YCbCr/HSV Encoding\s*: (?:Default \(maps to )?([^)\n]+)")
        self.matrix = MATRICES[encoding]
        (quantization,) = self._find(r"Quantization\s*: (?:Default \(maps to )?([^)\n]+)")
        self.is_full_range = quantization == "Full Range"

    def _find(self, pattern):
        match = re.search(pattern, self.text)
        if not match:
            raise AssertionError(f"no {pattern} in:\n{self.text}")
        return match.groups()


class Frame:
    """One frame: luma a byte a pixel, chroma as the layout samples it."""

    def __init__(self, data, form):
        assert len(data) == form.frame_bytes, f"{len(data)} bytes, not {form.frame_bytes}"
        self.form = form
        self.width, self.height = form.width, form.height
        self.data = data
        layout = {"YUYV": self._yuyv, "NV12": self._nv12, "YU12": self._i420}
        layout[form.fourcc]()

    def _yuyv(self):
        rows = [self.data[y * self.form.stride:][:self.width * 2] for y in range(self.height)]
        self.luma = [row[0::2] for row in rows]
        self.cb = [row[1::4] for row in rows]
        self.cr = [row[3::4] for row in rows]

    def _nv12(self):
        stride, chroma = self.form.stride, self.form.stride * self.height
        self.luma = [self.data[y * stride:][:self.width] for y in range(self.height)]
        rows = [self.data[chroma + y * stride:][:self.width] for y in range(self.height // 2)]
        self.cb = [row[0::2] for row in rows]
        self.cr = [row[1::2] for row in rows]

    def _i420(self):
        stride, chroma = self.form.stride, self.form.stride * self.height
        half, size = stride // 2, stride // 2 * (self.height // 2)
        self.luma = [self.data[y * stride:][:self.width] for y in range(self.height)]
        self.cb, self.cr = (
            [self.data[start + y * half:][:self.width // 2] for y in range(self.height // 2)]
            for start in (chroma, chroma + size))

    def mean_rgb(self, left, top, right, bottom):
        """Mean colour of a box, given in parts of the width and height, in [0, 255]."""
        means = (self._mean(plane, left, top, right, bottom)
                 for plane in (self.luma, self.cb, self.cr))
        return self._rgb(*means)

    def mean_luma(self):
        return self._mean(self.luma, 0, 0, 1, 1)

    def difference(self, other):
        """Mean absolute difference of luma."""
        total = sum(abs(a - b) for mine, theirs in zip(self.luma, other.luma)
                    for a, b in zip(mine, theirs))
        return total / (self.width * self.height)

    def write_png(self, path):
        """For people to look at."""
        rows = bytearray()
        across, down = self.width // len(self.cb[0]), self.height // len(self.cb)
        for y, luma in enumerate(self.luma):
            cb, cr = self.cb[y // down], self.cr[y // down]
            rows.append(0)  # no filter
            for x, value in enumerate(luma):
                rows += bytes(round(c) for c in self._rgb(value, cb[x // across], cr[x // across]))

        def chunk(kind, data):
            return (struct.pack(">I", len(data)) + kind + data +
                    struct.pack(">I", zlib.crc32(kind + data)))

        header = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        with open(path, "wb") as file:
            file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) +
                       chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b""))

    @staticmethod
    def _mean(plane, left, top, right, bottom):
        rows = plane[int(top * len(plane)):max(int(bottom * len(plane)), int(top * len(plane)) + 1)]
        width = len(plane[0])
        cells = [row[int(left * width):max(int(right * width), int(left * width) + 1)]
                 for row in rows]
        return sum(sum(row) for row in cells) / sum(len(row) for row in cells)

    def _rgb(self, luma, cb, cr):
        """ITU-R BT.601 §3.5 and BT.709: what the format's matrix and range mean."""
        kr, kb = self.form.matrix
        if self.form.is_full_range:
            y, pb, pr = luma, cb - 128, cr - 128
        else:
            y, pb, pr = (luma - 16) * 255 / 219, (cb - 128) * 255 / 224, (cr - 128) * 255 / 224
        red = y + 2 * (1 - kr) * pr
        blue = y + 2 * (1 - kb) * pb
        green = (y - kr * red - kb * blue) / (1 - kr - kb)
        return tuple(min(max(value, 0.0), 255.0) for value in (red, green, blue))


def split(data, form):
    """The frames of a file that `v4l2-ctl --stream-to` wrote."""
    assert len(data) % form.frame_bytes == 0, \
        f"{len(data)} bytes are not whole frames of {form.frame_bytes}"
    return [Frame(data[start:start + form.frame_bytes], form)
            for start in range(0, len(data), form.frame_bytes)]

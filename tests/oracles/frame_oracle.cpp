#include "tests/oracles/frame_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

namespace pleinair::oracles {
namespace {

using hal::ColorMatrix;
using hal::ColorRange;
using hal::ImageView;
using hal::PixelFormat;

struct Weights {
  double red;
  double blue;
  double green() const { return 1.0 - red - blue; }
};

Weights weightsOf(ColorMatrix matrix) {
  return matrix == ColorMatrix::kBt709 ? Weights{.red = 0.2126, .blue = 0.0722}
                                       : Weights{.red = 0.299, .blue = 0.114};
}

double byteAt(const ImageView& image, int plane, int column, int row) {
  return image.row(plane, row)[static_cast<std::size_t>(column)];
}

/// From quantised bytes, which may be fractional.
glm::dvec3 rgbFromBytes(double luma, double cb, double cr, hal::ColorEncoding encoding) {
  const bool limited = encoding.range == ColorRange::kLimited;
  const double y = limited ? (luma - 16.0) / 219.0 : luma / 255.0;
  const double pb = (cb - 128.0) / (limited ? 224.0 : 255.0);
  const double pr = (cr - 128.0) / (limited ? 224.0 : 255.0);
  const Weights k = weightsOf(encoding.matrix);
  const double red = y + 2.0 * (1.0 - k.red) * pr;
  const double blue = y + 2.0 * (1.0 - k.blue) * pb;
  const double green = (y - k.red * red - k.blue * blue) / k.green();
  return glm::clamp(glm::dvec3(red, green, blue), 0.0, 1.0);
}

glm::dvec3 bytesFromRgb(glm::dvec3 rgb, hal::ColorEncoding encoding) {
  const Weights k = weightsOf(encoding.matrix);
  const double y = k.red * rgb.r + k.green() * rgb.g + k.blue * rgb.b;
  const double pb = (rgb.b - y) / (2.0 * (1.0 - k.blue));
  const double pr = (rgb.r - y) / (2.0 * (1.0 - k.red));
  if (encoding.range == ColorRange::kFull)
    return {255.0 * y, 128.0 + 255.0 * pb, 128.0 + 255.0 * pr};
  return {16.0 + 219.0 * y, 128.0 + 224.0 * pb, 128.0 + 224.0 * pr};
}

/// The position of chroma column i, in luma columns: 2i or 2i + ½.
double sitedAt(hal::ColorEncoding encoding) {
  return encoding.range == ColorRange::kLimited ? 0.0 : 0.5;
}

/// Linear interpolation between two samples of a line of `count`, with repeated ends.
struct Between {
  int first;
  int second;
  double part;
  Between(double position, int count)
      : first(static_cast<int>(std::floor(position))), second(first + 1), part(position - first) {
    first = std::clamp(first, 0, count - 1);
    second = std::clamp(second, 0, count - 1);
  }
};

struct Chroma {
  int plane;
  int offset;       ///< of this component in a sample's bytes
  int sampleBytes;  ///< from one sample to the next of a row
  bool everyRow;    ///< 4:2:2
};

double chromaAt(const ImageView& image, const Chroma& chroma, int x, int y) {
  const hal::FrameSize size = image.format.size;
  const Between across((x - sitedAt(image.format.encoding)) / 2.0, (size.width + 1) / 2);
  const auto rowMean = [&](int row) {
    const auto sample = [&](int i) {
      return byteAt(image, chroma.plane, i * chroma.sampleBytes + chroma.offset, row);
    };
    return (1.0 - across.part) * sample(across.first) + across.part * sample(across.second);
  };
  if (chroma.everyRow) return rowMean(y);
  const Between down((y - 0.5) / 2.0, (size.height + 1) / 2);
  return (1.0 - down.part) * rowMean(down.first) + down.part * rowMean(down.second);
}

int mirrored(int i, int count) {
  if (count == 1) return 0;
  while (i < 0 || i >= count) i = i < 0 ? -i : 2 * (count - 1) - i;
  return i;
}

using Kernel = std::array<std::array<double, 5>, 5>;  // in eighths
constexpr Kernel kGreenAtRedOrBlue{
    {{0, 0, -1, 0, 0}, {0, 0, 2, 0, 0}, {-1, 2, 4, 2, -1}, {0, 0, 2, 0, 0}, {0, 0, -1, 0, 0}}};
constexpr Kernel kFromItsRow{{{0, 0, 0.5, 0, 0},
                              {0, -1, 0, -1, 0},
                              {-1, 4, 5, 4, -1},
                              {0, -1, 0, -1, 0},
                              {0, 0, 0.5, 0, 0}}};
constexpr Kernel kFromItsColumn{{{0, 0, -1, 0, 0},
                                 {0, -1, 4, -1, 0},
                                 {0.5, 0, 5, 0, 0.5},
                                 {0, -1, 4, -1, 0},
                                 {0, 0, -1, 0, 0}}};
constexpr Kernel kRedAtBlue{{{0, 0, -1.5, 0, 0},
                             {0, 2, 0, 2, 0},
                             {-1.5, 0, 6, 0, -1.5},
                             {0, 2, 0, 2, 0},
                             {0, 0, -1.5, 0, 0}}};

double filtered(const ImageView& image, const Kernel& kernel, int x, int y) {
  double sum = 0.0;
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) {
      const double weight = kernel[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)];
      sum += weight * byteAt(image, 0, mirrored(x + i - 2, image.format.size.width),
                             mirrored(y + j - 2, image.format.size.height));
    }
  }
  return sum / 8.0;
}

/// The colour, 'R', 'G' or 'B', of a pixel in the pattern's four letters.
char bayerColour(PixelFormat format, int x, int y) {
  const char* letters = format == PixelFormat::kBayerRggb8   ? "RGGB"
                        : format == PixelFormat::kBayerGrbg8 ? "GRBG"
                        : format == PixelFormat::kBayerGbrg8 ? "GBRG"
                                                             : "BGGR";
  return letters[2 * (y & 1) + (x & 1)];
}

glm::dvec3 demosaiced(const ImageView& image, int x, int y) {
  const PixelFormat format = image.format.pixelFormat;
  const double own = byteAt(image, 0, x, y);
  const char colour = bayerColour(format, x, y);
  glm::dvec3 rgb;
  if (colour == 'G') {
    const bool isRedRow = bayerColour(format, x + 1, y) == 'R';
    const double row = filtered(image, kFromItsRow, x, y);
    const double column = filtered(image, kFromItsColumn, x, y);
    rgb = isRedRow ? glm::dvec3(row, own, column) : glm::dvec3(column, own, row);
  } else {
    const double green = filtered(image, kGreenAtRedOrBlue, x, y);
    const double opposite = filtered(image, kRedAtBlue, x, y);
    rgb = colour == 'R' ? glm::dvec3(own, green, opposite) : glm::dvec3(opposite, green, own);
  }
  return glm::clamp(rgb / 255.0, 0.0, 1.0);
}

glm::dvec3 ycbcrPixel(const ImageView& image, int x, int y) {
  Chroma cb{.plane = 1, .offset = 0, .sampleBytes = 1, .everyRow = false};
  Chroma cr{.plane = 2, .offset = 0, .sampleBytes = 1, .everyRow = false};
  int lumaBytes = 1;
  if (image.format.pixelFormat == PixelFormat::kNv12) {
    cb.sampleBytes = cr.sampleBytes = 2;
    cr.plane = cr.offset = 1;
  } else if (image.format.pixelFormat == PixelFormat::kYuyv) {
    cb = {.plane = 0, .offset = 1, .sampleBytes = 4, .everyRow = true};
    cr = {.plane = 0, .offset = 3, .sampleBytes = 4, .everyRow = true};
    lumaBytes = 2;
  }
  return rgbFromBytes(byteAt(image, 0, x * lumaBytes, y), chromaAt(image, cb, x, y),
                      chromaAt(image, cr, x, y), image.format.encoding);
}

glm::dvec3 rgbPixel(const ImageView& image, int x, int y) {
  const PixelFormat format = image.format.pixelFormat;
  if (isYCbCr(format)) return ycbcrPixel(image, x, y);
  if (isBayer(format)) return demosaiced(image, x, y);
  if (format == PixelFormat::kGrey8) return glm::dvec3(byteAt(image, 0, x, y) / 255.0);
  const int bytes = format == PixelFormat::kRgba8 ? 4 : 3;
  return glm::dvec3(byteAt(image, 0, x * bytes, y), byteAt(image, 0, x * bytes + 1, y),
                    byteAt(image, 0, x * bytes + 2, y)) /
         255.0;
}

/// Aspect fill: the scale and origin that fill `size` with as much of `source` as fits.
struct Cover {
  double scale;
  glm::dvec2 origin;
  Cover(hal::FrameSize source, hal::FrameSize size)
      : scale(std::min(double(source.width) / size.width, double(source.height) / size.height)),
        origin((source.width - scale * size.width) / 2, (source.height - scale * size.height) / 2) {
  }
};

}  // namespace

Picture::Picture(hal::FrameSize pictureSize)
    : size(pictureSize), pixels(static_cast<std::size_t>(pictureSize.pixels())) {}

glm::dvec3& Picture::at(int x, int y) {
  return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                static_cast<std::size_t>(x)];
}

glm::dvec3 Picture::clampedAt(int x, int y) const {
  const int column = std::clamp(x, 0, size.width - 1);
  const int row = std::clamp(y, 0, size.height - 1);
  return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) +
                static_cast<std::size_t>(column)];
}

glm::dvec3 Picture::bilinearAt(glm::dvec2 position) const {
  const glm::dvec2 low = glm::floor(position - 0.5);
  const glm::dvec2 part = position - 0.5 - low;
  const int x = static_cast<int>(low.x);
  const int y = static_cast<int>(low.y);
  return glm::mix(glm::mix(clampedAt(x, y), clampedAt(x + 1, y), part.x),
                  glm::mix(clampedAt(x, y + 1), clampedAt(x + 1, y + 1), part.x), part.y);
}

Picture rgbOf(const ImageView& image) {
  Picture picture(image.format.size);
  for (int y = 0; y < picture.size.height; ++y) {
    for (int x = 0; x < picture.size.width; ++x) picture.at(x, y) = rgbPixel(image, x, y);
  }
  return picture;
}

Picture resampledByTaps(const Picture& picture, hal::FrameSize size) {
  const Cover cover(picture.size, size);
  const int taps = std::max(1, static_cast<int>(std::ceil(cover.scale / 2.0)));
  Picture result(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      glm::dvec3 sum(0.0);
      for (int tap = 0; tap < taps * taps; ++tap) {
        const int column = tap % taps;
        const int row = tap / taps;
        const glm::dvec2 within((column + 0.5) / taps, (row + 0.5) / taps);
        sum += picture.bilinearAt(cover.origin + cover.scale * (glm::dvec2(x, y) + within));
      }
      result.at(x, y) = sum / double(taps * taps);
    }
  }
  return result;
}

Picture resampledByArea(const Picture& picture, hal::FrameSize size) {
  const Cover cover(picture.size, size);
  Picture result(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const glm::dvec2 low = cover.origin + cover.scale * glm::dvec2(x, y);
      const glm::dvec2 high = low + cover.scale;
      glm::dvec3 sum(0.0);
      for (int j = int(std::floor(low.y)); j < int(std::ceil(high.y)); ++j) {
        for (int i = int(std::floor(low.x)); i < int(std::ceil(high.x)); ++i) {
          const double width = std::min(high.x, i + 1.0) - std::max(low.x, double(i));
          const double height = std::min(high.y, j + 1.0) - std::max(low.y, double(j));
          sum += width * height * picture.clampedAt(i, j);
        }
      }
      result.at(x, y) = sum / (cover.scale * cover.scale);
    }
  }
  return result;
}

namespace {

/// The colour of a chroma sample: the mean of the pixels around its site.
glm::dvec3 chromaColour(const Picture& picture, int x, int y, hal::FrameFormat format) {
  const auto row = [&](int at) {
    if (format.encoding.range == ColorRange::kFull) {
      return 0.5 * (picture.clampedAt(x, at) + picture.clampedAt(x + 1, at));
    }
    return 0.25 * (picture.clampedAt(x - 1, at) + 2.0 * picture.clampedAt(x, at) +
                   picture.clampedAt(x + 1, at));
  };
  if (format.pixelFormat == PixelFormat::kYuyv) return row(y);
  return 0.5 * (row(y) + row(y + 1));
}

std::uint8_t rounded(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

double packedByte(const Picture& picture, hal::FrameFormat format, int plane, int column, int y) {
  const auto luma = [&](int x) {
    return bytesFromRgb(picture.clampedAt(x, y), format.encoding)[0];
  };
  const auto chroma = [&](int x, int row, int component) {
    return bytesFromRgb(chromaColour(picture, x, row, format), format.encoding)[component];
  };
  switch (format.pixelFormat) {
    case PixelFormat::kRgba8:
      return column % 4 == 3 ? 255.0 : 255.0 * picture.clampedAt(column / 4, y)[column % 4];
    case PixelFormat::kRgb8:
      return 255.0 * picture.clampedAt(column / 3, y)[column % 3];
    case PixelFormat::kGrey8:
      return bytesFromRgb(picture.clampedAt(column, y),
                          {.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull})[0];
    case PixelFormat::kYuyv:
      if (column % 2 == 0) return luma(column / 2);
      return chroma(column / 4 * 2, y, column % 4 == 1 ? 1 : 2);
    case PixelFormat::kNv12:
      return plane == 0 ? luma(column) : chroma(column / 2 * 2, 2 * y, 1 + column % 2);
    default:  // I420
      return plane == 0 ? luma(column) : chroma(2 * column, 2 * y, plane);
  }
}

}  // namespace

hal::Image packed(const Picture& picture, hal::FrameFormat format) {
  hal::Image image(format);
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    for (int y = 0; y < planeRows(format.pixelFormat, plane, format.size.height); ++y) {
      int column = 0;
      for (auto& byte : image.row(plane, y)) {
        byte = rounded(packedByte(picture, format, plane, column++, y));
      }
    }
  }
  return image;
}

}  // namespace pleinair::oracles

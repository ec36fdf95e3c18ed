#include "pipeline/styles/strokes/brush_file.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "hal/image.h"
#include "hal/media/file_input.h"
#include "hal/media/picture_file.h"
#include "hal/media/picture_header.h"

namespace pleinair::styles {
namespace {

constexpr std::int64_t kMaxFileBytes = 16LL << 20;  // of the largest, not compressed, and more
constexpr int kAspect = 4;                          // of a mark
constexpr int kMinPaint = 8;                        // of 255, somewhere in a mark

hal::Error refused(const std::filesystem::path& path, std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = "brush " + path.string(),
          .problem = std::move(problem),
          .remedy = fmt::format("give a PNG of {} to {} px width: four times as wide as high, or "
                                "square with four marks below each other",
                                kMinBrushWidth, kMaxBrushWidth)};
}

hal::Error named(hal::Error error, const std::filesystem::path& path) {
  // The remedy for an empty file, or one that is no file, speaks of movies.
  if (error.kind == hal::ErrorKind::kInvalidInput) return refused(path, error.problem);
  error.subject = "brush " + path.string();
  return error;
}

hal::Result<std::vector<std::uint8_t>> bytesOf(const std::filesystem::path& path) {
  const hal::Result<hal::FileInput> file = hal::FileInput::open(path);
  if (!file) return tl::unexpected(named(file.error(), path));
  if (file->sizeBytes() > kMaxFileBytes) {
    return tl::unexpected(refused(path, fmt::format("takes {} MiB", file->sizeBytes() >> 20)));
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file->sizeBytes()));
  if (file->readAt(0, bytes.data(), bytes.size()) != file->sizeBytes()) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kIo,
                                     .subject = "brush " + path.string(),
                                     .problem = "cannot be read",
                                     .remedy = "copy it again"});
  }
  return bytes;
}

/// How many marks a picture of that size has; nothing where it is no brush's.
std::optional<int> variantsOf(hal::FrameSize size) {
  const bool isOfSize = size.width >= kMinBrushWidth && size.width <= kMaxBrushWidth;
  if (!isOfSize || size.width % kAspect != 0) return std::nullopt;
  if (size.height == size.width / kAspect) return 1;
  if (size.height == size.width) return kAspect;
  return std::nullopt;
}

/// The most paint that any texel has, in 255ths.
int maxPaintOf(const BrushMarks& marks) {
  int most = 0;
  for (std::size_t i = 0; i < marks.texels.size(); i += 2)
    most = std::max<int>(most, marks.texels[i]);
  return most;
}

/// The mean of a channel over the texels [fromX, toX) x [fromY, toY).
std::uint8_t meanOf(const BrushMarks& marks, int fromX, int toX, int fromY, int toY, int channel) {
  const auto stride = static_cast<std::size_t>(kAspect * marks.across) * 2;
  int sum = 0;
  for (int y = fromY; y < toY; ++y) {
    for (int x = fromX; x < toX; ++x) {
      const auto column = static_cast<std::size_t>(2 * x + channel);
      sum += marks.texels[static_cast<std::size_t>(y) * stride + column];
    }
  }
  const int count = (toX - fromX) * (toY - fromY);
  return static_cast<std::uint8_t>((sum + count / 2) / count);
}

}  // namespace

hal::Result<BrushMarks> readBrushFile(const std::filesystem::path& path) {
  using hal::PictureKind;
  const hal::Result<std::vector<std::uint8_t>> bytes = bytesOf(path);
  if (!bytes) return tl::unexpected(bytes.error());
  if (hal::pictureKindOf(*bytes) != PictureKind::kPng) {
    return tl::unexpected(refused(path, "is no PNG"));
  }
  const std::optional<hal::FrameSize> size = hal::peekPictureSize(PictureKind::kPng, *bytes);
  if (!size) return tl::unexpected(refused(path, "is a broken PNG"));
  const std::optional<int> variants = variantsOf(*size);
  if (!variants) {
    return tl::unexpected(refused(path, fmt::format("is {}x{} px", size->width, size->height)));
  }
  const hal::Result<hal::Image> picture = hal::decodeRgba(*bytes, path.string());
  if (!picture) return tl::unexpected(named(picture.error(), path));
  BrushMarks marks{.across = size->width / kAspect, .variants = *variants, .texels = {}};
  marks.texels.reserve(static_cast<std::size_t>(size->pixels()) * 2);
  for (int y = 0; y < size->height; ++y) {
    const auto row = picture->view().row(0, y);
    for (std::size_t x = 0; x < row.size(); x += 4) {
      for (std::size_t c = 0; c < 2; ++c) {
        marks.texels.push_back(static_cast<std::uint8_t>((row[x + c] * row[x + 3] + 127) / 255));
      }
    }
  }
  if (maxPaintOf(marks) < kMinPaint) {
    return tl::unexpected(
        hal::Error{.kind = hal::ErrorKind::kInvalidInput,
                   .subject = "brush " + path.string(),
                   .problem = "has no paint in it: it is black or transparent all over",
                   .remedy = "paint is white, or red, on black; invert what is black on white"});
  }
  return marks;
}

BrushMarks reducedTo(const BrushMarks& marks, int across) {
  if (across >= marks.across) return marks;
  BrushMarks reduced{.across = across, .variants = marks.variants, .texels = {}};
  const int height = across * marks.variants;
  const int width = across * kAspect;
  const auto from = [&](int i) { return i * marks.across / across; };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 2; ++c) {
        reduced.texels.push_back(meanOf(marks, from(x), from(x + 1), from(y), from(y + 1), c));
      }
    }
  }
  return reduced;
}

}  // namespace pleinair::styles

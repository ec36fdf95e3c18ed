#include "pipeline/present/waiting_picture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/text/text_coverage.h"

namespace pleinair::present {
namespace {

using Colour = cv::Vec3f;  // sRGB, 0 … 255

const Colour kPaper{247.0F, 243.0F, 233.0F};
const Colour kInk{62.0F, 52.0F, 46.0F};
/// Side of the tile of paper relief, in pixels.
constexpr int kTile = 256;
/// Washes are soft: they are computed with about so many rows, and enlarged.
constexpr int kWashRows = 270;
/// Of the sheet's height: the margin that holds the text.
constexpr double kTextMargin = 0.2;
constexpr double kTitleHeight = 0.05;
constexpr double kDetailHeight = 0.029;
constexpr int kMinFontPixels = 9;
/// How much of the painting's pigment is left.
constexpr float kWashedOut = 0.62F;

std::uint32_t hashOf(int x, int y, std::uint32_t salt) {
  std::uint32_t hash = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                       static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ salt * 0xC2B2AE3DU;
  hash = (hash ^ (hash >> 15U)) * 0x2C1B3C6DU;
  hash = (hash ^ (hash >> 12U)) * 0x297A2D39U;
  return hash ^ (hash >> 15U);
}

/// Value noise in −1 … 1, of period `period` knots where that is above zero.
float noise(float x, float y, std::uint32_t salt, int period = 0) {
  const auto knot = [&](int i, int j) {
    if (period > 0) {
      i = (i % period + period) % period;
      j = (j % period + period) % period;
    }
    return static_cast<float>(hashOf(i, j, salt) & 0xFFFFU) / 32767.5F - 1.0F;
  };
  const float left = std::floor(x);
  const float top = std::floor(y);
  const auto smooth = [](float t) { return t * t * (3.0F - 2.0F * t); };
  const float u = smooth(x - left);
  const float v = smooth(y - top);
  const int i = static_cast<int>(left);
  const int j = static_cast<int>(top);
  const float upper = knot(i, j) + (knot(i + 1, j) - knot(i, j)) * u;
  const float lower = knot(i, j + 1) + (knot(i + 1, j + 1) - knot(i, j + 1)) * u;
  return upper + (lower - upper) * v;
}

float fractal(float x, float y, std::uint32_t salt, int octaves) {
  float sum = 0.0F;
  float amplitude = 0.5F;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * noise(x, y, salt + static_cast<std::uint32_t>(i));
    x *= 2.03F;
    y *= 2.03F;
    amplitude *= 0.5F;
  }
  return sum;
}

float smoothStep(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// A place of cold-pressed paper.
struct Grain {
  float height = 0.0F;  ///< −1 … 1
  float light = 1.0F;   ///< on its slope, from the top left
};

/// A tile of it, seamless.
std::vector<Grain> paperGrain() {
  std::vector<Grain> grain(std::size_t{kTile} * kTile);
  const auto at = [&](int x, int y) -> Grain& {
    return grain[static_cast<std::size_t>(y % kTile) * kTile + static_cast<std::size_t>(x % kTile)];
  };
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      float amplitude = 0.42F;
      for (const int spacing : {8, 4, 2}) {
        const auto knots = static_cast<float>(spacing);
        at(x, y).height +=
            amplitude * noise(static_cast<float>(x) / knots, static_cast<float>(y) / knots,
                              static_cast<std::uint32_t>(spacing), kTile / spacing);
        amplitude *= 0.8F;
      }
    }
  }
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      at(x, y).light = 1.0F + 0.035F * (at(x, y).height - at(x + 1, y + 1).height);
    }
  }
  return grain;
}

/// A borrowed view; OpenCV has no read-only Mat, but nothing writes through it.
cv::Mat matOf(const hal::ImageView& image) {
  const bool isRgba = image.format.pixelFormat == hal::PixelFormat::kRgba8;
  assert(isRgba || image.format.pixelFormat == hal::PixelFormat::kRgb8);
  return {image.format.size.height, image.format.size.width, isRgba ? CV_8UC4 : CV_8UC3,
          const_cast<std::uint8_t*>(image.planes[0].bytes.data()), image.planes[0].strideBytes};
}

Colour mixed(const Colour& from, const Colour& to, float part) {
  return from + (to - from) * part;
}

/// A plain of a few washes under a wide sky, for a sheet that nothing has been painted on yet.
/// Places are in parts of the sheet's height.
class Landscape {
 public:
  explicit Landscape(int columns, float columnsPerHeight) {
    for (std::size_t i = 0; i < kRidges.size(); ++i) {
      for (int column = 0; column < columns; ++column) {
        const float x = (static_cast<float>(column) + 0.5F) / columnsPerHeight;
        const float hills = fractal(kRidges[i].width * x, 0.0F, saltOf(i), 5);
        tops_[i].push_back(kRidges[i].top - kRidges[i].rise * hills);
      }
    }
  }

  Colour at(int column, float x, float y) const {
    // From the front: what is behind a ridge is not computed.
    std::array<float, kRidges.size()> within{};
    std::size_t first = kRidges.size();
    while (first > 0 && (first == kRidges.size() || within[first] < 1.0F)) {
      --first;
      within[first] =
          smoothStep(-0.004F, 0.006F, y - tops_[first][static_cast<std::size_t>(column)]);
    }
    Colour colour = within[first] < 1.0F ? skyAt(x, y) : Colour();
    for (std::size_t i = first; i < kRidges.size(); ++i) {
      if (within[i] <= 0.0F) continue;
      const float below = y - tops_[i][static_cast<std::size_t>(column)];
      const float depth =
          smoothStep(0.0F, 0.16F, below + 0.05F * fractal(5.0F * x, 9.0F * y, saltOf(i) + 5, 3));
      colour = mixed(colour, mixed(kRidges[i].near, kRidges[i].far, depth), within[i]);
    }
    return colour;
  }

 private:
  struct Ridge {
    float top, rise, width;
    Colour near, far;
  };
  static inline const std::array<Ridge, 3> kRidges{
      {{0.47F, 0.10F, 1.1F, {128.0F, 148.0F, 172.0F}, {196.0F, 202.0F, 204.0F}},
       {0.55F, 0.07F, 1.9F, {112.0F, 136.0F, 126.0F}, {184.0F, 190.0F, 158.0F}},
       {0.65F, 0.06F, 1.2F, {150.0F, 136.0F, 84.0F}, {206.0F, 184.0F, 128.0F}}}};
  static std::uint32_t saltOf(std::size_t ridge) {
    return 50U + 10U * static_cast<std::uint32_t>(ridge);
  }
  static Colour skyAt(float x, float y) {
    const Colour zenith{133.0F, 170.0F, 201.0F};
    const Colour glow{240.0F, 218.0F, 182.0F};
    const float cloud = fractal(1.6F * x + 3.0F, 4.0F * y, 21, 4);
    const Colour sky = mixed(zenith, glow, smoothStep(0.0F, 0.5F, y + 0.1F * cloud));
    const float isCloud = smoothStep(0.05F, 0.4F, cloud) * smoothStep(0.6F, 0.1F, y);
    return mixed(sky, kPaper, 0.75F * isCloud);
  }

  std::array<std::vector<float>, 3> tops_;
};

/// Washes are computed at this size.
cv::Size washSize(hal::FrameSize size) {
  const int scale = std::max(1, (size.height + kWashRows / 2) / kWashRows);
  return {std::max(1, size.width / scale), std::max(1, size.height / scale)};
}

/// How much of the paper the washes cover, 0 to 255.
hal::Image coverageOf(hal::FrameSize size) {
  const cv::Size small = washSize(size);
  cv::Mat coverage(small, CV_8UC1);
  const auto height = static_cast<float>(small.height);
  const float right = static_cast<float>(small.width) / height;
  constexpr auto kBottom = static_cast<float>(1.0 - kTextMargin);
  for (int row = 0; row < small.height; ++row) {
    for (int column = 0; column < small.width; ++column) {
      const float x = (static_cast<float>(column) + 0.5F) / height;
      const float y = (static_cast<float>(row) + 0.5F) / height;
      const float inside = std::min({x, right - x, y, kBottom - y});
      // Long strokes of a broad brush at the sides, and a ragged edge on top of them.
      const float edge = inside + 0.045F * fractal(3.0F * x, 14.0F * y, 7, 3) +
                         0.02F * fractal(22.0F * x, 26.0F * y, 11, 3);
      coverage.at<std::uint8_t>(row, column) =
          cv::saturate_cast<std::uint8_t>(255.0F * smoothStep(0.035F, 0.065F, edge));
    }
  }
  hal::Image whole({.pixelFormat = hal::PixelFormat::kGrey8, .size = size, .encoding = {}});
  cv::Mat full(size.height, size.width, CV_8UC1, whole.plane(0).data());
  cv::resize(coverage, full, full.size(), 0, 0, cv::INTER_LINEAR);
  return whole;
}

cv::Mat landscapeOf(hal::FrameSize size) {
  const cv::Size small = washSize(size);
  cv::Mat landscape(small, CV_8UC3);
  const auto height = static_cast<float>(small.height);
  const Landscape nature(small.width, height);
  for (int row = 0; row < small.height; ++row) {
    for (int column = 0; column < small.width; ++column) {
      const float x = (static_cast<float>(column) + 0.5F) / height;
      const float y = (static_cast<float>(row) + 0.5F) / height;
      landscape.at<cv::Vec3b>(row, column) = cv::Vec3b(nature.at(column, x, y));
    }
  }
  return landscape;
}

/// The washes on the sheet: RGB, and as alpha how much of the paper they cover.
cv::Mat washesOf(hal::Image& covered, const hal::ImageView& painting) {
  const hal::FrameSize size = covered.size();
  const cv::Mat coverage(size.height, size.width, CV_8UC1, covered.plane(0).data());
  const cv::Size full(size.width, size.height);
  cv::Mat colours;
  const bool hasPainting = !painting.planes[0].bytes.empty();
  if (hasPainting) {
    const cv::Mat from = matOf(painting);
    const double zoom = std::max(static_cast<double>(full.width) / from.cols,
                                 static_cast<double>(full.height) / from.rows);
    const auto cutTo = [&](int whole, int side) {
      return std::clamp(static_cast<int>(std::lround(side / zoom)), 1, whole);
    };
    const cv::Size part(cutTo(from.cols, full.width), cutTo(from.rows, full.height));
    const cv::Rect cut({(from.cols - part.width) / 2, (from.rows - part.height) / 2}, part);
    cv::resize(from(cut), colours, full, 0, 0, zoom < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
    if (colours.channels() == 4) cv::cvtColor(colours, colours, cv::COLOR_RGBA2RGB);
  } else {
    cv::resize(landscapeOf(size), colours, full, 0, 0, cv::INTER_LINEAR);
  }
  const std::array<cv::Mat, 2> parts{colours, coverage};
  cv::Mat washes(full, CV_8UC4);
  const std::array<int, 8> channels{0, 0, 1, 1, 2, 2, 3, 3};
  cv::mixChannels(parts.data(), parts.size(), &washes, 1, channels.data(), 4);
  return washes;
}

/// Paper with the washes: they granulate in its valleys, and dry darker at their edges.
void paintSheet(hal::Image& sheet, const cv::Mat& washes) {
  static const std::vector<Grain> kGrain = paperGrain();
  for (int y = 0; y < sheet.size().height; ++y) {
    const std::span<std::uint8_t> row = sheet.row(0, y);
    const auto* wash = washes.ptr<cv::Vec4b>(y);
    const Grain* grains = &kGrain[static_cast<std::size_t>(y % kTile) * kTile];
    for (int x = 0; x < sheet.size().width; ++x) {
      const Grain& grain = grains[x % kTile];
      const float covered = static_cast<float>(wash[x][3]) / 255.0F;
      const float rim = 4.0F * covered * (1.0F - covered);
      const float pigment =
          covered * kWashedOut * (1.0F - 0.14F * grain.height) + 0.10F * rim * covered;
      for (int c = 0; c < 3; ++c) {
        const float paper = kPaper[c];
        const float value =
            (paper + (static_cast<float>(wash[x][c]) - paper) * pigment) * grain.light;
        row[static_cast<std::size_t>(4 * x + c)] = cv::saturate_cast<std::uint8_t>(value);
      }
      row[static_cast<std::size_t>(4 * x + 3)] = 255;
    }
  }
}

/// Writes a line, centred, from `top` on; returns where the next one may begin.
int write(hal::Image& sheet, const std::string& text, const std::string& font, double height,
          int top, float opacity) {
  const hal::FrameSize size = sheet.size();
  const int pixels = static_cast<int>(std::lround(height * std::min(size.height, size.width)));
  if (text.empty() || pixels < kMinFontPixels) return top;
  const hal::Image line = hal::textCoverage(text, {.font = font,
                                                   .fontPixels = pixels,
                                                   .maxWidth = size.width * 9 / 10,
                                                   .tooWide = hal::TextLayout::TooWide::kWrap,
                                                   .isCentred = true});
  const int left = (size.width - line.size().width) / 2;
  for (int y = 0; y < line.size().height && top + y < size.height; ++y) {
    const auto coverage = line.view().row(0, y);
    const auto row = sheet.row(0, top + y);
    for (std::size_t x = 0; x < coverage.size(); ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(left) + x);
      const float part = opacity * static_cast<float>(coverage[x]) / 255.0F;
      for (std::size_t c = 0; c < 3; ++c) {
        const float paper = row[at + c];
        row[at + c] =
            cv::saturate_cast<std::uint8_t>(paper + (kInk[static_cast<int>(c)] - paper) * part);
      }
    }
  }
  return top + line.size().height;
}

}  // namespace

hal::Image waitingPicture(hal::FrameSize size, const hal::ImageView& painting,
                          const WaitingText& text) {
  return WaitingPictures().draw(size, painting, 0, text);
}

hal::Image WaitingPictures::draw(hal::FrameSize size, const hal::ImageView& painting,
                                 std::uint64_t paintingNumber, const WaitingText& text) {
  assert(hal::isAcceptedSize(size));
  if (coverage_.size() != size) {
    coverage_ = coverageOf(size);
    sheet_ = hal::Image();
  }
  if (sheet_.size() != size || paintingNumber_ != paintingNumber) {
    sheet_ = hal::Image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}});
    paintSheet(sheet_, washesOf(coverage_, painting));
    paintingNumber_ = paintingNumber;
  }
  hal::Image sheet = sheet_;
  const int top = static_cast<int>(std::lround((1.0 - 0.85 * kTextMargin) * size.height));
  const int next = write(sheet, text.title, "Serif Italic", kTitleHeight, top, 0.92F);
  write(sheet, text.detail, "Serif", kDetailHeight, next, 0.72F);
  return sheet;
}

hal::Image turned(const hal::Image& picture, int quarterTurns) {
  const int turns = (quarterTurns % 4 + 4) % 4;
  if (turns == 0) return picture;
  hal::FrameFormat format = picture.format();
  assert(format.pixelFormat == hal::PixelFormat::kRgba8);
  if (turns % 2 != 0) std::swap(format.size.width, format.size.height);
  hal::Image result(format);
  const cv::Mat from = matOf(picture.view());
  cv::Mat to(format.size.height, format.size.width, CV_8UC4, result.plane(0).data());
  constexpr std::array<int, 4> kCodes{0, cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180,
                                      cv::ROTATE_90_COUNTERCLOCKWISE};
  cv::rotate(from, to, kCodes.at(static_cast<std::size_t>(turns)));
  return result;
}

hal::Image mirrored(const hal::Image& picture) {
  assert(picture.format().pixelFormat == hal::PixelFormat::kRgba8);
  hal::Image result(picture.format());
  const cv::Mat from = matOf(picture.view());
  cv::Mat to(from.rows, from.cols, CV_8UC4, result.plane(0).data());
  constexpr int kAboutTheVertical = 1;
  cv::flip(from, to, kAboutTheVertical);
  return result;
}

}  // namespace pleinair::present

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "hal/image.h"
#include "tests/oracles/frame_oracle.h"

namespace pleinair::support {

/// An image of random bytes.
inline hal::Image randomImage(hal::FrameFormat format, unsigned seed = 1) {
  hal::Image image(format);
  std::mt19937 random(seed);
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    for (auto& byte : image.plane(plane)) byte = static_cast<std::uint8_t>(random());
  }
  return image;
}

/// An RGB8 image of smooth waves, different in each channel, with periods of 30 px and more.
inline hal::Image wavyImage(hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  for (int y = 0; y < size.height; ++y) {
    int column = 0;
    for (auto& byte : image.row(0, y)) {
      const int x = column / 3;
      const int channel = column++ % 3;
      const double wave = std::sin(0.12 * x + channel) * std::cos((0.08 + 0.02 * channel) * y);
      byte = static_cast<std::uint8_t>(std::lround(127.5 + 110.0 * wave));
    }
  }
  return image;
}

/// A copy of an image with `extraBytes` of padding (0xA5) after each row.
class PaddedImage {
 public:
  PaddedImage(const hal::ImageView& image, std::size_t extraBytes) : view_(image) {
    for (int plane = 0; plane < planeCount(image.format.pixelFormat); ++plane) {
      const auto i = static_cast<std::size_t>(plane);
      const int rows = planeRows(image.format.pixelFormat, plane, image.format.size.height);
      for (int y = 0; y < rows; ++y) {
        const auto row = image.row(plane, y);
        planes_[i].insert(planes_[i].end(), row.begin(), row.end());
        if (y + 1 < rows) planes_[i].insert(planes_[i].end(), extraBytes, 0xA5);
      }
      view_.planes[i] = {.bytes = planes_[i],
                         .strideBytes = image.row(plane, 0).size() + extraBytes};
    }
  }
  const hal::ImageView& view() const { return view_; }

 private:
  std::array<std::vector<std::uint8_t>, 3> planes_;
  hal::ImageView view_;
};

/// The largest error of any channel of an RGBA8 image, in 1/255.
inline double largestError(hal::Image& image, const oracles::Picture& expected) {
  EXPECT_EQ(image.size(), expected.size);
  double largest = 0.0;
  for (int y = 0; y < expected.size.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < expected.size.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double is = row[static_cast<std::size_t>(4 * x + c)];
        largest = std::max(largest, std::abs(is - 255.0 * expected.clampedAt(x, y)[c]));
      }
    }
  }
  return largest;
}

/// The largest difference of any byte between two images of one format.
inline int largestError(hal::Image& image, hal::Image& expected) {
  EXPECT_EQ(image.format(), expected.format());
  int largest = 0;
  for (int plane = 0; plane < planeCount(image.format().pixelFormat); ++plane) {
    const auto is = image.plane(plane);
    const auto should = expected.plane(plane);
    for (std::size_t i = 0; i < is.size(); ++i) {
      largest = std::max(largest, std::abs(int{is[i]} - int{should[i]}));
    }
  }
  return largest;
}

}  // namespace pleinair::support

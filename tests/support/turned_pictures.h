#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/image.h"

namespace pleinair::support {

/// The eight EXIF orientations, 1 to 8, with their display matrices in units of 1.0 (rows: a b, c
/// d).
struct ExifOrientation {
  int number;
  std::array<int, 4> matrix;
};
inline constexpr std::array<ExifOrientation, 8> kOrientations = {{{1, {1, 0, 0, 1}},
                                                                  {2, {-1, 0, 0, 1}},
                                                                  {3, {-1, 0, 0, -1}},
                                                                  {4, {1, 0, 0, -1}},
                                                                  {5, {0, 1, 1, 0}},
                                                                  {6, {0, 1, -1, 0}},
                                                                  {7, {0, -1, -1, 0}},
                                                                  {8, {0, -1, 1, 0}}}};

/// A display matrix in 16.16 fixed point, the last column in 2.30.
inline std::array<std::int32_t, 9> displayMatrix(std::array<int, 4> matrix) {
  constexpr int kOne = 1 << 16;
  return {matrix[0] * kOne, matrix[1] * kOne, 0, matrix[2] * kOne, matrix[3] * kOne, 0, 0, 0,
          1 << 30};
}

struct PlaneSize {
  int width;
  int height;
  std::size_t pixelBytes;
};
inline PlaneSize planeSize(hal::FrameFormat format, int plane) {
  std::size_t pixelBytes = format.pixelFormat == hal::PixelFormat::kRgb8 ? 3 : 1;
  if (format.pixelFormat == hal::PixelFormat::kNv12 && plane == 1) pixelBytes = 2;
  return {
      static_cast<int>(hal::rowBytes(format.pixelFormat, plane, format.size.width) / pixelBytes),
      hal::planeRows(format.pixelFormat, plane, format.size.height), pixelBytes};
}

/// The upright image of a picture stored with an EXIF orientation, from the standard's definition:
/// the sides of the scene at which its first row and column lie (CIPA DC-008, tag 0x0112).
inline hal::Image uprightByExif(const hal::ImageView& stored, int orientation) {
  hal::FrameFormat format = stored.format;
  if (orientation >= 5) std::swap(format.size.width, format.size.height);
  hal::Image shown(format);
  for (int plane = 0; plane < hal::planeCount(format.pixelFormat); ++plane) {
    const PlaneSize from = planeSize(stored.format, plane);
    const PlaneSize to = planeSize(format, plane);
    for (int row = 0; row < from.height; ++row) {
      for (int column = 0; column < from.width; ++column) {
        const int right = to.width - 1;
        const int bottom = to.height - 1;
        const std::array<std::array<int, 2>, 8> places = {{{column, row},  // top, left
                                                           {right - column, row},
                                                           {right - column, bottom - row},
                                                           {column, bottom - row},
                                                           {row, column},  // left, top
                                                           {right - row, column},
                                                           {right - row, bottom - column},
                                                           {row, bottom - column}}};
        const auto [x, y] = places.at(static_cast<std::size_t>(orientation - 1));
        const auto pixel =
            stored.row(plane, row)
                .subspan(static_cast<std::size_t>(column) * from.pixelBytes, from.pixelBytes);
        std::ranges::copy(
            pixel,
            shown.row(plane, y).subspan(static_cast<std::size_t>(x) * to.pixelBytes).begin());
      }
    }
  }
  return shown;
}

/// An image without symmetry in which neighbouring pixels differ in each plane.
inline hal::Image unevenPicture(hal::FrameFormat format) {
  hal::Image image(format);
  std::uint32_t value = 7;
  for (int plane = 0; plane < hal::planeCount(format.pixelFormat); ++plane) {
    for (std::uint8_t& byte : image.plane(plane)) {
      value = value * 1664525 + 1013904223;
      byte = static_cast<std::uint8_t>(value >> 24);
    }
  }
  return image;
}

inline bool equalPixels(const hal::ImageView& a, const hal::ImageView& b) {
  if (a.format != b.format) return false;
  for (int plane = 0; plane < hal::planeCount(a.format.pixelFormat); ++plane) {
    for (int y = 0; y < hal::planeRows(a.format.pixelFormat, plane, a.format.size.height); ++y) {
      if (!std::ranges::equal(a.row(plane, y), b.row(plane, y))) return false;
    }
  }
  return true;
}

}  // namespace pleinair::support

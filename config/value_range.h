#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace pleinair::config {

/// A range of finite numbers with a unit. `unit` refers to text that must outlive the range (a
/// literal); it is for messages: "metres".
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool minOpen = false;  ///< `min` itself is not allowed
  bool maxOpen = false;
  std::string_view unit = {};

  /// Returns false for NaN and infinities too.
  bool contains(double value) const;
  /// "a number of metres in (0, 10]", or with `plural` "numbers of metres in (0, 10]".
  std::string describe(bool plural = false) const;
};

/// A range of whole numbers, both ends included.
struct IntegerRange {
  int min = std::numeric_limits<int>::min();
  int max = std::numeric_limits<int>::max();
  std::string_view unit = {};

  bool contains(long long value) const { return value >= min && value <= max; }
  /// "a whole number of pixels in [1, 64]".
  std::string describe() const;
};

/// A size in pixels; 0x0 if there is none.
struct PixelSize {
  int width = 0;
  int height = 0;
  bool operator==(const PixelSize&) const = default;
};

/// A range of sizes.
struct SizeRange {
  int maxSide = 65535;
  long long maxPixels = std::numeric_limits<long long>::max();

  /// Whether the size is at least 1x1 and within the limits.
  bool contains(PixelSize size) const;
  /// "WIDTHxHEIGHT, at most 8192 px a side and 64 Mpx, such as 1280x720".
  std::string describe() const;
};

/// A range for the number of elements of an array, both ends included.
struct LengthRange {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();

  bool contains(std::size_t length) const { return length >= min && length <= max; }
  /// "an array of 3 numbers", where `elements` is "numbers".
  std::string describe(std::string_view elements) const;
};

}  // namespace pleinair::config

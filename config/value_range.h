#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace pleinair::config {

/// Which finite numbers are allowed, in which unit. `unit` refers to text that outlives the range
/// (a literal); it is for messages: "metres".
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool minOpen = false;  ///< `min` itself is not allowed
  bool maxOpen = false;
  std::string_view unit = {};

  /// False for NaN and infinities too.
  bool contains(double value) const;
  /// "a number of metres in (0, 10]", or with `plural` "numbers of metres in (0, 10]".
  std::string describe(bool plural = false) const;
};

/// Which whole numbers are allowed, both ends included.
struct IntegerRange {
  int min = std::numeric_limits<int>::min();
  int max = std::numeric_limits<int>::max();
  std::string_view unit = {};

  bool contains(long long value) const { return value >= min && value <= max; }
  /// "a whole number of pixels in [1, 64]".
  std::string describe() const;
};

/// A size in pixels; 0x0 where there is none.
struct PixelSize {
  int width = 0;
  int height = 0;
  bool operator==(const PixelSize&) const = default;
};

/// Which sizes are allowed.
struct SizeRange {
  int maxSide = 65535;
  long long maxPixels = std::numeric_limits<long long>::max();

  /// Of at least 1x1.
  bool contains(PixelSize size) const;
  /// "WIDTHxHEIGHT, at most 8192 px a side and 64 Mpx, such as 1280x720".
  std::string describe() const;
};

/// How many elements an array may have, both ends included.
struct LengthRange {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();

  bool contains(std::size_t length) const { return length >= min && length <= max; }
  /// "an array of 3 numbers", where `elements` is "numbers".
  std::string describe(std::string_view elements) const;
};

}  // namespace pleinair::config

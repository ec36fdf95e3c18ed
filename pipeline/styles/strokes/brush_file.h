#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/error.h"

namespace pleinair::styles {

/// A brush's marks as a picture file has them: `variants` of them, 1 or 4, below each other, each
/// `across` texels high and four times as wide; two bytes a texel: how much paint is there, and how
/// high it lies. Strokes go from left to right.
struct BrushMarks {
  int across = 0;
  int variants = 0;
  std::vector<std::uint8_t> texels;
};

/// A PNG file's marks: its red is paint, its green height, which in a grey picture are the same;
/// what is transparent has neither. Four times as wide as high: one mark; square: four. Errors:
/// kNotFound, kPermissionDenied, kIo, kInvalidInput (no PNG, broken, of another shape or size, or
/// hardly any paint in it, so that no stroke would be seen).
hal::Result<BrushMarks> readBrushFile(const std::filesystem::path& path);

/// The same marks with as many texels across as are asked for, each the mean of those it covers;
/// no more than there are.
BrushMarks reducedTo(const BrushMarks& marks, int across);

inline constexpr int kMinBrushWidth = 32;  ///< px of the file
inline constexpr int kMaxBrushWidth = 1024;

}  // namespace pleinair::styles

#include "pipeline/scene/light/tag_paper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace pleinair::scene {
namespace {

constexpr double kMinCellPx = 1.8;  // width of a border; narrower ones mix with their neighbours
constexpr double kCleanCellPx = 4.0;
constexpr int kAlongSide = 12;
constexpr std::size_t kReadings = std::size_t{4} * kAlongSide;
constexpr double kMinShare = 2.0 / 3.0;  // part of a ring's readings

/// The homography of the square −1 … 1 (x right, y down) to the image: Heckbert, "Fundamentals of
/// Texture Mapping and Image Warping" (1989), §2.2.3, for a square around the origin.
glm::dmat3 pictureFromSquare(const tracking::TagCornersPx& corners) {
  const glm::dvec2 topLeft = corners[3], topRight = corners[2];
  const glm::dvec2 bottomRight = corners[1], bottomLeft = corners[0];
  const glm::dvec2 right = topRight - bottomRight;
  const glm::dvec2 below = bottomLeft - bottomRight;
  const glm::dvec2 rest = topLeft - topRight + bottomRight - bottomLeft;
  const double area = right.x * below.y - below.x * right.y;
  const double g = (rest.x * below.y - below.x * rest.y) / area;
  const double h = (right.x * rest.y - rest.x * right.y) / area;
  const glm::dmat3 fromUnit(glm::dvec3(topRight - topLeft + g * topRight, g),
                            glm::dvec3(bottomLeft - topLeft + h * bottomLeft, h),
                            glm::dvec3(topLeft, 1.0));
  const glm::dmat3 unitFromSquare(0.5, 0.0, 0.0, 0.0, 0.5, 0.0, 0.5, 0.5, 1.0);
  return fromUnit * unitFromSquare;
}

struct Readings {
  std::array<glm::vec3, kReadings> values{};
  std::size_t count = 0;

  void add(const glm::vec3& value) { values[count++] = value; }
};

/// The pairs of a tag's borders that are wide enough in the image to be read; a tag seen from the
/// side has two.
struct Borders {
  std::array<bool, 2> isRead{};  // below and above; right and left
  double cellPx = 0.0;           // of the narrower pair that is read

  std::size_t readings() const {
    return std::size_t{2} * kAlongSide * (std::size_t{isRead[0]} + isRead[1]);
  }
};

Borders widthOfBorders(const tracking::TagCornersPx& corners, int cells) {
  const auto sidePx = [&](std::size_t from, std::size_t to) {
    return glm::distance(corners[from], corners[to]);
  };
  const std::array<double, 2> cellPx{std::min(sidePx(1, 2), sidePx(3, 0)) / cells,
                                     std::min(sidePx(0, 1), sidePx(2, 3)) / cells};
  Borders borders;
  for (std::size_t pair = 0; pair < 2; ++pair) {
    if (!(cellPx[pair] >= kMinCellPx)) continue;
    borders.isRead[pair] = true;
    borders.cellPx = borders.cellPx > 0.0 ? std::min(borders.cellPx, cellPx[pair]) : cellPx[pair];
  }
  return borders;
}

/// Reads along a square ring at `reach` from the tag's centre; skips pixels outside of the image.
Readings readRing(const LinearImage& picture, const glm::dmat3& pictureFromTag, double reach,
                  const Borders& borders) {
  Readings readings;
  for (int side = 0; side < 4; ++side) {
    if (!borders.isRead.at(static_cast<std::size_t>(side % 2))) continue;
    for (int i = 0; i < kAlongSide; ++i) {
      const double along = 0.85 * (2.0 * i / (kAlongSide - 1) - 1.0);
      const double across = side < 2 ? reach : -reach;
      const glm::dvec3 at = pictureFromTag * (side % 2 == 0 ? glm::dvec3(along, across, 1.0)
                                                            : glm::dvec3(across, along, 1.0));
      if (!(at.z > 0.0)) continue;
      const double x = std::floor(at.x / at.z), y = std::floor(at.y / at.z);
      if (!(x >= 0.0 && y >= 0.0 && x < picture.size().width && y < picture.size().height)) {
        continue;
      }
      readings.add(picture.at(static_cast<int>(x), static_cast<int>(y)));
    }
  }
  return readings;
}

/// Mean of the middle half by luminance, and its relative spread.
struct MiddleHalf {
  glm::vec3 mean{0.0F};
  float spread = 0.0F;
};

MiddleHalf middleHalf(Readings& readings) {
  const std::span<glm::vec3> values(readings.values.data(), readings.count);
  std::ranges::sort(values, {}, luminanceOf);
  const std::span<glm::vec3> middle =
      values.subspan(values.size() / 4, values.size() - 2 * (values.size() / 4));
  MiddleHalf result;
  for (const glm::vec3& value : middle) result.mean += value;
  result.mean /= static_cast<float>(middle.size());
  const float range = luminanceOf(middle.back()) - luminanceOf(middle.front());
  result.spread = range / std::max(luminanceOf(result.mean), 1e-4F);
  return result;
}

}  // namespace

std::optional<int> cellsAlongEdge(std::string_view family) {
  if (family == "tag36h11" || family == "tag36h10") return 8;
  if (family == "tag25h9") return 7;
  if (family == "tag16h5") return 6;
  return std::nullopt;
}

std::optional<TagPaper> readTagPaper(const LinearImage& picture,
                                     const tracking::TagCornersPx& corners, int cells) {
  const Borders borders = widthOfBorders(corners, cells);
  const auto minReadings =
      static_cast<std::size_t>(kMinShare * static_cast<double>(borders.readings()));
  if (minReadings == 0) return std::nullopt;
  const glm::dmat3 pictureFromTag = pictureFromSquare(corners);
  const double halfCell = 1.0 / cells;  // the square's half side is 1
  Readings onPaper = readRing(picture, pictureFromTag, 1.0 + halfCell, borders);
  Readings onInk = readRing(picture, pictureFromTag, 1.0 - halfCell, borders);
  if (onPaper.count < minReadings || onInk.count < minReadings) return std::nullopt;
  const MiddleHalf paper = middleHalf(onPaper);
  const MiddleHalf ink = middleHalf(onInk);
  const float white = luminanceOf(paper.mean);
  const float black = luminanceOf(ink.mean);
  constexpr float kMinWhite = 0.01F;
  constexpr float kMaxBlack = 0.45F;  // relative to white; glossy ink and haze raise it
  constexpr float kMaxSpread = 0.8F;
  if (white < kMinWhite || black > kMaxBlack * white || paper.spread > kMaxSpread) {
    return std::nullopt;
  }
  const double clean = std::clamp(borders.cellPx / kCleanCellPx, 0.0, 1.0);
  const float even = 1.0F - paper.spread / kMaxSpread;
  constexpr float kMinChannel = 1e-3F;  // per channel: coloured light may lack one
  return TagPaper{.white = glm::max(paper.mean, kMinChannel),
                  .black = ink.mean,
                  .confidence = std::max(static_cast<float>(clean) * even, 0.05F)};
}

}  // namespace pleinair::scene

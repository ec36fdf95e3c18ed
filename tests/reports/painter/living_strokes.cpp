#include "tests/reports/painter/living_strokes.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/measured_input.h"
#include "tests/reports/painter/reported_painting.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{640, 480};
constexpr glm::vec2 kPan{-1.5F, -0.5F};
constexpr int kFirst = 60;
constexpr int kApart = 10;
constexpr std::size_t kShown = 3;
constexpr std::size_t kCircles = 12;
const cv::Rect kPart(200, 140, 320, 240);  // of the first frame
constexpr int kMagnified = 2;

struct Painted {
  cv::Mat3b picture;                           // RGB
  std::map<std::uint32_t, glm::vec2> strokes;  // by their anchors' seeds
};

/// The visible strokes of all layers.
std::map<std::uint32_t, glm::vec2> seenOf(const ReportedPainting& painting) {
  std::map<std::uint32_t, glm::vec2> seen;
  for (std::size_t layer = 0; layer < painting.layerCount(); ++layer) {
    const std::vector<marks::Anchor> anchors = painting.anchors(layer);
    const std::vector<marks::StrokeSlot> strokes = painting.strokes(layer);
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      if (anchors[i].isStaying() && strokes[i].seen > 0.9F) {
        seen.emplace(anchors[i].seed, anchors[i].px);
      }
    }
  }
  return seen;
}

std::vector<Painted> paint(const gpu::ShaderLibrary& library,
                           const std::filesystem::path& photograph, const char* coherence) {
  ReportedPainting painting(library);
  painting.set("coherence", coherence);
  constexpr int kFrames = kFirst + kApart * static_cast<int>(kShown - 1) + 1;
  const auto input = hal::orThrow(measure::openPhotograph(
      photograph, {.size = kSize, .motion = {.pan = {kPan.x, kPan.y}}, .frames = kFrames}));
  std::vector<Painted> shown;
  for (int i = 0; i < kFrames; ++i) {
    const hal::CapturedFrame frame = *hal::orThrow(input->next());
    painting.paint(hal::Image(frame.image), glm::dvec2(kPan));
    if (i < kFirst || (i - kFirst) % kApart != 0) continue;
    Painted& kept = shown.emplace_back();
    hal::Image picture = painting.picture();
    cv::Mat3b(kSize.height, kSize.width, reinterpret_cast<cv::Vec3b*>(picture.plane(0).data()))
        .copyTo(kept.picture);
    kept.strokes = seenOf(painting);
  }
  return shown;
}

/// Strokes far from each other, in the part that all frames show.
std::map<std::uint32_t, glm::vec2> chosen(const std::map<std::uint32_t, glm::vec2>& strokes) {
  const glm::vec2 low(static_cast<float>(kPart.x) + 55.0F, static_cast<float>(kPart.y) + 35.0F);
  const glm::vec2 high(static_cast<float>(kPart.br().x) - 20.0F,
                       static_cast<float>(kPart.br().y) - 20.0F);
  std::map<std::uint32_t, glm::vec2> found;
  while (found.size() < kCircles) {
    float farthest = 0.0F;
    std::pair<std::uint32_t, glm::vec2> next;
    for (const auto& [seed, px] : strokes) {
      if (glm::any(glm::lessThan(px, low)) || glm::any(glm::greaterThan(px, high))) continue;
      float nearest = 1e6F;
      for (const auto& [other, at] : found) nearest = std::min(nearest, glm::distance(at, px));
      if (nearest <= farthest) continue;
      farthest = nearest;
      next = {seed, px};
    }
    if (farthest == 0.0F) break;
    found.insert(next);
  }
  return found;
}

cv::Mat3b marked(const Painted& painted, const std::map<std::uint32_t, glm::vec2>& strokes,
                 glm::vec2 moved) {
  cv::Mat3b part;
  cv::resize(painted.picture(kPart), part, {}, kMagnified, kMagnified, cv::INTER_CUBIC);
  const auto placeOf = [](glm::vec2 px) {
    return cv::Point(static_cast<int>(kMagnified * (px.x - static_cast<float>(kPart.x))),
                     static_cast<int>(kMagnified * (px.y - static_cast<float>(kPart.y))));
  };
  for (const auto& [seed, px] : strokes) {
    const auto now = painted.strokes.find(seed);
    for (const auto& [colour, thickness] :
         {std::pair(cv::Scalar(255, 255, 255), 5), {cv::Scalar(200, 0, 40), 2}}) {
      if (now != painted.strokes.end()) {
        cv::circle(part, placeOf(now->second), 16, colour, thickness, cv::LINE_AA);
      } else {
        cv::drawMarker(part, placeOf(px + moved), colour, cv::MARKER_TILTED_CROSS, 20, thickness,
                       cv::LINE_AA);
      }
    }
  }
  return part;
}

}  // namespace

hal::Image livingStrokes(const gpu::ShaderLibrary& library,
                         const std::filesystem::path& photograph) {
  std::vector<cv::Mat3b> rows;
  for (const char* coherence : {"0.5", "0"}) {
    const std::vector<Painted> shown = paint(library, photograph, coherence);
    const auto circled = chosen(shown.front().strokes);
    std::vector<cv::Mat3b> parts;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      parts.push_back(marked(shown[i], circled, kPan * static_cast<float>(i * kApart)));
    }
    cv::hconcat(parts, rows.emplace_back());
  }
  cv::Mat3b sheet;
  cv::vconcat(rows, sheet);
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {sheet.cols, sheet.rows}});
  for (int y = 0; y < sheet.rows; ++y) {
    std::copy_n(sheet.ptr<std::uint8_t>(y), image.row(0, y).size(), image.row(0, y).data());
  }
  return image;
}

}  // namespace pleinair

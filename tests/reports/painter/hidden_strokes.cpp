#include "tests/reports/painter/hidden_strokes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/geometric.hpp>

#include "pipeline/measure/input/picture.h"
#include "tests/oracles/stroke_oracle.h"
#include "tests/reports/painter/reported_painting.h"

namespace pleinair {
namespace {

constexpr std::uint64_t kFrames = 60;
constexpr int kSamples = 24;  // on a spline
constexpr double kNoiseLevels = 2.0;
constexpr float kInner = 0.6F;  // of a stroke's width: inside it, no brush has visible gaps
constexpr float kOpaque = 0.75F;

/// Paints a static image under changing noise.
void paintAtRest(ReportedPainting& painting, const hal::Image& picture) {
  const cv::Mat3f exact = measure::toFloat(picture.view());
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    painting.paint(measure::withSensorNoise(exact, kNoiseLevels, i), {0.0, 0.0});
  }
}

struct Drawn {
  std::vector<glm::vec2> spine;
  float halfWidth;
  bool isOpaque;
  std::size_t layer;
};

std::vector<Drawn> inOrder(const ReportedPainting& painting) {
  std::vector<Drawn> drawn;
  for (std::size_t layer = 0; layer < painting.layerCount(); ++layer) {
    for (const marks::StrokeInstance& each : painting.instances(layer)) {
      const std::vector<glm::dvec2> points(each.points.begin(), each.points.end());
      Drawn stroke{.spine = {},
                   .halfWidth = each.halfWidth,
                   .isOpaque = each.paint.a >= kOpaque,
                   .layer = layer};
      for (int i = 0; i <= kSamples; ++i) {
        stroke.spine.emplace_back(oracles::splinePlace(points, 9.0 * i / kSamples));
      }
      drawn.push_back(std::move(stroke));
    }
  }
  return drawn;
}

/// Calls `each(index of the pixel)` for the pixels within `reach` of the stroke's spine until it
/// returns false. Returns whether it never did.
template <class Each>
bool overPixels(const Drawn& stroke, float reach, hal::FrameSize size, const Each& each) {
  glm::vec2 low = stroke.spine.front();
  glm::vec2 high = low;
  for (const glm::vec2 at : stroke.spine) {
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  const glm::ivec2 last(size.width - 1, size.height - 1);
  const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low - reach)), glm::ivec2(0), last);
  const glm::ivec2 end = glm::clamp(glm::ivec2(glm::ceil(high + reach)), glm::ivec2(0), last);
  for (int y = first.y; y <= end.y; ++y) {
    for (int x = first.x; x <= end.x; ++x) {
      const glm::vec2 px(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      const auto isNear = [&](glm::vec2 at) { return glm::distance(at, px) <= reach; };
      if (std::ranges::none_of(stroke.spine, isNear)) continue;
      if (!each(static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                static_cast<std::size_t>(x))) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

std::vector<LayerUse> strokesInUse(const gpu::ShaderLibrary& library, const hal::Image& picture) {
  ReportedPainting painting(library);
  paintAtRest(painting, picture);
  const std::vector<Drawn> drawn = inOrder(painting);
  std::vector<std::size_t> lastOver(static_cast<std::size_t>(picture.size().pixels()), 0);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (!drawn[i].isOpaque) continue;
    overPixels(drawn[i], kInner * drawn[i].halfWidth, picture.size(), [&](std::size_t at) {
      lastOver[at] = i;
      return true;
    });
  }
  std::vector<LayerUse> layers(painting.layerCount());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    LayerUse& layer = layers[drawn[i].layer];
    ++layer.strokes;
    const bool isHidden = overPixels(drawn[i], drawn[i].halfWidth, picture.size(),
                                     [&](std::size_t at) { return lastOver[at] > i; });
    layer.hidden += isHidden ? 1 : 0;
  }
  return layers;
}

}  // namespace pleinair

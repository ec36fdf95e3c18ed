#include "tests/reports/painter/field_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "pipeline/marks/tensor_field.h"
#include "tests/oracles/tensor_oracle.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

constexpr int kRegionPixels = 8;
constexpr int kRuns = 20;

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

FieldComparison compareField(const gpu::ShaderLibrary& library, const hal::Image& image,
                             double sigmaPx) {
  FieldComparison found;
  const gpu::Texture picture = support::textureOf(image.view());
  MotionField motion(library, image.size());
  TensorField field(library, image.size());
  scene::ArFrame frame{.colour = &picture};
  motion.update(frame);
  const TensorFieldOptions options{.memory = hal::Duration(0)};
  field.update(frame, picture, motion, options);  // the first one warms up
  glFinish();
  const Stopwatch pyramid;
  for (int i = 0; i < kRuns; ++i) field.update(frame, picture, motion, options);
  glFinish();
  found.pyramidMs = pyramid.ms() / kRuns;

  const oracles::TensorImage gradients = oracles::gradientTensors(image.view());
  // The thesis's threshold, from the robust maximum of P.
  const double threshold = oracles::edgePercentile(gradients, 0.995) / 3.0;
  const Stopwatch oracle;
  const oracles::TensorGrid grid =
      oracles::tensorRegions(gradients, kRegionPixels, threshold, oracles::Decision::kThesis);
  const auto levels = oracles::tensorPyramid(grid, 1.0, oracles::Decision::kThesis);
  found.oracleMs = oracle.ms();

  const std::vector<float> resolved = support::readRgba32f(field.resolved(0));
  found.regions = field.resolved(0).size();
  for (const glm::dvec2& each : gradients.tensors) {
    found.edgePixels += glm::length(each) >= threshold ? 1U : 0U;
  }
  const Stopwatch global;
  std::vector<glm::dvec2> baseline;
  for (int y = 0; y < found.regions.height; ++y) {
    for (int x = 0; x < found.regions.width; ++x) {
      baseline.push_back(
          oracles::radialBasisTensor(gradients, threshold, sigmaPx, oracles::RadialBasis::kEq12,
                                     (glm::dvec2(x, y) + 0.5) * double{kRegionPixels}));
    }
  }
  found.globalMs = global.ms();
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    found.apartRad.push_back(
        oracles::angleBetween(baseline[i], {resolved[4 * i], resolved[4 * i + 1]}));
    found.hasEdges.push_back(grid.regions[i].known > 0.0);
  }
  return found;
}

hal::Image errorMap(const FieldComparison& comparison, const hal::Image& image) {
  hal::Image map({.pixelFormat = hal::PixelFormat::kRgb8, .size = image.size()});
  for (int y = 0; y < map.size().height; ++y) {
    const auto from = image.view().row(0, y);
    const auto to = map.row(0, y);
    for (int x = 0; x < map.size().width; ++x) {
      const int region = y / kRegionPixels * comparison.regions.width + x / kRegionPixels;
      const double error = std::min(
          1.0, comparison.apartRad[static_cast<std::size_t>(region)] / (std::numbers::pi / 4.0));
      const auto at = static_cast<std::size_t>(3 * x);
      const double grey =
          150.0 + (0.299 * from[at] + 0.587 * from[at + 1] + 0.114 * from[at + 2]) * 105.0 / 255.0;
      to[at] = static_cast<std::uint8_t>(grey * (1.0 - error) + 220.0 * error);
      to[at + 1] = static_cast<std::uint8_t>(grey * (1.0 - error) + 20.0 * error);
      to[at + 2] = static_cast<std::uint8_t>(grey * (1.0 - error) + 20.0 * error);
    }
  }
  return map;
}

}  // namespace pleinair::marks

#include "firmware_app/thesis/field_comparison.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <glm/geometric.hpp>

#include "pipeline/gpu/render_target.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/measure/baselines/edge_tensors.h"

namespace pleinair::app {
namespace {

constexpr int kRegionPixels = 8;
constexpr double kHole = 1e-3;

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

gpu::Texture textureOf(const hal::Image& rgb) {
  const hal::FrameSize size = rgb.size();
  std::vector<std::uint8_t> rgba;
  rgba.reserve(static_cast<std::size_t>(size.pixels()) * 4);
  for (int y = 0; y < size.height; ++y) {
    const hal::ImageView view = rgb.view();
    const auto row = view.row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      rgba.insert(rgba.end(), {row[i], row[i + 1], row[i + 2], std::uint8_t{255}});
    }
  }
  gpu::Texture texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  texture.upload(rgba, static_cast<std::size_t>(size.width) * 4);
  return texture;
}

/// The tensors of a level: the first two of four floats a region.
std::vector<glm::dvec2> readTensors(const gpu::Texture& texture) {
  const hal::FrameSize size = texture.size();
  std::vector<float> values(static_cast<std::size_t>(size.pixels()) * 4);
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT);  // compute passes wrote it
  const gpu::RenderTarget target({&texture});
  target.beginKeeping();
  glReadPixels(0, 0, size.width, size.height, GL_RGBA, GL_FLOAT, values.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  std::vector<glm::dvec2> tensors;
  for (std::size_t i = 0; i < values.size(); i += 4) tensors.emplace_back(values[i], values[i + 1]);
  return tensors;
}

std::vector<bool> regionsWithEdges(const measure::TensorImage& gradients, double threshold,
                                   std::size_t& edgePixels) {
  const hal::FrameSize regions = measure::regionsOf(gradients.size, kRegionPixels);
  std::vector<bool> has(static_cast<std::size_t>(regions.pixels()));
  for (std::size_t i = 0; i < gradients.tensors.size(); ++i) {
    if (glm::length(gradients.tensors[i]) < threshold) continue;
    ++edgePixels;
    const int x = static_cast<int>(i) % gradients.size.width / kRegionPixels;
    const int y = static_cast<int>(i) / gradients.size.width / kRegionPixels;
    has[static_cast<std::size_t>(y * regions.width + x)] = true;
  }
  return has;
}

double holesOf(const std::vector<glm::dvec2>& tensors) {
  double longest = 0.0;
  for (const glm::dvec2& each : tensors) longest = std::max(longest, glm::length(each));
  const auto holes = std::ranges::count_if(
      tensors, [&](const glm::dvec2& each) { return glm::length(each) < kHole * longest; });
  return 100.0 * static_cast<double>(holes) / static_cast<double>(tensors.size());
}

}  // namespace

FieldComparison compareField(const gpu::ShaderLibrary& library, const hal::Image& image,
                             double sigmaPx, int runs) {
  FieldComparison found;
  const gpu::Texture picture = textureOf(image);
  marks::MotionField motion(library, image.size());
  marks::TensorField field(library, image.size());
  scene::ArFrame frame{.colour = &picture};
  motion.update(frame);
  const marks::TensorFieldOptions options{.memory = hal::Duration(0)};
  field.update(frame, picture, motion, options);  // the first one warms up
  glFinish();
  const Stopwatch pyramid;
  for (int i = 0; i < runs; ++i) field.update(frame, picture, motion, options);
  glFinish();
  found.pyramidMs = pyramid.ms() / runs;

  const measure::TensorImage gradients = measure::colourTensors(image.view());
  // The thesis's threshold, from the robust maximum of P; limited as the field's.
  const double threshold =
      std::min(measure::edgePercentile(gradients, 0.995) / 3.0, marks::kMaxLeading);
  found.hasEdges = regionsWithEdges(gradients, threshold, found.edgePixels);
  found.regions = field.resolved(0).size();
  const std::vector<glm::dvec2> ours = readTensors(field.resolved(0));
  const std::vector<glm::dvec2> middles = measure::regionMiddles(image.size(), kRegionPixels);
  const Stopwatch global;
  const std::vector<glm::dvec2> baseline = measure::radialBasisTensors(
      gradients, threshold, sigmaPx, measure::RadialBasis::kEq12, middles);
  found.globalMs = global.ms();
  found.holesPercent = holesOf(measure::radialBasisTensors(gradients, threshold, sigmaPx,
                                                           measure::RadialBasis::kEq11, middles));
  const Stopwatch means;
  const std::vector<glm::dvec2> pyramidOfMeans =
      measure::meanPyramidTensors(gradients, kRegionPixels, threshold);
  found.meansMs = means.ms();
  for (std::size_t i = 0; i < std::min(baseline.size(), ours.size()); ++i) {
    found.apartRad.push_back(measure::angleBetween(baseline[i], ours[i]));
    found.meansApartRad.push_back(measure::angleBetween(baseline[i], pyramidOfMeans[i]));
  }
  return found;
}

double degreesAt(const FieldComparison& comparison, const std::vector<double>& apartRad, bool own,
                 double part) {
  std::vector<double> chosen;
  for (std::size_t i = 0; i < apartRad.size(); ++i) {
    if (comparison.hasEdges[i] == own) chosen.push_back(apartRad[i]);
  }
  if (chosen.empty()) return 0.0;
  std::ranges::sort(chosen);
  const auto last = static_cast<double>(chosen.size() - 1);
  return chosen[static_cast<std::size_t>(part * last)] * 180.0 / std::numbers::pi;
}

hal::Image errorMap(const FieldComparison& comparison, const hal::Image& image) {
  hal::Image map({.pixelFormat = hal::PixelFormat::kRgb8, .size = image.size()});
  const hal::ImageView view = image.view();
  for (int y = 0; y < map.size().height; ++y) {
    const auto from = view.row(0, y);
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

}  // namespace pleinair::app

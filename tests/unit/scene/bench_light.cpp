#include "tests/unit/scene/bench_light.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/world/light.h"
#include "hal/cameras/synthetic/world/workbench.h"
#include "pipeline/scene/light/light_fit.h"

namespace pleinair::scene {
namespace {

using hal::synthetic::Patch;
using hal::synthetic::Plan;
using hal::synthetic::PointAndNormal;
using hal::synthetic::RoomLight;

struct Room {
  Plan plan = hal::synthetic::planWorkbench(1);
  std::vector<glm::vec3> colours{plan.patches.size(), glm::vec3(0.3F)};
  RoomLight light{plan.occluders, colours};
};

glm::dvec3 on(const RoomLight& light, const glm::dvec3& point, const glm::dvec3& normal) {
  Patch patch;
  patch.half = glm::vec2(0.001F);
  patch.at = [&](glm::vec2) { return PointAndNormal{point, normal}; };
  const RoomLight::Lattice lattice = light.on(patch);
  glm::dvec3 sum(0.0);
  for (const glm::vec3& each : lattice.linearRgb) sum += glm::dvec3(each);
  return sum / static_cast<double>(lattice.linearRgb.size());
}

double luminance(const glm::dvec3& rgb) {
  return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

}  // namespace

glm::dvec3 benchIrradiance(const glm::dvec3& point, const glm::dvec3& normal) {
  static const Room room;
  return on(room.light, point, normal);
}

BenchLight benchLightAt(const glm::dvec3& point, const glm::dvec3& up) {
  std::vector<LightSample> samples;
  std::vector<glm::dvec3> colours;
  constexpr int kNormals = 400;
  for (int i = 0; i < kNormals; ++i) {  // a Fibonacci sphere
    const double z = 1.0 - (2.0 * i + 1.0) / kNormals;
    const double angle = 2.399963229728653 * i;
    const double r = std::sqrt(1.0 - z * z);
    const glm::dvec3 normal(r * std::cos(angle), r * std::sin(angle), z);
    if (glm::dot(normal, up) < 0.0) continue;
    colours.push_back(benchIrradiance(point, normal));
    samples.push_back({.normal = normal, .irradiance = luminance(colours.back())});
  }
  // A prior this wide has no effect.
  const LightFit fit =
      fitLight(samples, {.ambient = 0.3, .keyVector = 0.5 * up}, {.ambient = 100.0, .key = 100.0});
  BenchLight bench;
  bench.towardKey = glm::normalize(fit.keyVector);
  glm::dvec3 crossed(0.0), sum(0.0);
  double squares = 0.0, lits = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double lit = std::max(0.0, glm::dot(samples[i].normal, bench.towardKey));
    crossed += lit * colours[i];
    sum += colours[i];
    squares += lit * lit;
    lits += lit;
  }
  const auto n = static_cast<double>(samples.size());
  bench.key = (n * crossed - lits * sum) / (n * squares - lits * lits);
  bench.ambient = (sum - lits * bench.key) / n;
  bench.onPlane = benchIrradiance(point, up);
  return bench;
}

}  // namespace pleinair::scene

#include "pipeline/scene/scene_light.h"

#include <array>
#include <string_view>

#include <glm/geometric.hpp>

#include "pipeline/scene/linear_picture.h"
#include "pipeline/scene/scene_values.h"

namespace pleinair::scene {
namespace {

using config::TomlTable;

void readDirection(const TomlTable& table, Light& light) {
  const auto direction = table.optionalVector<3>("direction", {.min = -1e6, .max = 1e6});
  if (!direction) return;
  const glm::dvec3 toward((*direction)[0], (*direction)[1], (*direction)[2]);
  if (!(glm::length(toward) > 1e-6)) {
    throw table.error("direction", "has no length", "a vector towards the light");
  }
  light.towardLight = glm::normalize(toward);
  light.hasDirection = true;
}

std::optional<glm::vec3> readLinearColour(const TomlTable& table, std::string_view key,
                                          const Light& light) {
  const auto srgb = readColour(table, key);
  if (!srgb) return std::nullopt;
  if (light.isEstimated) {
    throw table.error(key, "found one, but the light is estimated", "one with mode = \"fixed\"");
  }
  return linearFromSrgb(*srgb);
}

}  // namespace

Light readLight(const TomlTable& table) {
  static constexpr std::array<config::Choice<Light::Frame>, 2> kFrames{
      {{"camera", Light::Frame::kCamera}, {"attached", Light::Frame::kAttached}}};
  static constexpr std::array<config::Choice<bool>, 2> kModes{
      {{"estimated", true}, {"fixed", false}}};
  Light light;
  light.isEstimated = table.optionalChoice("mode", kModes).value_or(light.isEstimated);
  light.frame = table.optionalChoice("frame", kFrames).value_or(light.frame);
  readDirection(table, light);
  light.key = readLinearColour(table, "key", light);
  light.ambient = readLinearColour(table, "ambient", light);
  light.shadow = static_cast<float>(
      table.optionalNumber("shadow", {.min = 0.0, .max = 1.0}).value_or(double{light.shadow}));
  return light;
}

}  // namespace pleinair::scene

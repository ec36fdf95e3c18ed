#include "pipeline/scene/description/scene_tables.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>

#include "config/suggestion.h"
#include "pipeline/scene/description/scene_values.h"
#include "pipeline/scene/models/linear_light.h"

namespace pleinair::scene {

std::optional<int> readAttachment(const config::TomlTable& table, const Scene& scene) {
  const std::string text = table.string("attach");
  const bool hasWorld = std::ranges::any_of(
      scene.tags, [](const tracking::TagMarker& tag) { return tag.worldFromTag.has_value(); });
  if (text == "world") {
    if (hasWorld) return std::nullopt;
    throw table.error("attach", "no tag locates the world",
                      "\"world\" once a [[tag]] has a position_m");
  }
  for (const tracking::TagMarker& tag : scene.tags) {
    if (text == fmt::format("tag:{}", tag.id)) return tag.id;
  }
  std::vector<std::string> places;
  if (hasWorld) places.emplace_back("\"world\"");
  for (const tracking::TagMarker& tag : scene.tags)
    places.push_back(fmt::format("\"tag:{}\"", tag.id));
  throw table.error("attach", "found " + config::quoted(text),
                    places.empty() ? "the scene's tags, but it has no [[tag]]"
                                   : fmt::format("{}", fmt::join(places, ", ")));
}

namespace {

using config::TomlTable;

ScenePlane readPlane(const TomlTable& table, Scene& scene) {
  ScenePlane plane;
  plane.name =
      table.optionalString("name").value_or(fmt::format("plane {}", scene.planes.size() + 1));
  if (std::ranges::find(scene.planes, plane.name, &ScenePlane::name) != scene.planes.end()) {
    throw table.error("name", config::quoted(plane.name) + " is used by an earlier plane",
                      "unique names");
  }
  plane.tagId = readAttachment(table, scene);
  plane.attachFromPlane = readPose(table).value_or(glm::dmat4(1.0));
  refuseOtherUnits(table, "size_m");
  const auto size =
      table.vector<2>("size_m", {.min = 0.0, .max = 1000.0, .minOpen = true, .unit = "metres"});
  plane.sizeMetres = {size[0], size[1]};
  constexpr double kHugeMetres = 20.0;
  if (std::max(size[0], size[1]) > kHugeMetres) {
    scene.notices.push_back(fmt::format("{}: is {:g} x {:g} metres; size_m is in metres",
                                        plane.name, size[0], size[1]));
  }
  return plane;
}

}  // namespace

void readPlanes(const TomlTable& root, Scene& scene) {
  const std::vector<TomlTable> tables = root.tables("plane");
  if (tables.size() > kMaxPlanes) {
    throw root.error("plane", fmt::format("found {} planes", tables.size()),
                     fmt::format("at most {}", kMaxPlanes));
  }
  for (const TomlTable& table : tables) scene.planes.push_back(readPlane(table, scene));
}

namespace {

constexpr double kMaxFocusMetres = 1000.0;

SceneFocus readFocus(const TomlTable& table, const Scene& scene) {
  const config::NumberRange length{
      .min = 0.0, .max = kMaxFocusMetres, .minOpen = true, .unit = "metres"};
  SceneFocus focus;
  focus.tagId = readAttachment(table, scene);
  for (const char* key : {"position_m", "radius_m", "falloff_m"}) refuseOtherUnits(table, key);
  const auto centre = table.optionalVector<3>(
      "position_m", {.min = -kMaxFocusMetres, .max = kMaxFocusMetres, .unit = "metres"});
  if (centre) focus.attachFromCentre = {(*centre)[0], (*centre)[1], (*centre)[2]};
  focus.radiusMetres = table.number("radius_m", length);
  focus.falloffMetres = table.optionalNumber("falloff_m", length).value_or(focus.radiusMetres);
  focus.strength =
      table.optionalNumber("strength", {.min = 0.0, .max = 1.0}).value_or(focus.strength);
  return focus;
}

}  // namespace

void readFoci(const TomlTable& root, Scene& scene) {
  const std::vector<TomlTable> tables = root.tables("focus");
  if (tables.size() > kMaxFoci) {
    throw root.error("focus", fmt::format("found {} foci", tables.size()),
                     fmt::format("at most {}", kMaxFoci));
  }
  for (const TomlTable& table : tables) scene.foci.push_back(readFocus(table, scene));
}

namespace {

std::vector<std::string> namesOf(const Rig& rig) {
  std::vector<std::string> names;
  for (const Clip& clip : rig.clips) names.push_back(clip.name);
  return names;
}

std::optional<std::size_t> readClip(const config::TomlTable& table, const Rig& rig) {
  const auto name = table.optionalString("clip");
  if (!name) return rig.clips.size() == 1 ? std::optional<std::size_t>(0) : std::nullopt;
  const std::vector<std::string> names = namesOf(rig);
  const auto found = std::ranges::find(names, *name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  throw table.error(
      "clip", "found " + config::foundText(*name, names),
      names.empty() ? "a model with animations; this one has none" : config::listText(names));
}

}  // namespace

Playback readPlayback(const config::TomlTable& table, const Rig& rig) {
  static constexpr std::array<config::Choice<bool>, 2> kStarts{
      {{"at_once", false}, {"on_sight", true}}};
  Playback playback{.clip = readClip(table, rig)};
  playback.speed =
      table.optionalNumber("speed", {.min = -100.0, .max = 100.0}).value_or(playback.speed);
  playback.loops = table.optionalBoolean("loop").value_or(playback.loops);
  playback.startsOnSight = table.optionalChoice("start", kStarts).value_or(playback.startsOnSight);
  if (playback.clip) return playback;
  for (const char* key : {"speed", "loop", "start"}) {
    if (!table.has(key)) continue;
    throw table.error(key, "applies to a clip, but none is played",
                      rig.clips.empty() ? "a model with animations; this one has none"
                                        : "clip as one of " + config::listText(namesOf(rig)));
  }
  return playback;
}

StrokeDirection readStrokeDirection(const config::TomlTable& table, const Model& model,
                                    bool isOccluder) {
  using Source = StrokeDirection::Source;
  static constexpr std::string_view kKey = "stroke_direction";
  static constexpr std::array<config::Choice<Source>, 3> kSources{
      {{"curvature", Source::kCurvature},
       {"tangents", Source::kTangents},
       {"picture", Source::kPicture}}};
  if (!table.has(kKey)) return {};
  if (isOccluder) {
    throw table.error(kKey, "has no effect on an occluder, which is not painted",
                      "a model without occluder = true");
  }
  if (!table.isString(kKey)) {
    const auto axis = table.vector<3>(kKey, {.min = -1e6, .max = 1e6});
    const glm::dvec3 along(axis[0], axis[1], axis[2]);
    if (!(glm::length(along) > 1e-6)) {
      throw table.error(kKey, "has no length", "a direction in the model's axes");
    }
    return {.source = Source::kAxis, .axis = glm::vec3(glm::normalize(along))};
  }
  const std::string name = table.string(kKey);
  const auto found = std::ranges::find(kSources, name, &config::Choice<Source>::name);
  if (found == kSources.end()) {
    const std::vector<std::string> names = config::namesOf(kSources);
    throw table.error(kKey, "found " + config::foundText(name, names),
                      config::listText(names) + ", or a direction [x, y, z]");
  }
  const bool hasTangents = std::ranges::any_of(
      model.surfaces, [](const Surface& surface) { return !surface.mesh.tangents.empty(); });
  if (found->value == Source::kTangents && !hasTangents) {
    throw table.error(kKey, "the model has no tangents", "a glTF file with the attribute TANGENT");
  }
  return {.source = found->value};
}

std::optional<std::string> unplayedClipsNotice(const Rig& rig, const Playback& playback) {
  if (playback.clip || rig.clips.empty()) return std::nullopt;
  return fmt::format("stands at rest; clip = \"NAME\" plays one of its animations: {}",
                     config::listText(namesOf(rig)));
}

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

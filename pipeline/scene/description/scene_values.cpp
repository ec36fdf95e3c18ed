#include "pipeline/scene/description/scene_values.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "pipeline/scene/meshes/mesh_file.h"

namespace pleinair::scene {
namespace {

constexpr config::NumberRange kLength{.min = 0.0, .max = 1000.0, .minOpen = true, .unit = "metres"};
constexpr config::NumberRange kCoordinate{.min = -1000.0, .max = 1000.0, .unit = "metres"};
constexpr config::NumberRange kAngle{.min = -360.0, .max = 360.0, .unit = "degrees"};

glm::dvec3 vectorOf(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

GearSource readGear(const config::TomlTable& table) {
  GearSource gear;
  gear.form.teeth =
      table.optionalInteger("teeth", {.min = 6, .max = 200}).value_or(gear.form.teeth);
  gear.form.moduleMetres =
      table.optionalNumber("module_m", kLength).value_or(gear.form.moduleMetres);
  gear.form.pressureAngleRad = glm::radians(
      table.optionalNumber("pressure_angle_deg", {.min = 14.5, .max = 25.0, .unit = "degrees"})
          .value_or(glm::degrees(gear.form.pressureAngleRad)));
  gear.thicknessMetres =
      table.optionalNumber("thickness_m", kLength).value_or(gear.thicknessMetres);
  gear.boreDiameterMetres = table.optionalNumber("bore_diameter_m", kLength);
  gear.hubDiameterMetres = table.optionalNumber("hub_diameter_m", kLength);
  gear.holes = table.optionalInteger("holes", {.min = 0, .max = 24});
  if (const auto fault = faultOf(gear)) {
    throw table.error(fault->key, fault->problem, fault->allowed);
  }
  return gear;
}

std::array<int, 2> readStage(const config::TomlTable& table, std::string_view key,
                             const std::array<int, 2>& otherwise) {
  const auto teeth = table.optionalVector<2>(key, {.min = 1.0, .max = 1000.0});
  if (!teeth) return otherwise;
  const std::array<int, 2> stage{static_cast<int>((*teeth)[0]), static_cast<int>((*teeth)[1])};
  const bool areWhole = stage[0] == (*teeth)[0] && stage[1] == (*teeth)[1];
  if (!areWhole || stage[0] < kMinPinionTeeth || stage[0] > kMaxPinionTeeth ||
      stage[1] < kMinWheelTeeth || stage[1] > kMaxWheelTeeth) {
    throw table.error(
        key, fmt::format("found [{}, {}]", (*teeth)[0], (*teeth)[1]),
        fmt::format("teeth of a pinion, {} to {}, and of a wheel, {} to {}", kMinPinionTeeth,
                    kMaxPinionTeeth, kMinWheelTeeth, kMaxWheelTeeth));
  }
  return stage;
}

TubeSource readTube(const config::TomlTable& table) {
  TubeSource tube;
  tube.lengthMetres = table.optionalNumber("length_m", kLength).value_or(tube.lengthMetres);
  return tube;
}

BallSource readBall(const config::TomlTable& table) {
  BallSource ball;
  ball.diameterMetres = table.optionalNumber("diameter_m", kLength).value_or(ball.diameterMetres);
  return ball;
}

GearboxSource readGearbox(const config::TomlTable& table) {
  static constexpr std::array<config::Choice<bool>, 2> kCovers{{{"open", false}, {"closed", true}}};
  GearboxSource gearbox;
  gearbox.lengthMetres = table.optionalNumber("length_m", kLength).value_or(gearbox.lengthMetres);
  gearbox.inputRevolutions =
      table.optionalNumber("speed_rpm", {.min = -600.0, .max = 600.0, .unit = "turns a minute"})
          .value_or(gearbox.inputRevolutions);
  gearbox.stage1 = readStage(table, "stage_1", gearbox.stage1);
  gearbox.stage2 = readStage(table, "stage_2", gearbox.stage2);
  gearbox.isClosed = table.optionalChoice("cover", kCovers).value_or(gearbox.isClosed);
  return gearbox;
}

BoxSource readBox(const config::TomlTable& table) {
  BoxSource box;
  if (const auto size = table.optionalVector<3>("size_m", kLength)) {
    box.sizeMetres = vectorOf(*size);
  }
  return box;
}

glm::vec3 readHexColour(const config::TomlTable& table, std::string_view key) {
  const std::string text = table.string(key);
  std::array<int, 3> bytes{};
  bool isHex = text.size() == 7 && text[0] == '#';
  for (std::size_t i = 0; isHex && i < 3; ++i) {
    const char* first = text.data() + 1 + 2 * i;
    const auto [end, code] = std::from_chars(first, first + 2, bytes[i], 16);
    isHex = code == std::errc{} && end == first + 2 && *first != '-';
  }
  if (!isHex) {
    throw table.error(key, "found " + config::quoted(text),
                      "\"#rrggbb\" or an array of 3 numbers in [0, 1]");
  }
  return glm::vec3(bytes[0], bytes[1], bytes[2]) / 255.0F;
}

bool isModelFile(std::string name) {
  std::ranges::transform(name, name.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  if (name.starts_with("builtin:")) return false;
  return name.ends_with(".glb") || name.ends_with(".gltf") || isMeshFile(name);
}

/// The way to an STL for models in files of CAD programs; else empty.
std::string conversionHint(const std::string& name) {
  static constexpr std::array<std::string_view, 8> kCad{".step",  ".stp",  ".iges",   ".igs",
                                                        ".fcstd", ".brep", ".sldprt", ".ipt"};
  std::string ending = std::filesystem::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (std::ranges::find(kCad, ending) == kCad.end()) return {};
  return "; FreeCAD makes an .stl of it (docs/scene-files.md)";
}

}  // namespace

std::optional<glm::dmat4> readPose(const config::TomlTable& table) {
  refuseOtherUnits(table, "position_m");
  const auto position = table.optionalVector<3>("position_m", kCoordinate);
  const auto rotation = table.optionalVector<3>("rotation_deg", kAngle);
  if (!position && !rotation) return std::nullopt;
  const glm::dvec3 angles = glm::radians(vectorOf(rotation.value_or(std::array{0.0, 0.0, 0.0})));
  glm::dmat4 pose =
      glm::translate(glm::dmat4(1.0), vectorOf(position.value_or(std::array{0.0, 0.0, 0.0})));
  for (int axis = 2; axis >= 0; --axis) {
    glm::dvec3 about(0.0);
    about[axis] = 1.0;
    pose = glm::rotate(pose, angles[axis], about);
  }
  return pose;
}

void refuseOtherUnits(const config::TomlTable& table, std::string_view key) {
  const std::string quantity(key.substr(0, key.size() - 2));
  for (const char* unit : {"_mm", "_cm", "_metres", ""}) {
    const std::string other = quantity + unit;
    if (!table.has(other)) continue;
    throw table.error(other, "is no key: lengths are in metres",
                      fmt::format("{} (60 mm are 0.06)", key));
  }
}

std::optional<glm::vec3> readColour(const config::TomlTable& table, std::string_view key) {
  if (table.isString(key)) return readHexColour(table, key);
  const auto values = table.optionalVector<3>(key, {.min = 0.0, .max = 1.0});
  if (!values) return std::nullopt;
  return glm::vec3(vectorOf(*values));
}

ModelSource readSource(const config::TomlTable& table, const std::filesystem::path& directory) {
  enum class Kind { kBox, kGear, kGearbox, kTube, kBall };
  static constexpr std::array<config::Choice<Kind>, 5> kKinds{{{"builtin:box", Kind::kBox},
                                                               {"builtin:gear", Kind::kGear},
                                                               {"builtin:gearbox", Kind::kGearbox},
                                                               {"builtin:tube", Kind::kTube},
                                                               {"builtin:ball", Kind::kBall}}};
  const std::string name = table.string("source");
  if (isModelFile(name)) return FileSource{directory / name};
  const auto kind = std::ranges::find(kKinds, name, &config::Choice<Kind>::name);
  if (kind == kKinds.end()) {
    throw table.error("source", "found " + config::quoted(name),
                      fmt::format("{}, or a .glb, .gltf, .stl or .obj file{}",
                                  fmt::join(config::namesOf(kKinds), ", "), conversionHint(name)));
  }
  switch (kind->value) {
    case Kind::kBox:
      return readBox(table);
    case Kind::kGear:
      return readGear(table);
    case Kind::kGearbox:
      return readGearbox(table);
    case Kind::kTube:
      return readTube(table);
    case Kind::kBall:
      return readBall(table);
  }
  return readBox(table);
}

double readFileUnits(const config::TomlTable& table, const FileSource& file) {
  static constexpr std::array<config::Choice<double>, 4> kUnits{
      {{"m", 1.0}, {"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}}};
  const std::optional<double> units = table.optionalChoice("units", kUnits);
  if (!units && isMeshFile(file.path)) {
    throw table.error("units", "is missing, and such files do not say theirs",
                      "\"mm\" (most CAD programs), \"cm\", \"m\" or \"in\"");
  }
  return units.value_or(1.0);
}

glm::dmat4 readFileFrame(const config::TomlTable& table, const FileSource& file) {
  enum class Up { kY, kZ };
  static constexpr std::array<config::Choice<Up>, 2> kUps{{{"y", Up::kY}, {"z", Up::kZ}}};
  const bool isMesh = isMeshFile(file.path);
  const Up own = isMesh && !hasMaterials(file.path) ? Up::kZ : Up::kY;
  const Up up = table.optionalChoice("up", kUps).value_or(own);
  // glTF is read with its y as z already.
  const Up asRead = isMesh ? Up::kZ : Up::kY;
  glm::dmat4 frame(readFileUnits(table, file));
  frame[3][3] = 1.0;
  if (up == asRead) return frame;
  return glm::rotate(frame, glm::radians(up == Up::kY ? 90.0 : -90.0), glm::dvec3(1.0, 0.0, 0.0));
}

}  // namespace pleinair::scene

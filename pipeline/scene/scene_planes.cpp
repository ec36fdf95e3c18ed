#include "pipeline/scene/scene_planes.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "pipeline/scene/scene_attachment.h"
#include "pipeline/scene/scene_values.h"

namespace pleinair::scene {
namespace {

using config::TomlTable;

ScenePlane readPlane(const TomlTable& table, const Scene& scene) {
  ScenePlane plane;
  plane.name =
      table.optionalString("name").value_or(fmt::format("plane {}", scene.planes.size() + 1));
  if (std::ranges::find(scene.planes, plane.name, &ScenePlane::name) != scene.planes.end()) {
    throw table.error("name", config::quoted(plane.name) + " is taken by a plane above",
                      "each name once");
  }
  plane.tagId = readAttachment(table, scene);
  plane.attachFromPlane = readPose(table).value_or(glm::dmat4(1.0));
  const auto size =
      table.vector<2>("size_m", {.min = 0.0, .max = 1000.0, .minOpen = true, .unit = "metres"});
  plane.sizeMetres = {size[0], size[1]};
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

}  // namespace pleinair::scene

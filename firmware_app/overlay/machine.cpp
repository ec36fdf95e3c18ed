#include "firmware_app/overlay/machine.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include "config/config_error.h"
#include "config/suggestion.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

bool isSameMachine(const scene::ModelSource& a, const scene::ModelSource& b) {
  const auto* file = std::get_if<scene::FileSource>(&a);
  const auto* other = std::get_if<scene::FileSource>(&b);
  if (file != nullptr && other != nullptr) return file->path.filename() == other->path.filename();
  return a.index() == b.index();
}

[[noreturn]] void refuse(const scene::Scene& scene, std::string problem) {
  std::vector<std::string> names;
  for (const scene::SceneModel& each : scene.models) names.push_back(each.name);
  throw hal::Failure(
      {.kind = hal::ErrorKind::kInvalidArgument,
       .subject = "procedure.machine",
       .problem = std::move(problem),
       .remedy = names.empty() ? "give a scene (--scene) that places the machine on its tags"
                               : fmt::format("choose one of {}, as in --set procedure.machine={}",
                                             config::listText(names), names.front())});
}

}  // namespace

std::size_t machineIn(const scene::Scene& scene, const procedure::Procedure& procedure,
                      const std::string& name) {
  if (scene.models.empty()) refuse(scene, "the scene has no model");
  if (name != "auto") {
    const auto named = std::ranges::find(scene.models, name, &scene::SceneModel::name);
    if (named == scene.models.end())
      refuse(scene, "the scene has no model " + config::quoted(name));
    return static_cast<std::size_t>(named - scene.models.begin());
  }
  if (scene.models.size() == 1) return 0;
  std::vector<std::size_t> same;
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    if (isSameMachine(scene.models[i].source, procedure.source)) same.push_back(i);
  }
  if (same.size() == 1) return same.front();
  refuse(scene, same.empty() ? "none of the scene's models is the procedure's"
                             : "several of the scene's models may be the procedure's");
}

void putMachine(scene::Scene& scene, std::size_t machine, const procedure::Procedure& procedure) {
  scene::SceneModel& place = scene.models.at(machine);
  // The scene has said unit and up of a file that it places. A built-in model stands upright and is
  // in metres, whatever stands in its place.
  const bool isPlacedFile = std::holds_alternative<scene::FileSource>(place.source);
  if (isPlacedFile && std::abs(place.unitMetres / procedure.unitMetres - 1.0) > 1e-6) {
    throw hal::Failure(
        {.kind = hal::ErrorKind::kInvalidArgument,
         .subject = "model " + config::quoted(place.name),
         .problem = fmt::format("has a unit of {:g} m in the scene, and of {:g} m in the procedure",
                                place.unitMetres, procedure.unitMetres),
         .remedy = "the same units in both"});
  }
  if (!isPlacedFile) {
    place.attachFromModel =
        place.attachFromModel *
        glm::scale(glm::dmat4(procedure.uprightFromModel), glm::dvec3(procedure.unitMetres));
    place.unitMetres = procedure.unitMetres;
  }
  auto model = std::make_shared<scene::Model>(*procedure.model);
  for (scene::ModelPart& part : model->parts) part.radiansPerSecond = 0.0;
  place.model = std::move(model);
  place.source = procedure.source;
  place.playback = {};
}

PartSurface surfaceOfParts(const scene::Model& model, std::span<const std::size_t> parts) {
  scene::Model chosen = model;
  chosen.parts.clear();
  for (const std::size_t part : parts) chosen.parts.push_back(model.parts[part]);
  scene::numberParts(chosen);
  PartSurface surface{.sphere = scene::boundingSphere(chosen), .triangles = {}};
  for (std::size_t number = 0; number < chosen.parts.size(); ++number) {
    const scene::ModelPart& part = chosen.parts[number];
    for (std::size_t i = 0; i < part.surfaceCount; ++i) {
      const scene::Mesh& mesh = chosen.surfaces[part.firstSurface + i].mesh;
      for (const auto& triangle : mesh.triangles) {
        auto& corners =
            surface.triangles.emplace_back(inspection::PartTriangle{.part = number}).corners;
        for (std::size_t c = 0; c < corners.size(); ++c) {
          const glm::dvec3 at(mesh.vertices[triangle.at(c)].position);
          corners.at(c) = glm::dvec3(part.modelFromPart * glm::dvec4(at, 1.0));
        }
      }
    }
  }
  return surface;
}

}  // namespace pleinair::app

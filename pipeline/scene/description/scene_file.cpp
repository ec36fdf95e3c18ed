#include "pipeline/scene/description/scene_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "config/toml_reader.h"
#include "pipeline/scene/description/lens.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/description/scene_tables.h"
#include "pipeline/scene/description/scene_values.h"
#include "pipeline/scene/meshes/mesh_file.h"
#include "pipeline/scene/models/limits.h"
#include "pipeline/tracking/camera/calibration_file.h"

namespace pleinair::scene {
namespace {

using config::TomlDocument;
using config::TomlTable;

constexpr int kHighestId36h11 = 586;
constexpr int kHighestId = 0xFFFF;
/// Limits the memory of a scene; a gear of 200 teeth has 23,000 triangles.
constexpr std::size_t kMaxSceneTriangles = 1'000'000;

tracking::CameraModel readCamera(const TomlTable& table, const std::filesystem::path& directory,
                                 std::vector<std::filesystem::path>& files) {
  const auto calibration = table.optionalString("calibration");
  if (!calibration) return tracking::readCalibration(table);
  files.push_back(directory / *calibration);
  try {
    return tracking::loadCalibration(files.back());
  } catch (const config::ConfigError& error) {
    // An error with a line is about the calibration's contents; without one, the scene names a
    // wrong file.
    if (error.line() > 0) throw;
    throw table.error("calibration", error.what());
  }
}

/// A printed tag is centimetres wide, or decimetres on a wall: 12 is 12 mm or 12 cm, not metres.
constexpr config::NumberRange kTagEdge{.min = 0.002, .max = 3.0, .unit = "metres"};

double readTagEdge(const TomlTable& table) {
  refuseOtherUnits(table, "edge_m");
  const double edge =
      table.has("edge_m") ? table.number("edge_m") : table.number("edge_m", kTagEdge);
  if (kTagEdge.contains(edge)) return edge;
  const std::string hint = edge > kTagEdge.max
                               ? fmt::format(" metres; {0:g} mm are {1:g} m, {0:g} cm are {2:g} m",
                                             edge, edge / 1000, edge / 100)
                               : "";
  throw table.error("edge_m", fmt::format("found {:g}{}", edge, hint), kTagEdge.describe());
}

tracking::TagMarker readTag(const TomlTable& table, std::string_view family) {
  tracking::TagMarker tag;
  const bool isDefault = family == tracking::kDefaultTagFamily;
  tag.id = table.integer("id", {.min = 0, .max = isDefault ? kHighestId36h11 : kHighestId});
  tag.edgeMetres = readTagEdge(table);
  if (const auto worldFromAttach = readPose(table)) {
    tag.worldFromTag = *worldFromAttach * kAttachFromTag;
  }
  return tag;
}

void readTags(const TomlTable& root, Scene& scene) {
  const std::vector<TomlTable> tables = root.tables("tag");
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const TomlTable& table = tables[i];
    const std::string family =
        table.optionalString("family").value_or(std::string(tracking::kDefaultTagFamily));
    if (const auto known = tracking::checkTagFamily(family); !known) {
      throw table.error("family", known.error().problem + "; " + known.error().remedy);
    }
    if (i == 0) scene.tagFamily = family;
    if (family != scene.tagFamily) {
      throw table.error("family", "found " + config::quoted(family),
                        fmt::format("one family a scene, and tag[0] has \"{}\"", scene.tagFamily));
    }
    const tracking::TagMarker tag = readTag(table, family);
    if (scene.findTag(tag.id) != nullptr) {
      throw table.error("id", fmt::format("{} is used by an earlier tag", tag.id), "unique ids");
    }
    scene.tags.push_back(tag);
  }
}

/// Loads or makes a model, unless an earlier one has the same source.
std::shared_ptr<const Model> modelOfSource(const ModelSource& source, const TomlTable& table,
                                           const Scene& scene) {
  for (const SceneModel& model : scene.models) {
    if (model.source == source) return model.model;
  }
  hal::Result<Model> model = modelOf(source);
  if (!model) {
    const hal::Error& error = model.error();
    throw table.error("source", error.subject + ": " + error.problem, error.remedy);
  }
  if (scene.camera && bendsLines(scene.camera->distortion())) {
    // An eighth of the radius bends by less than 0.1 px under a lens that moves corners by 20 px.
    const double shortEdge = 0.125 * boundingSphere(*model).radiusMetres;
    if (shortEdge > 0.0) model = withShortEdges(*model, shortEdge, kMaxSceneTriangles + 1);
  }
  if (const std::uint64_t drawn = drawnTriangles(*model); drawn > kMaxTriangles) {
    throw table.error("source", fmt::format("draws {} triangles, cut small for the lens", drawn),
                      fmt::format("at most {}", kMaxTriangles));
  }
  return std::make_shared<const Model>(*std::move(model));
}

/// The model with these directions of strokes; shared with an earlier one of the same source and
/// directions.
std::shared_ptr<const Model> withStrokes(std::shared_ptr<const Model> model,
                                         const StrokeDirection& direction,
                                         const ModelSource& source, const Scene& scene) {
  if (model->strokeDirection == direction) return model;
  for (const SceneModel& each : scene.models) {
    if (each.source == source && each.model->strokeDirection == direction) return each.model;
  }
  Model made = *model;
  made.strokeDirection = direction;
  return std::make_shared<const Model>(std::move(made));
}

SceneModel readModel(const TomlTable& table, const std::filesystem::path& directory,
                     const Scene& scene) {
  SceneModel model;
  model.name =
      table.optionalString("name").value_or(fmt::format("model {}", scene.models.size() + 1));
  if (std::ranges::find(scene.models, model.name, &SceneModel::name) != scene.models.end()) {
    throw table.error("name", config::quoted(model.name) + " is used by an earlier model",
                      "unique names");
  }
  model.source = readSource(table, directory);
  model.tagId = readAttachment(table, scene);
  const double scale = table.optionalNumber("scale", {.min = 1e-6, .max = 1e6}).value_or(1.0);
  model.attachFromModel = glm::scale(readPose(table).value_or(glm::dmat4(1.0)), glm::dvec3(scale));
  glm::dmat4 frame(1.0);
  if (const auto* file = std::get_if<FileSource>(&model.source)) {
    frame = readFileFrame(table, *file);
    model.unitMetres = glm::length(glm::dvec3(frame[0]));
    model.attachFromModel = model.attachFromModel * frame;
  }
  const glm::vec3 untinted = hasOwnColours(model.source) ? glm::vec3(1.0F) : model.srgb;
  model.srgb = readColour(table).value_or(untinted);
  model.isOccluder = table.optionalBoolean("occluder").value_or(false);
  model.focus =
      static_cast<float>(table.optionalNumber("focus", {.min = 0.0, .max = 1.0}).value_or(0.0));
  model.model = modelOfSource(model.source, table, scene);
  StrokeDirection strokes = readStrokeDirection(table, *model.model, model.isOccluder);
  // The author speaks of axes with z up, the model has the file's.
  strokes.axis =
      glm::vec3(glm::transpose(glm::dmat3(frame)) * glm::dvec3(strokes.axis) / model.unitMetres);
  model.model = withStrokes(std::move(model.model), strokes, model.source, scene);
  model.playback = readPlayback(table, model.model->rig);
  return model;
}

/// Names the parts of a model's file that are not shown, and a model that is far larger or smaller
/// than anything with tags.
std::vector<std::string> noticesOf(const SceneModel& model) {
  constexpr double kHugeMetres = 2.0;
  constexpr double kTinyMetres = 0.005;
  std::vector<std::string> notices;
  const auto* file = std::get_if<FileSource>(&model.source);
  const std::string name = file != nullptr ? file->path.string() : model.name;
  for (const std::string& notice : model.model->notices) {
    notices.push_back(fmt::format("{}: {}", name, notice));
  }
  const double scale = glm::length(glm::dvec3(model.attachFromModel[0]));
  const double width = 2.0 * scale * boundingSphere(*model.model).radiusMetres;
  constexpr double kMetresPerMillimetre = 0.001;
  const double inMillimetres = kMetresPerMillimetre * width;
  const bool isPlausible = inMillimetres >= kTinyMetres && inMillimetres <= kHugeMetres;
  if (width > kHugeMetres && isPlausible && file != nullptr && isMeshFile(file->path.string()) &&
      model.unitMetres == 1.0) {
    notices.push_back(fmt::format("{}: is {:.3g} m across here; units = \"mm\" makes it {:.3g} m",
                                  name, width, inMillimetres));
  } else if (width > kHugeMetres || (width > 0.0 && width < kTinyMetres)) {
    notices.push_back(fmt::format("{}: is {:.3g} m across here{}; a scale of {:.2g} makes it 0.2 m",
                                  name, width,
                                  file != nullptr ? "" : " (its lengths are in metres)",
                                  0.2 * scale / model.unitMetres / width));
  }
  return notices;
}

void readModels(const TomlTable& root, const std::filesystem::path& directory, Scene& scene) {
  const std::vector<TomlTable> tables = root.tables("model");
  if (tables.size() > kMaxObjects) {
    throw root.error("model", fmt::format("found {} models", tables.size()),
                     fmt::format("at most {}", kMaxObjects));
  }
  std::size_t triangles = 0;
  for (const TomlTable& table : tables) {
    scene.models.push_back(readModel(table, directory, scene));
    const SceneModel& added = scene.models.back();
    if (auto notice = unplayedClipsNotice(added.model->rig, added.playback)) {
      scene.notices.push_back(fmt::format("{}: {}", added.name, *notice));
    }
    if (added.model.use_count() > 1) continue;
    triangles += added.model->surfaceTriangles();
    if (triangles > kMaxSceneTriangles) {
      throw table.error(
          "source", fmt::format("makes {} triangles in the scene", triangles),
          fmt::format("at most {} in all; equal models share theirs", kMaxSceneTriangles));
    }
    if (const auto* file = std::get_if<FileSource>(&added.source)) {
      scene.files.push_back(file->path);
    }
    for (std::string& notice : noticesOf(added)) scene.notices.push_back(std::move(notice));
  }
}

Scene readScene(const TomlDocument& document, const std::filesystem::path& directory) {
  const TomlTable& root = document.root();
  Scene scene;
  if (const auto camera = root.optionalTable("camera")) {
    scene.camera = readCamera(*camera, directory, scene.files);
  }
  if (const auto light = root.optionalTable("light")) scene.light = readLight(*light);
  readTags(root, scene);
  readPlanes(root, scene);
  readFoci(root, scene);
  readModels(root, directory, scene);
  root.finish();
  return scene;
}

}  // namespace

Scene loadScene(const std::filesystem::path& path) {
  return readScene(TomlDocument::parseFile(path), path.parent_path());
}

Scene parseScene(std::string_view text, std::string name, const std::filesystem::path& directory) {
  return readScene(TomlDocument::parseText(text, std::move(name)), directory);
}

}  // namespace pleinair::scene

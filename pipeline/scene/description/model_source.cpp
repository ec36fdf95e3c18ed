#include "pipeline/scene/description/model_source.h"

#include <utility>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/gltf/gltf_file.h"
#include "pipeline/scene/meshes/mesh_file.h"
#include "pipeline/scene/models/simplified_model.h"

namespace pleinair::scene {
namespace {

struct ModelMaker {
  hal::Result<Model> operator()(const BoxSource& box) const {
    return singlePartModel("box", boxMesh(box.sizeMetres));
  }
  hal::Result<Model> operator()(const GearSource& gear) const {
    return singlePartModel("gear", gearMesh(gear));
  }
  hal::Result<Model> operator()(const GearboxSource& gearbox) const {
    return gearboxModel(gearbox);
  }
  hal::Result<Model> operator()(const TubeSource& tube) const { return tubeModel(tube); }
  hal::Result<Model> operator()(const BallSource& ball) const { return ballModel(ball); }
  hal::Result<Model> operator()(const FileSource& file) const {
    return isMeshFile(file.path) ? readMeshFile(file.path) : readGltf(file.path);
  }
};

}  // namespace

hal::Result<Model> modelOf(const ModelSource& source) {
  return std::visit(ModelMaker{}, source).map([](Model&& model) {
    return simplified(std::move(model));
  });
}

bool hasOwnColours(const ModelSource& source) {
  if (const auto* file = std::get_if<FileSource>(&source)) return hasMaterials(file->path);
  return !std::holds_alternative<BoxSource>(source) && !std::holds_alternative<GearSource>(source);
}

}  // namespace pleinair::scene

#include "pipeline/scene/model_source.h"

#include "pipeline/scene/builtin_box.h"

namespace pleinair::scene {
namespace {

struct MeshMaker {
  Mesh operator()(const BoxSource& box) const { return boxMesh(box.sizeMetres); }
  Mesh operator()(const GearSource& gear) const { return gearMesh(gear); }
};

}  // namespace

Mesh meshOf(const ModelSource& source) {
  return std::visit(MeshMaker{}, source);
}

}  // namespace pleinair::scene

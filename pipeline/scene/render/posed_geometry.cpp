#include "pipeline/scene/render/posed_geometry.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>

#include "pipeline/gpu/texture.h"

namespace pleinair::scene {
namespace {

constexpr std::size_t kPosedBytes = 16;

gpu::TextureWrap wrapOf(TextureEdge edge) {
  if (edge == TextureEdge::kRepeat) return gpu::TextureWrap::kRepeat;
  return edge == TextureEdge::kMirror ? gpu::TextureWrap::kMirror : gpu::TextureWrap::kClamp;
}

gpu::Texture uploaded(const ModelTexture& texture) {
  const hal::ImageView picture = texture.picture->view();
  gpu::Texture made(gpu::TextureFormat::kSrgba8, picture.format.size,
                    gpu::TextureFilter::kTrilinear);
  made.setWrap(wrapOf(texture.across), wrapOf(texture.down));
  made.upload(picture.planes[0].bytes, picture.planes[0].strideBytes);
  return made;
}

/// Whether the model never changes.
bool isAlwaysStatic(const Model& model, const Playback& playback) {
  return !playback.clip && std::ranges::all_of(model.parts, [](const ModelPart& part) {
    return part.radiansPerSecond == 0.0;
  });
}

/// One buffer for all models, with `member` of each DrawnModel, one after another.
template <class Member>
gpu::Buffer joined(const std::vector<DrawnModel>& drawn, Member member) {
  std::size_t bytes = 0;
  for (const DrawnModel& each : drawn) bytes += std::span(each.*member).size_bytes();
  if (bytes == 0) return {};
  gpu::Buffer buffer(bytes, gpu::BufferUsage::kStatic);
  std::size_t offset = 0;
  for (const DrawnModel& each : drawn) {
    const auto part = std::as_bytes(std::span(each.*member));
    if (!part.empty()) buffer.write(part, offset);
    offset += part.size();
  }
  return buffer;
}

}  // namespace

PosedGeometry::PosedGeometry(const gpu::ShaderLibrary& library, const Scene& scene)
    : scene_(scene) {
  std::vector<DrawnModel> drawn;
  for (const SceneModel& sceneModel : scene.models) {
    const Model& model = *sceneModel.model;
    const auto known = std::ranges::find(models_, &model, &ModelSlot::model);
    ObjectSlot& object = objects_.emplace_back();
    object.model = static_cast<std::size_t>(known - models_.begin());
    if (known == models_.end()) addModel(model, drawn);
    object.firstPosed = posedCount_;
    posedCount_ += models_[object.model].vertexCount;
    poseModel(model, std::nullopt, {}, object.pose);
    object.firstMatrix = static_cast<std::uint32_t>(matrixRows_.size() / 3);
    matrixRows_.resize(matrixRows_.size() + 3 * object.pose.matrices.size());
  }
  if (triangleCount_ == 0) return;
  firstWeightRow_ = static_cast<std::uint32_t>(matrixRows_.size());
  std::uint32_t weights = 0;
  for (ObjectSlot& object : objects_) {
    object.firstWeight = weights;
    weights += static_cast<std::uint32_t>(object.pose.weights.size());
  }
  matrixRows_.resize(matrixRows_.size() + (weights + 3) / 4);
  pose_ = library.compute("pipeline/scene/render/shaders/pose.comp");
  if (weights > 0)
    poseMorphed_ = library.compute("pipeline/scene/render/shaders/pose.comp", {{"MORPHED"}});
  upload(drawn);
  makeVertexArray();
}

void PosedGeometry::addModel(const Model& model, std::vector<DrawnModel>& drawn) {
  const auto sum = [&](auto member) {
    std::size_t count = 0;
    for (const DrawnModel& each : drawn) count += (each.*member).size();
    return static_cast<std::uint32_t>(count);
  };
  ModelSlot& slot = models_.emplace_back();
  slot.model = &model;
  slot.firstVertex = sum(&DrawnModel::rest);
  slot.firstTriangle = sum(&DrawnModel::triangles);
  slot.firstIndex = sum(&DrawnModel::indices);
  slot.firstDelta = sum(&DrawnModel::deltas);
  const DrawnModel& made = drawn.emplace_back(model);
  slot.vertexCount = static_cast<std::uint32_t>(made.rest.size());
  slot.batches = made.batches;
  slot.ranges = made.ranges;
  for (const ModelTexture& texture : model.textures) slot.textures.push_back(uploaded(texture));
  triangleCount_ += static_cast<std::uint32_t>(made.triangles.size());
}

void PosedGeometry::upload(const std::vector<DrawnModel>& drawn) {
  rest_ = joined(drawn, &DrawnModel::rest);
  attributes_ = joined(drawn, &DrawnModel::attributes);
  indices_ = joined(drawn, &DrawnModel::indices);
  triangles_ = joined(drawn, &DrawnModel::triangles);
  forms_ = joined(drawn, &DrawnModel::forms);
  deltas_ = joined(drawn, &DrawnModel::deltas);
  posed_ = gpu::Buffer(2 * kPosedBytes * posedCount_, gpu::BufferUsage::kDynamic);
  matrices_ = gpu::Buffer(std::span(matrixRows_).size_bytes(), gpu::BufferUsage::kDynamic);
}

void PosedGeometry::makeVertexArray() {
  vertexArray_ = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertexArray_.get());
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexAttribIFormat(1, 1, GL_UNSIGNED_INT, 12);
  glVertexAttribFormat(2, 2, GL_FLOAT, GL_FALSE, offsetof(VertexAttributes, texture));
  glVertexAttribFormat(3, 4, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(VertexAttributes, colour));
  for (const GLuint attribute : {0U, 1U, 2U, 3U}) {
    glVertexAttribBinding(attribute, attribute / 2);
    glEnableVertexAttribArray(attribute);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glBindVertexArray(0);
}

void PosedGeometry::beginFrame() {
  half_ = 1 - half_;
  for (ObjectSlot& object : objects_) {
    object.isPosed = false;
    object.isWritten[half_] = false;
  }
}

void PosedGeometry::pose(std::size_t index, hal::Duration elapsed, hal::Duration turning) {
  ObjectSlot& object = objects_[index];
  assert(!object.isPosed);
  object.isPosed = true;
  const SceneModel& sceneModel = scene_.models[index];
  const Model& model = *sceneModel.model;
  const bool isStatic = isAlwaysStatic(model, sceneModel.playback);
  if (isStatic && object.isAtRest[half_]) return;
  poseModel(model, momentOf(model.rig, sceneModel.playback, elapsed), turning, object.pose);
  for (std::size_t i = 0; i < object.hidden.size(); ++i) {
    if (object.hidden[i] == 0) continue;
    // Triangles that shrink to a point cover no pixel.
    const ModelPart& part = model.parts[i];
    std::fill_n(object.pose.matrices.begin() + static_cast<std::ptrdiff_t>(part.firstMatrix),
                part.matrixCount, glm::dmat4(0.0));
  }
  object.sphere = boundingSphere(model, object.pose);
  boundingSpheres(model, object.pose, object.spheres);
}

void PosedGeometry::hideParts(std::size_t index, std::span<const std::uint8_t> hidden) {
  ObjectSlot& object = objects_[index];
  assert(hidden.empty() || hidden.size() == model(index).parts.size());
  if (std::ranges::equal(object.hidden, hidden)) return;
  object.hidden.assign(hidden.begin(), hidden.end());
  object.isAtRest = {};
}

/// Static models are written once into each half.
void PosedGeometry::endPosing() {
  if (isEmpty()) return;
  const auto isToRun = [&](const ObjectSlot& each) {
    return each.isPosed && !each.isAtRest[half_];
  };
  if (std::ranges::any_of(objects_, isToRun)) writeMatrices();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    ObjectSlot& object = objects_[i];
    if (!object.isPosed) continue;
    object.isWritten[half_] = true;
    if (object.isAtRest[half_]) continue;
    runPose(object);
    object.isAtRest[half_] = isAlwaysStatic(*scene_.models[i].model, scene_.models[i].playback);
  }
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void PosedGeometry::writeMatrices() {
  for (const ObjectSlot& object : objects_) {
    if (!object.isPosed) continue;
    glm::vec4* row = &matrixRows_[3 * std::size_t{object.firstMatrix}];
    for (const glm::dmat4& m : object.pose.matrices) {
      for (int i = 0; i < 3; ++i) *row++ = glm::vec4(m[0][i], m[1][i], m[2][i], m[3][i]);
    }
    for (std::size_t i = 0; i < object.pose.weights.size(); ++i) {
      const std::size_t at = object.firstWeight + i;
      matrixRows_[firstWeightRow_ + at / 4][static_cast<int>(at % 4)] = object.pose.weights[i];
    }
  }
  matrices_.write(std::as_bytes(std::span(matrixRows_)));
}

void PosedGeometry::runPose(const ObjectSlot& object) {
  const ModelSlot& slot = models_[object.model];
  const std::uint32_t firstPosed =
      place(static_cast<std::size_t>(&object - objects_.data())).firstCurrent;
  for (const PoseRange& range : slot.ranges) {
    gpu::Program& program = range.targetCount > 0 ? poseMorphed_ : pose_;
    program.use()
        .storage("Rest", rest_)
        .storage("Matrices", matrices_)
        .storage("Posed", posed_)
        .set("firstRest", slot.firstVertex + range.firstVertex)
        .set("firstPosed", firstPosed + range.firstVertex)
        .set("vertexCount", range.vertexCount)
        .set("firstMatrix", object.firstMatrix);
    if (range.targetCount > 0) {
      program.storage("Deltas", deltas_)
          .set("targetCount", range.targetCount)
          .set("firstDelta", slot.firstDelta + range.firstDelta)
          .set("firstWeightRow", firstWeightRow_)
          .set("firstWeight", object.firstWeight + range.firstWeight);
    }
    const std::uint32_t maxVertices =
        static_cast<std::uint32_t>(program.groupSize().x) * gpu::kMaxGroups;  // of a dispatch
    for (std::uint32_t first = 0; first < range.vertexCount; first += maxVertices) {
      const std::uint32_t count = std::min(range.vertexCount - first, maxVertices);
      program.set("firstVertex", first).dispatch({static_cast<int>(count), 1}, 0);
    }
  }
}

void PosedGeometry::reset() {
  for (ObjectSlot& object : objects_) object.isWritten = {};
}

bool PosedGeometry::isStatic(std::size_t object) const {
  return objects_[object].isAtRest[0] && objects_[object].isAtRest[1];
}

ObjectPlace PosedGeometry::place(std::size_t index) const {
  const ObjectSlot& object = objects_[index];
  const auto halfOf = [&](std::size_t half) {
    return static_cast<std::uint32_t>(half) * posedCount_ + object.firstPosed;
  };
  ObjectPlace place{.firstTriangle = models_[object.model].firstTriangle,
                    .firstCurrent = halfOf(half_)};
  if (object.isWritten[1 - half_]) place.firstPrevious = halfOf(1 - half_);
  return place;
}

void PosedGeometry::bind(std::size_t index) const {
  const ModelSlot& slot = models_[objects_[index].model];
  glBindVertexArray(vertexArray_.get());
  glBindVertexBuffer(0, posed_.name(),
                     static_cast<GLintptr>(kPosedBytes * place(index).firstCurrent), kPosedBytes);
  glBindVertexBuffer(1, attributes_.name(),
                     static_cast<GLintptr>(sizeof(VertexAttributes) * slot.firstVertex),
                     sizeof(VertexAttributes));
}

void PosedGeometry::unbind() {
  glBindVertexArray(0);
}

void PosedGeometry::draw(std::size_t index, const DrawBatch& batch) const {
  const std::size_t first = models_[objects_[index].model].firstIndex + batch.firstIndex;
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(batch.indexCount), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first * sizeof(std::uint32_t)));
}

}  // namespace pleinair::scene

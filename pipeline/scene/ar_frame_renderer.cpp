#include "pipeline/scene/ar_frame_renderer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/scene/attach_frame.h"
#include "pipeline/scene/lens.h"

namespace pleinair::scene {
namespace {

/// What is nearer is not drawn; a model's own depth leaves the rest of the depth buffer its bits.
constexpr double kNearestMetres = 1e-3;
constexpr double kFarthestByNearest = 1000.0;
constexpr ArFrame kCameraOnly{.nearMetres = 0.1F, .farMetres = 10.0F};
constexpr glm::vec4 kNoNormal(128.0F / 255.0F, 128.0F / 255.0F, 128.0F / 255.0F, 0.0F);

/// Where the frame is that a model is attached to; nothing where that is not known.
std::optional<glm::dmat4> cameraFromAttach(const Scene& scene, const SceneModel& model,
                                           const PoseSet& poses) {
  if (!model.tagId) return poses.cameraFromWorld;
  const auto seen = std::ranges::find(poses.tags, *model.tagId, &TagSighting::id);
  if (seen != poses.tags.end()) return seen->cameraFromTag * kTagFromAttach;
  const tracking::TagMarker* tag = scene.findTag(*model.tagId);
  assert(tag != nullptr);
  if (!tag->worldFromTag || !poses.cameraFromWorld) return std::nullopt;
  return *poses.cameraFromWorld * *tag->worldFromTag * kTagFromAttach;
}

/// The distances along the camera's axis between which a model lies.
struct DepthSpan {
  double nearest;
  double farthest;
};

DepthSpan depthSpan(const BoundingSphere& sphere, const glm::dmat4& cameraFromModel) {
  const double scale = glm::length(glm::dvec3(cameraFromModel[0]));
  const double middle = (cameraFromModel * glm::dvec4(sphere.centre, 1.0)).z;
  const double radius = scale * sphere.radiusMetres;
  return {middle - radius, middle + radius};
}

}  // namespace

ArFrameRenderer::ArFrameRenderer(const gpu::ShaderLibrary& library, Scene scene)
    : scene_(std::move(scene)) {
  assert(scene_.models.size() <= kMaxObjects);
  if (scene_.models.empty()) return;
  background_ = library.fragmentPass("pipeline/scene/shaders/camera_background.frag");
  toon_ =
      library.draw("pipeline/scene/shaders/model.vert", "pipeline/scene/shaders/model_toon.frag");
  uploadMeshes();
  visible_.reserve(scene_.models.size());
}

void ArFrameRenderer::uploadMeshes() {
  std::vector<MeshVertex> vertices;
  for (const SceneModel& model : scene_.models) {
    const auto known = std::ranges::find(meshes_, model.mesh.get(), &MeshSlot::mesh);
    meshOfModel_.push_back(static_cast<std::size_t>(known - meshes_.begin()));
    if (known != meshes_.end()) continue;
    const Mesh& mesh = *model.mesh;
    assert(mesh.triangles.size() <= kMaxTriangles);
    meshes_.push_back({.mesh = &mesh,
                       .firstVertex = static_cast<GLint>(vertices.size()),
                       .vertexCount = static_cast<GLsizei>(3 * mesh.triangles.size()),
                       .sphere = boundingSphere(mesh)});
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) vertices.push_back(mesh.vertices[corner]);
    }
  }
  vertices_ = gpu::Buffer::of(std::span<const MeshVertex>(vertices));
  vertexArray_ = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertexArray_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, offsetof(MeshVertex, position));
  glVertexAttribFormat(1, 3, GL_FLOAT, GL_FALSE, offsetof(MeshVertex, normal));
  for (const GLuint attribute : {0U, 1U}) {
    glVertexAttribBinding(attribute, 0);
    glEnableVertexAttribArray(attribute);
  }
  glBindVertexBuffer(0, vertices_.name(), 0, sizeof(MeshVertex));
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

void ArFrameRenderer::allocate(hal::FrameSize size) {
  if (ids_ && ids_.size() == size) return;
  ids_ = gpu::Texture(gpu::TextureFormat::kR32ui, size);
  normalFocus_ = gpu::Texture(gpu::TextureFormat::kRgba8, size);
  depth_ = gpu::Texture(gpu::TextureFormat::kDepth24, size);
  withoutColour_ = gpu::RenderTarget({&ids_, &normalFocus_}, &depth_);
  showsCameraOnly_ = false;
  if (scene_.models.empty()) return;
  colour_ = gpu::Texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  target_ = gpu::RenderTarget({&colour_, &ids_, &normalFocus_}, &depth_);
}

void ArFrameRenderer::warmUp(hal::FrameSize size) {
  allocate(size);
  if (scene_.models.empty()) return;
  const gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  drawBackground(picture);
  setCamera(assumedCamera(size));
  visible_.assign(1, Visible{});
  drawModels();
  showsCameraOnly_ = false;
}

const ArFrame& ArFrameRenderer::compose(const gpu::Texture& picture,
                                        const tracking::CameraModel& camera, const PoseSet& poses,
                                        std::uint64_t sequence, hal::TimePoint captureTime,
                                        gpu::PassTimer& timer) {
  assert(picture.size() == camera.imageSize());
  const auto scope = timer.measure("compose");
  allocate(picture.size());
  findVisible(poses);
  frame_ = kCameraOnly;
  if (visible_.empty()) {
    clearToCamera();
  } else {
    drawBackground(picture);
    setCamera(camera);
    drawModels();
    showsCameraOnly_ = false;
  }
  frame_.colour = visible_.empty() ? &picture : &colour_;
  frame_.ids = &ids_;
  frame_.normalFocus = &normalFocus_;
  frame_.depth = &depth_;
  frame_.hasObjects = !visible_.empty();
  frame_.hasFocus = std::ranges::any_of(
      visible_, [&](const Visible& each) { return scene_.models[each.model].focus > 0.0F; });
  frame_.sequence = sequence;
  frame_.captureTime = captureTime;
  return frame_;
}

void ArFrameRenderer::findVisible(const PoseSet& poses) {
  visible_.clear();
  for (std::size_t i = 0; i < scene_.models.size(); ++i) {
    const SceneModel& model = scene_.models[i];
    const auto attach = cameraFromAttach(scene_, model, poses);
    if (!attach) continue;
    const glm::dmat4 cameraFromModel = *attach * model.attachFromModel;
    const DepthSpan span = depthSpan(meshes_[meshOfModel_[i]].sphere, cameraFromModel);
    if (span.farthest <= kNearestMetres) continue;
    visible_.push_back({i, *attach, cameraFromModel});
  }
}

void ArFrameRenderer::clearToCamera() {
  if (showsCameraOnly_) return;
  withoutColour_.beginDiscarding();
  withoutColour_.clearUnsigned(0, glm::uvec4(0U));
  withoutColour_.clearColour(1, kNoNormal);
  withoutColour_.clearDepth();
  showsCameraOnly_ = true;
}

void ArFrameRenderer::drawBackground(const gpu::Texture& picture) {
  // Depth is cleared where the pass begins: later, a tile-based GPU would split it (GPU rules, 10).
  target_.beginDiscarding();
  target_.clearDepth();
  background_.use().texture("picture", picture).drawArea(target_, {0, 0}, target_.size());
}

void ArFrameRenderer::setCamera(const tracking::CameraModel& camera) {
  double nearest = HUGE_VAL;
  double farthest = kNearestMetres * kFarthestByNearest;
  for (const Visible& visible : visible_) {
    const auto span =
        depthSpan(meshes_[meshOfModel_[visible.model]].sphere, visible.cameraFromModel);
    nearest = std::min(nearest, span.nearest);
    farthest = std::max(farthest, span.farthest);
  }
  farthest *= 1.001;  // beyond rounding
  nearest = std::max(0.999 * nearest, farthest / kFarthestByNearest);
  frame_.nearMetres = static_cast<float>(nearest);
  frame_.farMetres = static_cast<float>(farthest);

  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  const tracking::Intrinsics& pinhole = camera.intrinsics();
  const tracking::Distortion& lens = camera.distortion();
  const double range = farthest - nearest;
  toon_.use()
      .set("clipFocal", glm::vec2(2.0 * glm::dvec2(pinhole.fx, pinhole.fy) / size))
      .set("clipCentre", glm::vec2(2.0 * glm::dvec2(pinhole.cx, pinhole.cy) / size - 1.0))
      .set("clipDepth", glm::vec2((farthest + nearest) / range, -2.0 * farthest * nearest / range))
      .set("radial", glm::vec3(lens.k1, lens.k2, lens.k3))
      .set("tangential", glm::vec2(lens.p1, lens.p2))
      .set("radialBelow", glm::vec3(lens.k4, lens.k5, lens.k6))
      .set("trustedRadius", static_cast<float>(trustedLensRadius(lens)));
}

void ArFrameRenderer::drawModels() {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);  // image rows go down, GL's go up
  glBindVertexArray(vertexArray_.get());
  for (const Visible& visible : visible_) drawModel(visible);
  glBindVertexArray(0);
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

void ArFrameRenderer::drawModel(const Visible& visible) {
  const SceneModel& model = scene_.models[visible.model];
  const MeshSlot& slot = meshes_[meshOfModel_[visible.model]];
  const glm::dmat3 cameraFromLight(
      scene_.light.frame == Light::Frame::kCamera ? kTagFromAttach : visible.cameraFromAttach);
  const glm::dmat3 linear(visible.cameraFromModel);
  toon_.set("cameraFromModel", glm::mat4(visible.cameraFromModel))
      .set("cameraFromModelRotation", glm::mat3(linear / glm::length(linear[0])))
      .set("towardLight", glm::vec3(cameraFromLight * scene_.light.towardLight))
      .set("object", static_cast<unsigned>(visible.model + 1))
      .set("srgb", model.srgb)
      .set("focus", model.focus)
      .set("firstVertex", slot.firstVertex);
  glDrawArrays(GL_TRIANGLES, slot.firstVertex, slot.vertexCount);
}

}  // namespace pleinair::scene

#include "pipeline/scene/ar_frame_renderer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

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

/// A vertex as the GPU reads it.
struct GpuVertex {
  glm::vec3 position;
  glm::vec3 normal;
  glm::vec2 place;
  glm::u16vec4 colour;  // linear light; 8 bits would band in the dark
};

GpuVertex gpuVertex(const MeshVertex& vertex) {
  return {.position = vertex.position,
          .normal = vertex.normal,
          .place = vertex.texture,
          .colour = glm::u16vec4(65535.0F * glm::clamp(vertex.colour, 0.0F, 1.0F) + 0.5F)};
}

bool isHoled(const Material& material) {
  return material.coverageCutoff > 0.0F;
}

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

float linearFromSrgb(float srgb) {
  return srgb <= 0.04045F ? srgb / 12.92F : std::pow((srgb + 0.055F) / 1.055F, 2.4F);
}

/// What takes normals along, to within their length: the matrix of cofactors, which also mirrors
/// and flattened parts have.
glm::dmat3 normalMatrix(const glm::dmat3& m) {
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                             glm::cross(m[0], m[1]));
  const double turn = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) largest = std::max(largest, glm::length(cofactors[i]));
  return largest > 0.0 ? turn / largest * cofactors : glm::dmat3(1.0);
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
  const bool hasHoles = std::ranges::any_of(scene_.models, [](const SceneModel& each) {
    return std::ranges::any_of(each.model->materials, isHoled);
  });
  if (hasHoles) {
    toonWithHoles_ = library.draw("pipeline/scene/shaders/model.vert",
                                  "pipeline/scene/shaders/model_toon_holes.frag");
  }
  white_ = gpu::Texture(gpu::TextureFormat::kRgba8, {1, 1});
  white_.upload(std::array<std::uint8_t, 4>{255, 255, 255, 255}, 4);
  uploadModels();
  visible_.reserve(scene_.models.size());
}

void ArFrameRenderer::uploadModels() {
  GLint vertices = 0;
  for (const SceneModel& sceneModel : scene_.models) {
    const Model& model = *sceneModel.model;
    const auto known = std::ranges::find(slots_, &model, &ModelSlot::model);
    slotOfModel_.push_back(static_cast<std::size_t>(known - slots_.begin()));
    if (known != slots_.end()) continue;
    assert(model.triangleCount() <= kMaxTriangles);
    ModelSlot& slot = slots_.emplace_back();
    slot.model = &model;
    slot.sphere = boundingSphere(model);
    for (const Surface& surface : model.surfaces) {
      const auto count = static_cast<GLsizei>(3 * surface.mesh.triangles.size());
      slot.surfaces.push_back({.firstVertex = vertices, .vertexCount = count});
      vertices += count;
    }
    for (const ModelTexture& texture : model.textures) slot.textures.push_back(uploaded(texture));
  }
  if (vertices == 0) return;
  vertices_ = gpu::Buffer(static_cast<std::size_t>(vertices) * sizeof(GpuVertex),
                          gpu::BufferUsage::kStatic);
  uploadVertices();
  vertexArray_ = gpu::VertexArrayHandle::make();
  glBindVertexArray(vertexArray_.get());
  glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, offsetof(GpuVertex, position));
  glVertexAttribFormat(1, 3, GL_FLOAT, GL_FALSE, offsetof(GpuVertex, normal));
  glVertexAttribFormat(2, 2, GL_FLOAT, GL_FALSE, offsetof(GpuVertex, place));
  glVertexAttribFormat(3, 4, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(GpuVertex, colour));
  for (const GLuint attribute : {0U, 1U, 2U, 3U}) {
    glVertexAttribBinding(attribute, 0);
    glEnableVertexAttribArray(attribute);
  }
  glBindVertexBuffer(0, vertices_.name(), 0, sizeof(GpuVertex));
  glBindVertexArray(0);
}

/// Surface by surface, so that memory holds the largest twice and not all.
void ArFrameRenderer::uploadVertices() {
  std::vector<GpuVertex> vertices;
  for (const ModelSlot& slot : slots_) {
    for (std::size_t i = 0; i < slot.surfaces.size(); ++i) {
      const Mesh& mesh = slot.model->surfaces[i].mesh;
      vertices.clear();
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
          vertices.push_back(gpuVertex(mesh.vertices[corner]));
        }
      }
      const auto first = static_cast<std::size_t>(slot.surfaces[i].firstVertex);
      vertices_.write(std::as_bytes(std::span(vertices)), first * sizeof(GpuVertex));
    }
  }
}

ArFrameRenderer::Surfaces::Surfaces(hal::FrameSize size, bool hasModels)
    : ids(gpu::TextureFormat::kR32ui, size),
      normalFocus(gpu::TextureFormat::kRgba8, size),
      depth(gpu::TextureFormat::kDepth24, size),
      withoutColour({&ids, &normalFocus}, &depth) {
  if (!hasModels) return;
  colour = gpu::Texture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  target = gpu::RenderTarget({&colour, &ids, &normalFocus}, &depth);
}

void ArFrameRenderer::takeSurfaces(hal::FrameSize size) {
  const auto isOfSize = [&](const auto& each) { return each->ids.size() == size; };
  const auto known = std::ranges::find_if(surfaces_, isOfSize);
  now_ =
      known != surfaces_.end()
          ? known->get()
          : surfaces_.emplace_back(std::make_unique<Surfaces>(size, !scene_.models.empty())).get();
}

void ArFrameRenderer::warmUp(hal::FrameSize size) {
  takeSurfaces(size);
  if (scene_.models.empty()) return;
  const gpu::Texture picture(gpu::TextureFormat::kRgba8, size, gpu::TextureFilter::kLinear);
  drawBackground(picture);
  visible_.clear();
  for (std::size_t i = 0; i < scene_.models.size(); ++i) visible_.push_back({.model = i});
  setCamera(assumedCamera(size));
  drawModels(hal::Duration::zero());
  now_->showsCameraOnly = false;
}

const ArFrame& ArFrameRenderer::compose(const gpu::Texture& picture,
                                        const tracking::CameraModel& camera, const PoseSet& poses,
                                        std::uint64_t sequence, hal::TimePoint captureTime,
                                        gpu::PassTimer& timer) {
  assert(picture.size() == camera.imageSize());
  const auto scope = timer.measure("compose");
  takeSurfaces(picture.size());
  if (!firstTime_) firstTime_ = captureTime;
  findVisible(poses);
  frame_ = kCameraOnly;
  if (visible_.empty()) {
    clearToCamera();
  } else {
    drawBackground(picture);
    setCamera(camera);
    drawModels(captureTime - *firstTime_);
    now_->showsCameraOnly = false;
  }
  frame_.colour = visible_.empty() ? &picture : &now_->colour;
  frame_.ids = &now_->ids;
  frame_.normalFocus = &now_->normalFocus;
  frame_.depth = &now_->depth;
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
    const ModelSlot& slot = slots_[slotOfModel_[i]];
    const DepthSpan span = depthSpan(slot.sphere, cameraFromModel);
    if (span.farthest <= kNearestMetres || slot.model->triangleCount() == 0) continue;
    visible_.push_back({i, *attach, cameraFromModel});
  }
}

void ArFrameRenderer::clearToCamera() {
  if (now_->showsCameraOnly) return;
  now_->withoutColour.beginDiscarding();
  now_->withoutColour.clearUnsigned(0, glm::uvec4(0U));
  now_->withoutColour.clearColour(1, kNoNormal);
  now_->withoutColour.clearDepth();
  now_->showsCameraOnly = true;
}

void ArFrameRenderer::drawBackground(const gpu::Texture& picture) {
  // Depth is cleared where the pass begins: later, a tile-based GPU would split it (GPU rules, 10).
  now_->target.beginDiscarding();
  now_->target.clearDepth();
  background_.use().texture("picture", picture).drawArea(now_->target, {0, 0}, now_->target.size());
}

void ArFrameRenderer::setCamera(const tracking::CameraModel& camera) {
  double nearest = HUGE_VAL;
  double farthest = kNearestMetres * kFarthestByNearest;
  for (const Visible& visible : visible_) {
    const auto span =
        depthSpan(slots_[slotOfModel_[visible.model]].sphere, visible.cameraFromModel);
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
  for (gpu::Program* program : {&toon_, &toonWithHoles_}) {
    if (!*program) continue;
    program->use()
        .set("clipFocal", glm::vec2(2.0 * glm::dvec2(pinhole.fx, pinhole.fy) / size))
        .set("clipCentre", glm::vec2(2.0 * glm::dvec2(pinhole.cx, pinhole.cy) / size - 1.0))
        .set("clipDepth",
             glm::vec2((farthest + nearest) / range, -2.0 * farthest * nearest / range))
        .set("radial", glm::vec3(lens.k1, lens.k2, lens.k3))
        .set("tangential", glm::vec2(lens.p1, lens.p2))
        .set("radialBelow", glm::vec3(lens.k4, lens.k5, lens.k6))
        .set("trustedRadius", static_cast<float>(trustedLensRadius(lens)));
  }
}

void ArFrameRenderer::drawModels(hal::Duration time) {
  if (!vertexArray_) return;
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glBindVertexArray(vertexArray_.get());
  for (const Visible& visible : visible_) drawModel(visible, time);
  glBindVertexArray(0);
  glFrontFace(GL_CCW);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

void ArFrameRenderer::drawModel(const Visible& visible, hal::Duration time) {
  const SceneModel& model = scene_.models[visible.model];
  const ModelSlot& slot = slots_[slotOfModel_[visible.model]];
  const glm::dmat3 cameraFromLight(
      scene_.light.frame == Light::Frame::kCamera ? kTagFromAttach : visible.cameraFromAttach);
  for (gpu::Program* program : {&toon_, &toonWithHoles_}) {
    if (!*program) continue;
    program->use()
        .set("towardLight", glm::vec3(cameraFromLight * scene_.light.towardLight))
        .set("object", static_cast<unsigned>(visible.model + 1))
        .set("focus", model.focus);
  }
  for (const ModelPart& part : slot.model->parts) {
    drawPart(slot, model, part, visible.cameraFromModel * modelFromPart(part, time));
  }
}

void ArFrameRenderer::drawPart(const ModelSlot& slot, const SceneModel& model,
                               const ModelPart& part, const glm::dmat4& cameraFromPart) {
  const glm::dmat3 linear(cameraFromPart);
  // Image rows go down, GL's go up; a mirrored part turns its triangles round again.
  glFrontFace(glm::determinant(linear) < 0.0 ? GL_CCW : GL_CW);
  auto firstTriangle = static_cast<unsigned>(part.firstTriangle);
  for (std::size_t i = 0; i < part.surfaceCount; ++i) {
    const std::size_t index = part.firstSurface + i;
    const SurfaceSlot& surface = slot.surfaces[index];
    const Material& material = slot.model->materials[slot.model->surfaces[index].material];
    setMaterial(slot, model, material);
    programOf(material)
        .set("cameraFromPart", glm::mat4(cameraFromPart))
        .set("cameraFromPartNormals", glm::mat3(normalMatrix(linear)))
        .set("firstVertex", surface.firstVertex)
        .set("firstTriangle", firstTriangle);
    glDrawArrays(GL_TRIANGLES, surface.firstVertex, surface.vertexCount);
    firstTriangle += static_cast<unsigned>(surface.vertexCount) / 3;
  }
}

gpu::Program& ArFrameRenderer::programOf(const Material& material) {
  return isHoled(material) ? toonWithHoles_ : toon_;
}

void ArFrameRenderer::setMaterial(const ModelSlot& slot, const SceneModel& model,
                                  const Material& material) {
  const glm::vec4 tint(linearFromSrgb(model.srgb.r), linearFromSrgb(model.srgb.g),
                       linearFromSrgb(model.srgb.b), 1.0F);
  gpu::Program& program = programOf(material);
  program.use()
      .set("baseColour", tint * material.baseColour)
      .texture("baseTexture", material.texture ? slot.textures[*material.texture] : white_);
  if (isHoled(material)) program.set("coverageCutoff", material.coverageCutoff);
  (material.isDoubleSided ? glDisable : glEnable)(GL_CULL_FACE);
}

}  // namespace pleinair::scene

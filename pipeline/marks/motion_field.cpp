#include "pipeline/marks/motion_field.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "hal/median.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/scene_uniforms.h"

namespace pleinair::marks {
namespace {

using tracking::FeatureMotion;
using tracking::ImageMotion;

static_assert(static_cast<int>(MotionSource::kPlane) ==
              static_cast<int>(scene::SurfaceMotionSource::kPlane));

const std::string kShaders = "pipeline/marks/shaders/";

/// Same layout as in shaders/image_motion.glsl.
struct GpuFeature {
  glm::vec2 then{0.0F};
  glm::vec2 now{0.0F};
  glm::vec4 about{0.0F};
};
struct GpuMotion {
  glm::mat4 currentFromPrevious{1.0F};
  glm::mat4 previousFromCurrent{1.0F};
  glm::vec4 flowGrid{0.0F};
  glm::vec4 stillGrid{0.0F};
  glm::vec4 known{0.0F};
  glm::vec4 nodes{0.0F};
  glm::vec4 fullByFrame{1.0F, 1.0F, 0.0F, 0.0F};
};

glm::vec2 vec(hal::FrameSize size) {
  return {size.width, size.height};
}

/// Maps px of the full image to nodes of a grid whose cells are `step` frame px wide: × xy + zw.
glm::vec4 gridOf(const scene::MeasuredMotion& movement, glm::dvec2 step, double shift) {
  const glm::dvec2 scale = movement.frameScale / step;
  return {glm::vec2(scale), glm::vec2(movement.frameOrigin / step + shift)};
}

/// Converts a homography to px of the full image; the identity stays exact.
glm::dmat3 ofFull(const glm::dmat3& ofFrame, const scene::MeasuredMotion& movement) {
  if (ofFrame == glm::dmat3(1.0)) return ofFrame;
  const glm::dmat3 frameFromFull(movement.frameScale.x, 0.0, 0.0,  //
                                 0.0, movement.frameScale.y, 0.0,  //
                                 movement.frameOrigin.x, movement.frameOrigin.y, 1.0);
  return glm::inverse(frameFromFull) * ofFrame * frameFromFull;
}

/// Parallax: the motion of the features relative to the image's homography, beyond their own
/// errors. Gives the variance over both axes, px² of the frame, of the half of the features that
/// fits better.
float parallaxVariance(const ImageMotion& motion) {
  constexpr std::size_t kMinFeatures = 16;
  const std::size_t count = std::min(motion.features.size(), tracking::kMaxMovedFeatures);
  if (!motion.picture || count < kMinFeatures) return 0.0F;
  std::array<float, tracking::kMaxMovedFeatures> apart{};
  std::array<float, tracking::kMaxMovedFeatures> expected{};
  for (std::size_t i = 0; i < count; ++i) {
    const FeatureMotion& each = motion.features[i];
    const glm::dvec3 there = motion.picture->currentFromPrevious * glm::dvec3(each.previous, 1.0);
    const glm::vec2 off(glm::dvec2(each.current) - glm::dvec2(there) / there.z);
    apart.at(i) = glm::dot(off, off);
    expected.at(i) = each.errorPx * each.errorPx;
  }
  constexpr float kMedianOfMean = 0.693F;  // for the square of a 2D normal deviate
  return std::max(0.0F, hal::medianOf(std::span(apart).first(count)) / kMedianOfMean -
                            hal::medianOf(std::span(expected).first(count)));
}

}  // namespace

struct MotionField::State {
  State(const gpu::ShaderLibrary& library, hal::FrameSize fullSize)
      : full(fullSize),
        makeField(library.compute(kShaders + "motion_field.comp")),
        findLayers(library.compute(kShaders + "feature_layers.comp")),
        field(gpu::TextureFormat::kRgba16f,
              {(full.width + kFieldPixels - 1) / kFieldPixels,
               (full.height + kFieldPixels - 1) / kFieldPixels},
              gpu::TextureFilter::kLinear),
        motion(sizeof(GpuMotion), gpu::BufferUsage::kDynamic),
        features(tracking::kMaxMovedFeatures * sizeof(GpuFeature), gpu::BufferUsage::kDynamic),
        noPlanes(scene::kMaxPlanes * scene::SurfaceAccess::kBodyBytes, gpu::BufferUsage::kStatic),
        camera(scene::assumedCamera(full)) {
    const std::vector<std::byte> zeros(noPlanes.sizeBytes());
    noPlanes.write(zeros);
  }

  hal::FrameSize full;
  gpu::Program makeField;
  gpu::Program findLayers;
  gpu::Texture field;
  gpu::Texture flowForward;
  gpu::Texture flowBackward;
  gpu::Texture still;
  gpu::Buffer motion;
  gpu::Buffer features;
  gpu::Buffer noPlanes;
  const gpu::Buffer* planes = nullptr;
  tracking::CameraModel camera;  // for the size of the last update
  glm::vec2 pixelsOfFull{1.0F};
  std::array<GpuFeature, tracking::kMaxMovedFeatures> staged{};
  std::optional<std::uint64_t> last;  // the frame that was updated
  bool isCut = true;
  bool follows = true;
  bool isStanding = false;
  double noiseLevels = tracking::kUsualNoiseLevels;

  void takePicture(const scene::MeasuredMotion& movement, GpuMotion& made);
  void takeFeatures(const scene::MeasuredMotion& movement, GpuMotion& made);
  void takeGrids(const scene::MeasuredMotion& movement, GpuMotion& made);
  void takeScene(const scene::ArFrame& frame, GpuMotion& made);
  void layFeatures(const scene::ArFrame& frame, int count);
  void bind(gpu::Program& program, const gpu::Texture& flow) const;
};

namespace {

void upload(gpu::Texture& texture, gpu::TextureFormat format, hal::FrameSize size,
            std::span<const std::byte> bytes) {
  const hal::FrameSize held = bytes.empty() ? hal::FrameSize{1, 1} : size;
  if (!texture || texture.size() != held) texture = gpu::Texture(format, held);
  if (bytes.empty()) return;
  const auto* const first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  texture.upload({first, bytes.size()}, bytes.size() / static_cast<std::size_t>(size.height));
}

}  // namespace

void MotionField::State::takePicture(const scene::MeasuredMotion& movement, GpuMotion& made) {
  if (!movement.motion->picture) return;
  const glm::dmat3 currentFromPrevious =
      ofFull(movement.motion->picture->currentFromPrevious, movement);
  const glm::dmat3 back = currentFromPrevious == glm::dmat3(1.0)
                              ? currentFromPrevious
                              : glm::inverse(currentFromPrevious);
  made.currentFromPrevious = glm::mat4(glm::mat3(currentFromPrevious / currentFromPrevious[2][2]));
  made.previousFromCurrent = glm::mat4(glm::mat3(back / back[2][2]));
  made.known.z = 1.0F;
  made.known.w = static_cast<float>(movement.motion->picture->errorPx / movement.frameScale.x);
}

void MotionField::State::takeFeatures(const scene::MeasuredMotion& movement, GpuMotion& made) {
  const std::span<const FeatureMotion> moved = movement.motion->features;
  const std::size_t count = std::min(moved.size(), staged.size());
  const glm::vec2 scale(1.0 / movement.frameScale);
  const glm::vec2 origin(movement.frameOrigin);
  for (std::size_t i = 0; i < count; ++i) {
    staged[i] = {.then = (moved[i].previous - origin) * scale,
                 .now = (moved[i].current - origin) * scale,
                 .about = glm::vec4(moved[i].errorPx * scale.x, 0.0F, 0.0F, 0.0F)};
  }
  made.known.y = static_cast<float>(count);
  made.nodes.y = parallaxVariance(*movement.motion) * scale.x * scale.x;
  if (count > 0) features.write(std::as_bytes(std::span(staged).first(count)));
}

void MotionField::State::takeGrids(const scene::MeasuredMotion& movement, GpuMotion& made) {
  const tracking::DenseFlow& dense = movement.motion->flow;
  const std::size_t nodes = dense.forward.size();
  assert(nodes == dense.backward.size());
  upload(flowForward, gpu::TextureFormat::kRgba32f, dense.nodes, std::as_bytes(dense.forward));
  upload(flowBackward, gpu::TextureFormat::kRgba32f, dense.nodes, std::as_bytes(dense.backward));
  if (nodes > 0) {
    made.flowGrid = gridOf(movement, glm::dvec2(dense.stepPx), -0.5);
    made.nodes.x = static_cast<float>(nodes);
  }
  const tracking::StaticRegions& fields = movement.motion->still;
  upload(still, gpu::TextureFormat::kR32f, fields.fields, std::as_bytes(fields.errorPx));
  if (!fields.errorPx.empty()) {
    const hal::FrameSize frame = movement.motion->frameSize;
    made.stillGrid = gridOf(movement, glm::dvec2(vec(frame)) / glm::dvec2(vec(fields.fields)), 0.0);
    made.nodes.z = static_cast<float>(fields.errorPx.size());
  }
  made.fullByFrame = glm::vec4(glm::vec2(1.0 / movement.frameScale), 0.0F, 0.0F);
}

void MotionField::State::takeScene(const scene::ArFrame& frame, GpuMotion& made) {
  planes = &noPlanes;
  pixelsOfFull = glm::vec2(frame.pixelsOfFull());
  if (!frame.surfaces) return;
  camera = *frame.surfaces->camera;
  if (frame.surfaces->planeCount == 0) return;
  planes = frame.surfaces->bodies;
  made.known.x = static_cast<float>(frame.surfaces->planeCount);
}

/// Layers exist only in scenes with real objects.
void MotionField::State::layFeatures(const scene::ArFrame& frame, int count) {
  if (count == 0 || !frame.surfaces || !frame.hasObjects) return;
  const auto isReal = [](std::uint32_t object) { return object >= scene::kRealObject; };
  if (std::ranges::none_of(frame.surfaces->objects, isReal)) return;
  findLayers.use()
      .storage("Features", features)
      .texture("ids", *frame.ids)
      .set("pixelsOfFull", pixelsOfFull)
      .set("count", count)
      .dispatch({count, 1}, GL_UNIFORM_BARRIER_BIT);
}

void MotionField::State::bind(gpu::Program& program, const gpu::Texture& flow) const {
  const tracking::Intrinsics& pinhole = camera.intrinsics();
  program.uniformBlock("Planes", *planes, 0, scene::kMaxPlanes * scene::SurfaceAccess::kBodyBytes)
      .uniformBlock("Motion", motion, 0, motion.sizeBytes())
      .uniformBlock("Features", features, 0, features.sizeBytes())
      .texture("flow", flow)
      .texture("still", still)
      .set("focal", glm::vec2(pinhole.fx, pinhole.fy) / pixelsOfFull)
      .set("centre", glm::vec2(pinhole.cx, pinhole.cy) / pixelsOfFull);
  scene::setLens(program, camera);
}

MotionField::MotionField(const gpu::ShaderLibrary& library, hal::FrameSize full)
    : state_(std::make_unique<State>(library, full)) {}

MotionField::~MotionField() = default;

void MotionField::update(const scene::ArFrame& frame, const MotionFieldOptions& options) {
  State& s = *state_;
  assert(frame.full() == s.full);
  GpuMotion made;
  s.takeScene(frame, made);
  static constexpr ImageMotion kNothing;
  static constexpr ImageMotion kRest{.picture = tracking::ImageHomography{}};
  scene::MeasuredMotion movement = frame.measuredMotion.value_or(scene::MeasuredMotion{});
  const bool follows = s.last && (!movement.motion || movement.motion->sinceSequence == *s.last);
  const bool isNoiseKnown = movement.motion != nullptr && movement.motion->noiseLevels > 0.0;
  s.noiseLevels = isNoiseKnown ? movement.motion->noiseLevels : tracking::kUsualNoiseLevels;
  s.isCut = !follows || (movement.motion != nullptr && movement.motion->isCut);
  if (s.isCut || movement.motion == nullptr) movement.motion = &kNothing;
  if (!options.follows && !s.isCut) movement.motion = &kRest;
  if (s.isCut || !options.follows) made.known.x = 0.0F;
  s.follows = options.follows;
  s.isStanding =
      movement.motion->picture && movement.motion->picture->currentFromPrevious == glm::dmat3(1.0);
  s.takePicture(movement, made);
  s.takeFeatures(movement, made);
  s.takeGrids(movement, made);
  s.motion.write(std::as_bytes(std::span(&made, 1)));
  s.last = frame.sequence;

  s.layFeatures(frame, static_cast<int>(made.known.y));
  s.makeField.use();
  s.bind(s.makeField, s.flowBackward);
  s.makeField.image("field", s.field, gpu::ImageAccess::kWrite)
      .set("fieldPixels", static_cast<float>(kFieldPixels))
      .dispatch({s.field.size().width, s.field.size().height},
                GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

bool MotionField::isCut() const {
  return state_->isCut;
}

bool MotionField::follows() const {
  return state_->follows;
}

bool MotionField::isStanding() const {
  return state_->isStanding;
}

double MotionField::noiseLevels() const {
  return state_->noiseLevels;
}

const gpu::Texture& MotionField::backward() const {
  return state_->field;
}

void MotionField::bind(gpu::Program& program) const {
  state_->bind(program, state_->flowForward);
}

void MotionField::bindBackward(gpu::Program& program) const {
  state_->bind(program, state_->flowBackward);
}

void MotionField::reset() {
  state_->last.reset();
  state_->isCut = true;
}

}  // namespace pleinair::marks

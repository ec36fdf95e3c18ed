#include "tests/reports/anchors/anchor_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

constexpr std::uint32_t kModel = 1;  // the model's object id

scene::Scene sceneOf(std::shared_ptr<const scene::Model> model) {
  scene::Scene scene;
  if (model) scene.models.push_back({.model = std::move(model)});
  return scene;
}

gpu::Texture groundOf(hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  std::ranges::fill(image.plane(0), std::uint8_t{255});
  return support::textureOf(image.view());
}

}  // namespace

AnchorStage::AnchorStage(std::shared_ptr<const scene::Model> model, DensityRule rule)
    : model_(std::move(model)), camera_(scene::assumedCamera(kSize)), ground_(groundOf(kSize)) {
  library_.add(gpu::gpuShaders());
  library_.add(gpu::sceneShaders());
  library_.add(gpu::marksShaders());
  renderer_.emplace(library_, sceneOf(model_));
  field_.emplace(library_, kSize);
  anchors_.emplace(library_, kSize, AnchorOptions{.density = rule});
}

void AnchorStage::advance(const glm::dmat4& cameraFromModel, const glm::dmat3& currentFromPrevious,
                          const AnchorHold& hold) {
  tracking::ImageMotion motion;
  motion.frameSize = kSize;
  motion.sinceSequence = sequence_;
  motion.picture =
      tracking::ImageHomography{.currentFromPrevious = currentFromPrevious, .errorPx = 0.01};
  ++sequence_;
  cameraFromModel_ = cameraFromModel;
  frame_ = renderer_->compose(ground_, camera_, {.cameraFromWorld = cameraFromModel}, sequence_,
                              hal::TimePoint(kStep * static_cast<int>(sequence_)),
                              {.surfaces = true, .measuredMotion = true});
  frame_.measuredMotion = scene::MeasuredMotion{.motion = &motion};
  field_->update(frame_);
  anchors_->advance(frame_, *field_, hold);
  frame_.measuredMotion.reset();  // it does not outlive this call
}

std::vector<glm::dvec2> AnchorStage::places() const {
  std::vector<glm::dvec2> places;
  for (const Anchor& each : anchors_->read()) {
    const bool isOnModel = each.surface >> scene::kTriangleBits == kModel;
    if (each.isStaying() && isOnModel == (model_ != nullptr)) places.emplace_back(each.px);
  }
  return places;
}

std::vector<std::uint32_t> AnchorStage::ids() const {
  return support::readR32ui(*frame_.ids);
}

CellGrid AnchorStage::grid() const {
  std::vector<bool> covered(static_cast<std::size_t>(kSize.pixels()), model_ == nullptr);
  if (model_ && frame_.hasObjects) {
    const std::vector<std::uint32_t> shown = ids();
    for (std::size_t i = 0; i < shown.size(); ++i) {
      covered[i] = shown[i] >> scene::kTriangleBits == kModel;
    }
  }
  return {kSize, kCellPixels, covered};
}

std::vector<Triangle> AnchorStage::triangles() const {
  const hal::Duration elapsed = kStep * static_cast<int>(sequence_ - 1);
  scene::ModelPose pose;
  scene::poseModel(*model_, std::nullopt, elapsed, pose);
  return trianglesOf(*model_, pose, cameraFromModel_);
}

std::vector<glm::dvec2> AnchorStage::seen(std::span<const SurfaceSample> samples) const {
  constexpr double kTolerance = 0.004;  // of the distance
  const std::vector<Triangle> posed = triangles();
  const std::vector<std::uint32_t> shown = ids();
  std::vector<glm::dvec2> places;
  for (const SurfaceSample& sample : samples) {
    const glm::dvec3 place = sample.on(posed);
    if (place.z <= 0.0) continue;
    const glm::dvec2 px = camera_.project(place);
    const glm::ivec2 pixel(glm::floor(px));
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= kSize.width || pixel.y >= kSize.height) continue;
    const std::uint32_t id = shown[static_cast<std::size_t>(pixel.y * kSize.width + pixel.x)];
    if (id >> scene::kTriangleBits != kModel) continue;
    // Whether the surface drawn there is as far away as the sample, on the ray through it.
    const auto& [a, b, c] = posed[id & (scene::kMaxTriangles - 1)];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    // relative to the sample's distance
    const double away = glm::dot(normal, a) / glm::dot(normal, place);
    if (std::abs(away - 1.0) < kTolerance) places.push_back(px);
  }
  return places;
}

hal::Image AnchorStage::picture() const {
  return support::readRgba8(*frame_.colour);
}

}  // namespace pleinair::marks

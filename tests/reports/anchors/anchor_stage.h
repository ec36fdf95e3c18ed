#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "hal/image.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/measure/baselines/area_sampling.h"
#include "pipeline/measure/baselines/cell_counts.h"
#include "pipeline/scene/render/ar_frame_renderer.h"

namespace pleinair::marks {

using measure::CellCounts;
using measure::CellGrid;
using measure::sampleByArea;
using measure::SurfaceSample;
using measure::Triangle;
using measure::trianglesOf;

/// A sequence of frames of a scene with at most one model, and its anchors. All calls on the thread
/// of the GL context that was current at construction.
class AnchorStage {
 public:
  static constexpr hal::FrameSize kSize{640, 480};
  static constexpr hal::Duration kStep = std::chrono::milliseconds(33);
  static constexpr int kCellPixels = 8;

  /// `model` may be null: the camera image alone.
  explicit AnchorStage(std::shared_ptr<const scene::Model> model, DensityRule rule = {});

  /// The next frame: the model is placed so, the picture moved so.
  void advance(const glm::dmat4& cameraFromModel,
               const glm::dmat3& currentFromPrevious = glm::dmat3(1.0),
               const AnchorHold& hold = {});

  std::vector<Anchor> anchors() const { return anchors_->read(); }
  /// The places of the staying anchors on the model; without a model, of all.
  std::vector<glm::dvec2> places() const;
  /// The cells that show the model; without a model, all cells.
  CellGrid grid() const;
  /// The image positions of the visible samples.
  std::vector<glm::dvec2> seen(std::span<const SurfaceSample> samples) const;
  /// The model's triangles in their current pose, in the camera's frame.
  std::vector<Triangle> triangles() const;
  hal::Image picture() const;

  const tracking::CameraModel& camera() const { return camera_; }

 private:
  std::vector<std::uint32_t> ids() const;

  gpu::ShaderLibrary library_;
  std::shared_ptr<const scene::Model> model_;
  tracking::CameraModel camera_;
  gpu::Texture ground_;
  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
  std::optional<AnchorSet> anchors_;
  scene::ArFrame frame_;
  glm::dmat4 cameraFromModel_{1.0};
  std::uint64_t sequence_ = 0;
};

}  // namespace pleinair::marks

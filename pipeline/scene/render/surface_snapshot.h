#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/models/limits.h"
#include "pipeline/scene/render/drawn_model.h"
#include "pipeline/scene/render/posed_geometry.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::scene {

/// What an AR frame shows of its models, in memory: which point of which surface each pixel shows,
/// and where any point of the visible models is in the image, also where something hides it. Two
/// snapshots give the exact motion between their frames, however far they are apart. A value type.
class SurfaceSnapshot {
 public:
  /// A model as posed in this frame.
  struct PosedObject {
    std::uint32_t object = 0;  ///< as in ArFrame::ids
    std::uint32_t firstTriangle = 0;
    glm::dmat4 cameraFromModel{1.0};
    std::vector<glm::vec3> vertices;  ///< model's frame, metres
  };
  struct Content {
    hal::FrameSize size;
    std::vector<std::uint32_t> ids;           ///< ArFrame::ids, row by row
    std::vector<std::uint32_t> barycentrics;  ///< ArFrame::barycentrics
    std::vector<PosedObject> objects;
    std::shared_ptr<const std::vector<DrawnTriangle>> triangles;
    std::optional<tracking::CameraModel> camera;
  };

  /// Shows the camera's image alone.
  explicit SurfaceSnapshot(hal::FrameSize size);
  explicit SurfaceSnapshot(Content content) : content_(std::move(content)) {}

  hal::FrameSize size() const { return content_.size; }
  /// The object and triangle at a pixel; 0: the camera's image.
  std::uint32_t id(int x, int y) const { return content_.ids[index(x, y)]; }
  /// Barycentric coordinates of the triangle's first two corners at a pixel.
  glm::vec2 barycentrics(int x, int y) const;
  /// Where a point of a surface is in this frame (px, pixel centres at +0.5), whether it is hidden
  /// or not. Nothing where its model is not visible, or the point is behind the camera.
  std::optional<glm::dvec2> place(std::uint32_t id, glm::vec2 barycentrics) const;
  /// The same point in the camera's frame, metres. Nothing where its model is not visible.
  std::optional<glm::dvec3> inCamera(std::uint32_t id, glm::vec2 barycentrics) const;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(content_.size.width) +
           static_cast<std::size_t>(x);
  }
  Content content_;
};

/// Reads snapshots. Waits for the GPU: for measures and tests. On the thread of the GL context.
class SurfaceReader {
 public:
  /// The frame as it was composed: `visible` are indices of models in the scene, `objects` the ids
  /// of all models. Models that the GPU cannot give (it is lost) are left out.
  SurfaceSnapshot read(const PosedGeometry& geometry, const SceneBodies& bodies,
                       std::span<const std::size_t> visible, std::span<const std::uint32_t> objects,
                       const tracking::CameraModel& camera, const gpu::Texture& ids,
                       const gpu::Texture& barycentrics);

 private:
  std::shared_ptr<const std::vector<DrawnTriangle>> triangles_;  // they never change
};

}  // namespace pleinair::scene

#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "firmware_app/overlay/machine.h"
#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/inspection/part_window.h"
#include "pipeline/scene/models/model.h"
#include "pipeline/scene/render/ar_frame_renderer.h"

namespace pleinair {

/// A part of the gearbox, and how it can be put in the wrong way.
struct CheckedPart {
  std::string name;
  glm::dvec3 turnAxis;  ///< in the part's frame, through its middle
};

/// How the machine is in a still.
struct PartState {
  bool isMissing = false;
  double turnedDeg = 0.0;  ///< about CheckedPart::turnAxis
  bool isShaded = false;   ///< light from elsewhere, and the edge of a cast shadow across the part
};

/// A still, and where tracking would place the machine in it.
struct PartStill {
  hal::Image image;  ///< grey
  tracking::CameraModel camera;
  glm::dmat4 cameraFromModel{1.0};
  inspection::PosedPicture posed() const { return {image.view(), camera, cameraFromModel}; }
};

/// The built-in gearbox without its cover's bolts in the way, rendered about one part after the
/// other, with the errors that pictures of cameras have. Needs a current GL context.
class RenderedParts {
 public:
  explicit RenderedParts(std::span<const CheckedPart> parts);

  /// The picture of part `index` as it should be, from the side that shows most of it, with the
  /// pose as it is.
  PartStill templateOf(std::size_t index);
  /// A still from `azimuthDeg`, `elevationDeg` beside the template's place. Its light has a gain of
  /// 0.7 to 1.2, its pixels noise of 3 grey levels, its pose errors of 0.3 mm and 0.25°: by `seed`.
  PartStill still(std::size_t index, const PartState& state, double azimuthDeg, double elevationDeg,
                  unsigned seed);
  const app::PartSurface& surface(std::size_t index) const { return surfaces_[index]; }

 private:
  struct Look {
    double azimuthDeg = 0.0;
    double elevationDeg = 0.0;
  };
  glm::dmat4 cameraAt(std::size_t index, const Look& look) const;
  hal::Image render(std::size_t index, const PartState& state, const glm::dmat4& cameraFromModel);
  Look bestLook(std::size_t index);
  const scene::ArFrame& compose(std::size_t index, const PartState& state,
                                const glm::dmat4& cameraFromModel);

  std::vector<CheckedPart> parts_;
  scene::Model machine_;
  std::vector<std::size_t> indices_;  // of the parts in the machine
  std::vector<app::PartSurface> surfaces_;
  std::vector<std::optional<Look>> looks_;  // that show most of each part
  gpu::ShaderLibrary library_;
  gpu::Texture paper_;
  std::unique_ptr<scene::ArFrameRenderer> usual_;
  std::unique_ptr<scene::ArFrameRenderer> fromElsewhere_;
  std::uint64_t sequence_ = 0;
};

}  // namespace pleinair

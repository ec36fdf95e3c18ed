#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::scene {

/// How surfaces are shaded; a style asks for one.
enum class Shading {
  kToon = 0,   ///< three bands (thesis §3.2.2), whose edges are clean
  kSmooth = 1  ///< as a camera would see them
};

/// Object ids of ArFrame::ids: the camera's picture is 0, models count from 1 in the scene's order;
/// occluders have kRealObject added, for what is seen there is the camera's picture.
inline constexpr std::uint32_t kCameraObject = 0;
/// ArFrame::ids packs an object (upper bits) and a triangle of it (lower bits).
inline constexpr std::uint32_t kTriangleBits = 22;
inline constexpr std::uint32_t kRealObject = 1U << (31U - kTriangleBits);
inline constexpr std::uint32_t kMaxObjects = kRealObject - 1U;
inline constexpr std::uint32_t kMaxTriangles = 1U << kTriangleBits;

/// Where a pixel's motion is known from.
enum class SurfaceMotionSource {
  kUnknown = 0,  ///< nothing is known; the displacement says nothing
  kSurface = 1,  ///< a model's surface: exact for a virtual one, its pose's error for an occluder
  kPlane = 2,    ///< a plane of the scene, as far as the poses are right
};

/// How far what each pixel shows has come since a frame before. Displacements lead from where it
/// was, in px of this picture, to the pixel's centre; where it was may be outside the picture, or
/// hidden then.
struct SurfaceMotion {
  /// RGBA16F: displacement (px; x right, y down), its predicted error (px, one standard deviation
  /// over both axes; 0: exact), SurfaceMotionSource. Displacements are rounded to 11 bits.
  const gpu::Texture* texture = nullptr;
  std::uint64_t sinceSequence = 0;  ///< the frame that it refers to
  hal::TimePoint sinceTime;
};

/// A scene's bodies on the GPU, for who follows points of them: models' triangles as they are posed
/// in this frame and the one before, and where models and planes are. shaders/surface_point.glsl
/// and shaders/bodies.glsl read them.
struct SurfaceAccess {
  const gpu::Buffer* posed = nullptr;      ///< PosedGeometry::posed(); null without models
  const gpu::Buffer* triangles = nullptr;  ///< PosedGeometry::triangles(); likewise
  /// A uniform block of kBodyBytes a body: kMaxPlanes planes, then the models in the scene's order.
  const gpu::Buffer* bodies = nullptr;
  static constexpr std::size_t kBodyBytes = 512;
  std::size_t planeCount = 0;
  std::span<const std::size_t> models;            ///< those seen, as the scene counts them
  std::span<const std::uint32_t> objects;         ///< of each model of the scene: its object id
  const tracking::CameraModel* camera = nullptr;  ///< of pictures of ArFrame::size()
};

/// How the camera's picture moved, where that was asked for.
struct MeasuredMotion {
  const tracking::ImageMotion* motion = nullptr;  ///< in px of the captured frame
  /// px of the frame = px of the full picture · scale + origin.
  glm::dvec2 frameScale{1.0};
  glm::dvec2 frameOrigin{0.0};
};

/// What a style may ask for beyond what every AR frame has.
struct ArFrameNeeds {
  /// ArFrame::motion, barycentrics, parts and surfaces; of a scene that has any
  bool surfaces = false;
  bool measuredMotion = false;       ///< ArFrame::measuredMotion
  bool canvas = false;               ///< ArFrame::canvasFromPicture, which costs a little to find
  Shading shading = Shading::kToon;  ///< of models
};

/// What a style is given: the camera's picture with the virtual objects composed over it, and what
/// is known about each pixel. All textures have the size of `colour`, row 0 at the top; they are
/// valid until the next frame is composed.
struct ArFrame {
  const gpu::Texture* colour = nullptr;  ///< RGBA8, sRGB-coded, LINEAR filter
  const gpu::Texture* ids = nullptr;     ///< R32UI: object << kTriangleBits | triangle
  const gpu::Texture* normalFocus =
      nullptr;                          ///< RGBA8: camera-frame normal · 0.5 + 0.5; focus in A
  const gpu::Texture* depth = nullptr;  ///< kDepth24, window depth; 1 where no object is
  /// Where asked for, else null. R32UI: the barycentric coordinates of the first two corners of the
  /// triangle (PosedGeometry::triangles()), 16-bit unorms, the first in the lower half: with ids
  /// the exact point of the surface. 0 where no object is.
  const gpu::Texture* barycentrics = nullptr;
  /// Where asked for, else null. R32UI: like ids, with the number of the part (Model::parts).
  const gpu::Texture* parts = nullptr;
  /// Where asked for, and there is a frame before since the last reset.
  std::optional<SurfaceMotion> motion;
  std::optional<SurfaceAccess> surfaces;  ///< where asked for, of a scene that has any
  /// Where asked for.
  std::optional<MeasuredMotion> measuredMotion;
  bool hasObjects = false;  ///< whether any virtual object may be seen; without, ids are all 0
  bool hasFocus = false;    ///< whether any pixel's focus may be above 0
  float nearMetres = 0.0F;  ///< the depth range's planes, for linear depth
  float farMetres = 0.0F;
  /// Takes px of the full picture to px of a flat canvas that goes along with the picture as a
  /// whole (tracking::CanvasMotion); the identity where nothing is followed.
  tracking::PlaneSimilarity canvasFromPicture;
  std::uint64_t sequence = 0;  ///< of the captured frame
  hal::TimePoint captureTime;

  /// Of the picture that this one is a smaller version of, to save time (quality levels): the
  /// lengths that styles have in px are of that one's.
  std::optional<hal::FrameSize> fullSize;

  hal::FrameSize size() const { return colour->size(); }
  hal::FrameSize full() const { return fullSize.value_or(size()); }
  /// Px of this picture for one of the full one.
  glm::dvec2 pixelsOfFull() const {
    return glm::dvec2(size().width, size().height) / glm::dvec2(full().width, full().height);
  }
};

}  // namespace pleinair::scene

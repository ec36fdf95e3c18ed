#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/models/limits.h"
#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/faces/face_tracker.h"
#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/segments/image_segments.h"

namespace pleinair::scene {

/// Shading of models; a style chooses one.
enum class Shading {
  kToon = 0,   ///< three bands (thesis §3.2.2) with sharp edges
  kSmooth = 1  ///< as a camera would see it
};

/// Object ids of ArFrame::ids: the camera image is 0; models count from 1 in the scene's order;
/// occluders have kRealObject added, since the camera image is visible there.
inline constexpr std::uint32_t kCameraObject = 0;

/// Source of a pixel's motion.
enum class SurfaceMotionSource {
  kUnknown = 0,  ///< motion unknown; the displacement is meaningless
  kSurface = 1,  ///< a model: exact for a virtual one, with the error of its pose for an occluder
  kPlane = 2,    ///< a plane of the scene, with the error of the poses
};

/// Motion of each pixel's content since a previous frame. Displacements go from the previous
/// position, in px of this image, to the pixel's centre; the previous position may be outside of
/// the image, or hidden then.
struct SurfaceMotion {
  /// RGBA16F: displacement (px; x right, y down), its predicted error (px, one standard deviation
  /// over both axes; 0: exact), SurfaceMotionSource. Displacements are rounded to 11 bits.
  const gpu::Texture* texture = nullptr;
  std::uint64_t sinceSequence = 0;  ///< the frame that it is relative to
  hal::TimePoint sinceTime;
};

/// A scene's bodies on the GPU, for passes that follow points of them: triangles of the models as
/// posed in this frame and the previous one, and poses of models and planes.
/// shaders/surface_point.glsl and shaders/bodies.glsl read them.
struct SurfaceAccess {
  const gpu::Buffer* posed = nullptr;      ///< PosedGeometry::posed(); null without models
  const gpu::Buffer* triangles = nullptr;  ///< PosedGeometry::triangles(); null without models
  /// kBodyBytes a body (shaders/bodies.glsl), for uniform blocks or as storage: kMaxPlanes planes,
  /// then the models in the scene's order.
  const gpu::Buffer* bodies = nullptr;
  static constexpr std::size_t kBodyBytes = 512;
  std::size_t planeCount = 0;
  std::span<const std::size_t> models;            ///< indices of the visible models in the scene
  std::span<const std::uint32_t> objects;         ///< object id, per model of the scene
  const tracking::CameraModel* camera = nullptr;  ///< of images of ArFrame::size()
};

/// Measured motion of the camera image, if a style asks for it.
struct MeasuredMotion {
  const tracking::ImageMotion* motion = nullptr;  ///< in px of the captured frame
  /// px of the frame = px of the full picture · scale + origin.
  glm::dvec2 frameScale{1.0};
  glm::dvec2 frameOrigin{0.0};
};

/// Where a style paints finely (SceneFocus): a disc in the image. Px are those of this image.
struct FocusPlace {
  glm::vec2 px{0.0F};
  float radiusPx = 0.0F;
  float falloffPx = 0.0F;  ///< beyond the radius
  float strength = 1.0F;   ///< in [0, 1]
};

/// Where a virtual model stands: a convex quadrilateral in px of this image, its corners in turn.
struct Footprint {
  std::array<glm::vec2, 4> px{};
  bool operator==(const Footprint&) const = default;
};
inline constexpr std::size_t kMaxFootprints = 16;  ///< of one frame; more are left out

/// The render targets that a frame is composed in, for passes that hide models in it
/// (scene::ModelHiding).
struct Composition {
  /// ArFrame::colour, ids, normalFocus; and depth
  const gpu::RenderTarget* picture = nullptr;
  /// ArFrame::motion, barycentrics, parts, forms; null if they were not asked for
  const gpu::RenderTarget* surfaces = nullptr;
};

/// Segments of the camera image, if a style asks for them.
struct MeasuredSegments {
  const tracking::ImageSegments* segments = nullptr;  ///< in px of the captured frame
  /// px of the frame = px of the full picture · scale + origin.
  glm::dvec2 frameScale{1.0};
  glm::dvec2 frameOrigin{0.0};
};

/// Faces in the camera image, if a style asks for them.
struct MeasuredFaces {
  std::span<const tracking::Face> faces;  ///< in px of the captured frame
  /// px of the frame = px of the full picture · scale + origin.
  glm::dvec2 frameScale{1.0};
  glm::dvec2 frameOrigin{0.0};
};

/// Optional contents of an AR frame that a style may ask for.
struct ArFrameNeeds {
  /// ArFrame::motion, barycentrics, parts, forms and surfaces, if the scene has any
  bool surfaces = false;
  bool measuredMotion = false;       ///< ArFrame::measuredMotion
  bool segments = false;             ///< ArFrame::measuredSegments
  bool faces = false;                ///< ArFrame::measuredFaces
  bool canvas = false;               ///< ArFrame::canvasFromPicture, which costs a little to find
  Shading shading = Shading::kToon;  ///< of models
};

/// The input of a style: the camera image with the virtual objects composed over it, and data about
/// each pixel. All textures have the size of `colour`, row 0 at the top, but that `ids`,
/// `normalFocus` and `depth` are a single texel in scenes without models and planes; they are valid
/// until the next frame is composed.
struct ArFrame {
  const gpu::Texture* colour = nullptr;  ///< RGBA8, sRGB-coded, LINEAR filter
  /// The same without models and their shadows. Null: `colour` shows none.
  const gpu::Texture* cameraColour = nullptr;
  const gpu::Texture* ids = nullptr;  ///< R32UI: object << kTriangleBits | triangle
  const gpu::Texture* normalFocus =
      nullptr;  ///< RGBA8: camera-frame normal · 0.5 + 0.5; focus in A
  /// kDepth24, window depth; 1 where no object is. ModelHiding leaves it as it was.
  const gpu::Texture* depth = nullptr;
  /// Null unless asked for. R32UI: the barycentric coordinates of the first two corners of the
  /// triangle (PosedGeometry::triangles()), 16-bit unorms, the first in the lower half. With ids
  /// they give the exact point of the surface. 0 where there is no object.
  const gpu::Texture* barycentrics = nullptr;
  /// Null unless asked for. R32UI: like ids, with the number of the part (Model::parts).
  const gpu::Texture* parts = nullptr;
  /// Null unless asked for. R32UI: what a painter needs of models' form
  /// (shaders/surface_form.glsl): a label that changes where one thing ends and another begins, and
  /// the direction in which the surface bends least. 0 where there is no object.
  const gpu::Texture* forms = nullptr;
  /// Set if asked for and if there is a previous frame since the last reset.
  std::optional<SurfaceMotion> motion;
  std::optional<SurfaceAccess> surfaces;  ///< set if asked for and if the scene has any
  /// Set if asked for.
  std::optional<MeasuredMotion> measuredMotion;
  /// Set if asked for.
  std::optional<MeasuredSegments> measuredSegments;
  /// Set if asked for.
  std::optional<MeasuredFaces> measuredFaces;
  bool hasObjects = false;  ///< whether any virtual object may be visible; if not, all ids are 0
  bool sceneHasModels = false;
  /// Where ids and forms may be other than 0: low and high corner, px of this image. Unset:
  /// anywhere.
  std::optional<glm::ivec4> objectBounds;
  bool hasFocus = false;    ///< whether any pixel's focus may be above 0
  float nearMetres = 0.0F;  ///< planes of the depth range, for linear depth
  float farMetres = 0.0F;
  /// The scene's foci that have been seen since the last reset, each where it is, or was last.
  std::span<const FocusPlace> foci;
  /// Where the virtual models stand that may be visible.
  std::span<const Footprint> footprints;
  std::optional<Composition> composition;  ///< set if there are models
  /// Maps px of the full image to px of a flat canvas that moves with the whole image
  /// (tracking::CanvasMotion); the identity if the motion is not followed.
  tracking::PlaneSimilarity canvasFromPicture;
  std::uint64_t sequence = 0;  ///< of the captured frame
  hal::TimePoint captureTime;

  /// Size of the image that this one is a reduced version of, to save time (quality levels):
  /// lengths of styles in px refer to that size.
  std::optional<hal::FrameSize> fullSize;

  /// Whether this or another frame of the scene may have objects.
  bool mayHaveObjects() const { return hasObjects || sceneHasModels; }
  const gpu::Texture& camera() const { return cameraColour != nullptr ? *cameraColour : *colour; }
  hal::FrameSize size() const { return colour->size(); }
  /// The same for shaders, which skip the rest of the image; empty if there are no objects.
  glm::vec4 objectBoundsOrAll() const {
    if (!hasObjects) return glm::vec4(0.0F);
    return glm::vec4(objectBounds.value_or(glm::ivec4(0, 0, size().width, size().height)));
  }
  hal::FrameSize full() const { return fullSize.value_or(size()); }
  /// Px of this image per px of the full one.
  glm::dvec2 pixelsOfFull() const {
    return glm::dvec2(size().width, size().height) / glm::dvec2(full().width, full().height);
  }
};

}  // namespace pleinair::scene

#pragma once

#include <cstddef>
#include <memory>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

class SegmentMap;

/// Upper limits of two thresholds of edge strength (gradient.frag's P; a step of luma is a quarter
/// of it): of the unit of detail, and of an edge that leads strokes. Weaker edges are seen, however
/// strong others are.
inline constexpr double kMaxDetailUnit = 0.48;
inline constexpr double kMaxLeading = 0.3;

struct TensorFieldOptions {
  /// The weight of a virtual surface's own form: the edge strength (gradient.frag's P) of the form
  /// at its clearest.
  double form = 0.5;
  double fillSigma = 1.0;  ///< width of the radial-basis interpolation, in regions
  hal::Duration memory = std::chrono::milliseconds(400);  ///< time constant; 0: no memory
  double maxLeading = kMaxLeading;                        ///< in [0.05, kMaxDetailUnit]
  double slack = 0.15;  ///< a region's detail is held until it differs by more than this part
};

/// The local orientation of the image: directions of edges as tensors, extended to regions without
/// edges by a pyramid (thesis §4.2). A tensor is (cos 2θ, sin 2θ) times the agreement of its
/// pixels, θ the gradient's direction; strokes run across it. The background, movers and virtual
/// objects have tensors of their own, so that what passes before something turns no strokes of it.
/// The first frame, a frame after reset() and a frame after a cut have no past. All calls on the
/// thread of the GL context that was current at construction.
class TensorField {
 public:
  /// `library` has gpu::marksShaders(), sceneShaders(), gpuShaders(). `full`: the size of the full
  /// image. Throws hal::Failure if GPU memory runs out.
  TensorField(const gpu::ShaderLibrary& library, hal::FrameSize full);
  ~TensorField();
  TensorField(const TensorField&) = delete;
  TensorField& operator=(const TensorField&) = delete;
  TensorField(TensorField&&) = delete;
  TensorField& operator=(TensorField&&) = delete;

  /// Adds a frame's image (RGBA8, of frame.size()) and carries the past along `motion`, which has
  /// been updated for the frame, like `layers`, and past tensors of virtual objects along
  /// ArFrame::motion, like those of planes and real things whose poses are known more surely than
  /// the image's motion. Behind movers and virtual objects, the background's tensors stay as they
  /// were. With `segments`, directions do not spread from one segment of the camera image to
  /// another. Precondition: frame.full() is the constructor's size.
  void update(const scene::ArFrame& frame, const gpu::Texture& picture, const MotionField& motion,
              const TensorFieldOptions& options, const MotionLayers* layers = nullptr,
              const SegmentMap* segments = nullptr);

  std::size_t levelCount() const;
  /// RGBA16F, LINEAR: a level's tensors after the look-up in coarser levels: tensor; confidence of
  /// this level itself, in [0, 1]; detail: the mean gradient in units of a strong edge's, at most
  /// kMaxDetailUnit. Level 0
  /// has the finest regions; each further level doubles their width.
  const gpu::Texture& resolved(std::size_t level) const;
  /// The same before the look-up, as interpolated on each level.
  const gpu::Texture& filled(std::size_t level) const;
  /// Before the interpolation: only regions with edges have tensors.
  const gpu::Texture& regions() const;
  /// The tensors of movers, on the finest level only; 0 where none is near.
  const gpu::Texture& movers() const;
  /// Like resolved(): the tensors of virtual objects. Valid if the last frame had any.
  const gpu::Texture& resolvedModels(std::size_t level) const;
  /// R32UI: the label of the patch of a model (shaders/surface_form.glsl) that most of each
  /// region's virtual pixels are of, with its marks of limbs and joints, 0 for none; null until a
  /// frame had models. Valid until the next update(), like the following.
  const gpu::Texture* patches() const;
  /// The same of the previous frame; null if that had no models or ArFrame::motion is not set, so
  /// that nobody knows where they were.
  const gpu::Texture* patchesBefore() const;
  /// Side of a region on a level, px of the full image.
  double regionPixels(std::size_t level) const;
  /// Scale from px of the full image to texture coordinates of a level.
  glm::vec2 textureScale(std::size_t level) const;
  /// The level whose detail decides how finely a place is painted.
  std::size_t detailLevel() const;

  /// Forgets the past.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks

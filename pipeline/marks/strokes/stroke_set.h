#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/fidelity_field.h"
#include "pipeline/marks/focus_field.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// The growth of a layer's strokes and their temporal behaviour. Px are those of the full image;
/// colours are sRGB-coded in [0, 1], their differences weighted lengths (stroke_trace.comp).
struct StrokeRule {
  float segmentPx = 8.0F;
  float steps = 4.0F;             ///< length of each arm in segments, at most 4
  float minSteps = 0.5F;          ///< shortest arm: neither colour nor detail ends it earlier
  float colourThreshold = 0.12F;  ///< the arm ends at this difference from the anchor's colour
  float cutOffRad = 0.8F;         ///< the arm ends at this angle between two segments
  /// range of detail in which the layer is painted (TensorField::resolved)
  glm::vec2 detailBand{0.0F, 1e9F};
  float modelDetail = 1.0F;   ///< factor of the detail on virtual surfaces
  float detailSpread = 0.0F;  ///< random spread of the band among anchors
  float slack = 0.25F;        ///< hysteresis: existing strokes keep a band wider by this part
  /// the same before a standing camera, below 1; there, strokes that do not exist yet must lie
  /// within the band by half of it
  float restSlack = 0.6F;
  float wanderRad = 0.1F;  ///< largest deviation of a stroke from the field
  bool bothWays = true;    ///< false: only ahead of the anchor, as in the thesis
  /// px from a stroke's middle to the places beside it: strokes of the background lean away from
  /// other colours there, and those that have them on both sides are painted over the others of the
  /// layer; 0: neither
  float besidePx = 0.0F;
  std::size_t fieldLevel = 0;  ///< level of the tensor field; at most its last
  float widthPx = 8.0F;
  float widthSpread = 0.2F;  ///< random part of the width, ±
  float opacity = 1.0F;      ///< in [0, 1]
  /// a limited palette (shaders/mixture.glsl); null: all colours
  const gpu::Texture* mixtures = nullptr;
  float leaveLight = 0.0F;  ///< in [0, 1]: how much thinner the paint of the lightest strokes is
  glm::vec3 jitter{0.02F, 0.1F, 0.05F};  ///< of hue, saturation and value, as parts
  int quads = 8;                         ///< of a stroke, at most
  hal::Duration shapeMemory = std::chrono::milliseconds(650);  ///< time constants; 0: none
  hal::Duration colourMemory = std::chrono::milliseconds(650);
  hal::Duration appearing = std::chrono::milliseconds(300);
  hal::Duration vanishing = std::chrono::milliseconds(300);
  float maxColourPerSecond = 1.5F;  ///< largest change of a stroke's colour
  /// From the first difference of colour on, a stroke stands on other content, at the second one
  /// surely: then it has no past. It should be more than noise.
  glm::vec2 otherColour = kNoColour;
  static constexpr glm::vec2 kNoColour{1e6F, 2e6F};
  /// Where there is less detail than this (from none of it at the first to all at the second), the
  /// field is only filled in, and shapes are held `flatHold` times as long; so are all shapes of
  /// the background before a standing camera.
  glm::vec2 flatDetail{0.35F, 0.9F};
  float flatHold = 1.0F;
  /// In [0, 1]: how much looser fast movers are painted: along their motion, and with less detail,
  /// so that fewer of the finer layers' strokes are needed; between two speeds, heights of the
  /// image per second.
  float looseness = 0.0F;
  glm::vec2 looseSpeed{0.3F, 1.0F};
  /// Away from its places, the layer is painted by the part of its anchors that
  /// shaders/focus.glsl gives, those of the lowest ranks; within them, detail counts more.
  FocusField focus;
  /// Where fidelity is higher, strokes have less jitter; those of a layer that is faithful are also
  /// narrower and shorter, are wanted where there is less detail, end at smaller differences of
  /// colour, and stress what they depict.
  FidelityField fidelity;
  bool isFaithful = false;
  int layer = 0;  ///< from the broadest, 0
  int layers = 1;
  /// Whether strokes end at the borders of models, their patches and movers (thesis §5.5). If not,
  /// the images of StrokePaint should be of the whole picture.
  bool clips = true;
};

/// The images that strokes take their colours from, of any size (LINEAR, sRGB-coded,
/// premultiplied), of the background, of models and of movers. They may be the same one.
struct StrokePaint {
  const gpu::Texture* background = nullptr;
  const gpu::Texture* models = nullptr;
  const gpu::Texture* movers = nullptr;
  /// The images of models and of the background at their finest, for strokes beside another patch
  /// or segment, whose colours the texels of the others mix in.
  const gpu::Texture* fineModels = nullptr;
  const gpu::Texture* fineBackground = nullptr;
  float modelTexelPx = 1.0F;  ///< width of a texel of `models`, in px of the full image
};

/// The strokes of an AnchorSet's anchors: traced along a tensor field (thesis §4.4), blended with
/// their past (§4.5, §5.4), and laid out for drawing in an order that hardly ever changes during
/// their lives. All data stays on the GPU. All calls on the thread of the GL context that was
/// current at construction.
class StrokeSet {
 public:
  /// `library` has gpu::marksShaders(), gpu::sceneShaders() and gpu::gpuShaders(); `slotCount` is
  /// the AnchorSet's. Throws hal::Failure if GPU memory runs out.
  StrokeSet(const gpu::ShaderLibrary& library, std::uint32_t slotCount);
  ~StrokeSet();
  StrokeSet(const StrokeSet&) = delete;
  StrokeSet& operator=(const StrokeSet&) = delete;
  StrokeSet(StrokeSet&&) = delete;
  StrokeSet& operator=(StrokeSet&&) = delete;

  /// Traces the strokes of the frame for which `anchors` and `field` were updated. If the anchors
  /// have started anew, the strokes have no past. With the anchors' `layers`, strokes end at the
  /// borders of movers; with `borders`, at those of the camera image's segments: R32UI of the
  /// frame's size, the label of each pixel in its lowest 13 bits (shaders/stroke_label.glsl).
  /// Preconditions: anchors and field are of frame.full(), and the anchors have the constructor's
  /// number of slots.
  void update(const scene::ArFrame& frame, const AnchorSet& anchors, const TensorField& field,
              const StrokePaint& paint, const StrokeRule& rule,
              const MotionLayers* layers = nullptr, const gpu::Texture* borders = nullptr);

  /// The visible strokes, in painting order, 96 bytes each: four pairs of points, paint, shape
  /// (shaders/stroke_instances.comp). Also glDrawArraysIndirect's command for triangle strips of
  /// verticesOf(rule.quads) each.
  const gpu::Buffer& instances() const;
  const gpu::Buffer& command() const;
  static constexpr std::size_t kInstanceBytes = 96;
  static int verticesOf(int quads) { return 2 * (quads + 1); }
  /// The state of each slot's stroke, laid out as in shaders/stroke.glsl.
  const gpu::Buffer& strokes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/overlay/figure_drawer.h"
#include "pipeline/overlay/label_layout.h"
#include "pipeline/overlay/line_shapes.h"
#include "pipeline/overlay/movie_player.h"
#include "pipeline/overlay/other_machine.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/overlay/overlay_drawing.h"
#include "pipeline/overlay/part_shape.h"
#include "pipeline/overlay/pose_trust.h"
#include "pipeline/overlay/tag_contradictions.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/scene_bodies.h"
#include "pipeline/tracking/camera/camera_model.h"

namespace pleinair::overlay {

/// A painted frame, to be drawn over.
struct OverlayFrame {
  const gpu::Texture* painted = nullptr;              ///< the style's picture, of any size, LINEAR
  const scene::ArFrame* ar = nullptr;                 ///< what was painted
  const tracking::CameraModel* camera = nullptr;      ///< of pictures of the output's size
  std::optional<scene::Body::Moment> machine;         ///< nothing: its pose is unknown
  bool isMachineSeen = false;                         ///< a tag of it, in this frame
  std::span<const int> unknownTags;                   ///< ids in this frame that the scene has not
  const tracking::TrackingResult* tracked = nullptr;  ///< of this frame
};

/// What became of the overlay in a frame.
struct OverlayState {
  Trust trust;
  double predictedErrorPx = 0.0;  ///< at the worst of the step's parts; px of the output
};

/// Draws a step over the painting of a machine: parts in focus crisp and outlined, ghosts, arrows,
/// labels, the instruction; or the inset and a badge where the machine's place is in doubt. The
/// result has the output's size whatever the quality level. After the first frame with a content,
/// drawing allocates nothing. All calls on the thread of the GL context that it was made in.
class OverlayRenderer {
 public:
  /// `machine`: index of the model in the scene; nothing: there is only the instruction and the
  /// inset. `library` has gpu::gpuShaders(), gpu::sceneShaders() and gpu::overlayShaders().
  /// `doubtfulTags`: what another renderer of the scene has found; null: nothing.
  OverlayRenderer(const gpu::ShaderLibrary& library, const scene::Scene& scene,
                  std::optional<std::size_t> machine, hal::FrameSize output,
                  std::shared_ptr<DoubtfulTags> doubtfulTags);

  std::optional<std::size_t> machine() const { return machine_; }
  /// Takes another content, or none; the same one costs nothing. Allocates. True if it is another.
  bool take(const std::shared_ptr<const OverlayContent>& content);
  /// Per part: 1 where it is off.
  std::span<const std::uint8_t> hiddenParts() const { return hidden_; }
  bool hasContent() const { return content_ != nullptr; }

  /// Draws the content over a frame. The texture is valid until the next call. Precondition:
  /// hasContent().
  const gpu::Texture& draw(const OverlayFrame& frame);
  const OverlayState& state() const { return state_; }
  /// Of the last frame, in the labels' order.
  std::span<const PlacedLabel> labels() const { return placed_; }

  /// As after a cut.
  void reset();

 private:
  const scene::Model& model() const { return *scene_.models[*machine_].model; }
  void takeLooks();
  void findBoxes(const OverlayFrame& frame);
  bool seesOtherMachine(const OverlayFrame& frame);
  PoseEvidence evidenceOf(const OverlayFrame& frame) const;
  void judgeSize(const PoseEvidence& evidence);
  void placePanel(hal::TimePoint now);
  glm::ivec2 insetPlace() const;
  void drawMarks(const OverlayFrame& frame);
  void drawLabels(const OverlayFrame& frame);
  void drawPanels(hal::TimePoint now);
  float phaseAt(hal::TimePoint now) const;

  const scene::Scene& scene_;
  std::optional<std::size_t> machine_;
  hal::FrameSize size_;
  float pxScale_;
  gpu::Program copy_, region_, marks_;
  gpu::Texture output_, regionTexture_, lookTexture_;
  gpu::RenderTarget target_, regionTarget_;
  FigureDrawer figures_;
  OverlayDrawing drawing_;
  LineShapes lines_;
  LineShapes leaders_;
  LabelLayout layout_;
  OtherMachine other_;
  std::optional<TagContradictions> contradictions_;
  PoseTrust trust_;
  OverlayState state_;

  std::shared_ptr<const OverlayContent> content_;
  std::vector<PartShape> shapes_;            // of all parts
  std::vector<std::uint8_t> hidden_;         // per part
  std::vector<std::size_t> focus_;           // parts that are marked
  std::vector<std::optional<PxBox>> boxes_;  // per part; only those of the content
  std::vector<Sprite> labelSprites_;
  std::vector<LabelTarget> targets_;
  std::vector<PxBox> keepClear_;
  std::span<const PlacedLabel> placed_;
  Sprite panel_, inset_;
  MoviePlayer movie_;
  std::array<Sprite, kDoubts> badges_;
  std::optional<PxBox> marked_;  // around all that is marked, in this frame
  std::optional<PxBox> ghosts_;  // where they go to, or come from
  float lineScale_ = 1.0F;       // of outlines: thinner around small parts
  bool isSmall_ = false;         // the parts are hard to make out
  bool isPanelBelow_ = true;
  std::optional<hal::TimePoint> panelBadSince_;
  std::optional<hal::TimePoint> began_;  // the content
};

}  // namespace pleinair::overlay

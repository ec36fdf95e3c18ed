#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/styles/hatching/hatch_lines.h"
#include "pipeline/styles/hatching/hatching_parameters.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// The style "hatching".
const StyleKind& hatchingKind();

/// Ink or chalk on paper: tone by lines in one to three directions, which cross in the darks, and
/// contour lines. Each line belongs to an anchor (marks::AnchorSet), goes with the thing it lies
/// on, runs along the tensor field, and is as wide at each place as its tone asks for; ranks are
/// nested, so that a tone that changes adds lines or takes them away, and none pops (HatchLines).
/// Contours are the image's edges, smoothed along the field, the silhouettes, creases and borders
/// between patches of models, and the outlines of movers. Paper goes with
/// ArFrame::canvasFromPicture. All on the GPU, nothing is read back.
///
/// Time: tones and contours are taken from an image that is averaged along its motion
/// (marks::FilteredFrame). A first frame (after reset(), a cut, another full size, another
/// `spacing`, `length`, `coverage`, `directions` or `seed`) has no past. A dark picture is
/// lightened by a curve that follows its background within some seconds, and at such a frame at
/// once.
class Hatching final : public Style {
 public:
  /// The library, which outlives it, holds gpu::hatchingShaders(), strokesShaders(),
  /// substrateShaders(), marksShaders() and sceneShaders().
  explicit Hatching(const gpu::ShaderLibrary& library,
                    SceneContents contents = SceneContents::kModels);
  ~Hatching() override;
  Hatching(const Hatching&) = delete;
  Hatching& operator=(const Hatching&) = delete;
  Hatching(Hatching&&) = delete;
  Hatching& operator=(Hatching&&) = delete;

  const StyleKind& kind() const override { return hatchingKind(); }
  const config::ParameterValues& parameters() const override { return values_; }
  scene::ArFrameNeeds needs() const override;
  hal::Result<void> prepare(const config::ParameterValues& values) override;
  void setParameters(const config::ParameterValues& values) override;
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view) override;
  const marks::AnchorSet* anchors() const override;
  std::vector<marks::Anchor> readAnchors() const override;
  const marks::MotionLayers* movers() const override;
  void reset() override;

  /// The sets of lines of the last frame, for measures and tests.
  std::size_t setCount() const;
  const HatchLines& set(std::size_t number) const;
  /// The coverage of all lines, in A (shaders/line.frag).
  const gpu::Texture& ink() const;

 private:
  struct State;
  void warmUp(SceneContents contents);

  config::ParameterValues values_;
  HatchingParameters p_;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::styles

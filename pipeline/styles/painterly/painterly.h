#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "hal/error.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/styles/painterly/painterly_parameters.h"
#include "pipeline/styles/style.h"

namespace pleinair::styles {

/// The style "painterly".
const StyleKind& painterlyKind();

/// Chapter IV of the thesis, and on: layers of brush strokes, from broad to fine, that
/// follow the tensor field of the picture's edges. Each stroke belongs to an anchor, goes with what
/// that lies on, and keeps its shape, colour and place in the order of painting as long as it
/// lives. Fine layers are painted only where there is detail. Colour and height are drawn together;
/// light falls on the paint's relief in one pass at the end. All on the GPU, nothing is read back.
///
/// Time: a first frame (after reset(), a cut, another full size, another number, size, length,
/// density or seed of strokes) has all its strokes at once. Time constants are scaled by
/// `coherence`.
class Painterly final : public Style {
 public:
  /// The library, which outlives it, holds gpu::painterlyShaders(), strokesShaders(),
  /// substrateShaders(), marksShaders(), sceneShaders(), gpuShaders().
  explicit Painterly(const gpu::ShaderLibrary& library,
                     SceneContents contents = SceneContents::kModels);
  ~Painterly() override;
  Painterly(const Painterly&) = delete;
  Painterly& operator=(const Painterly&) = delete;
  Painterly(Painterly&&) = delete;
  Painterly& operator=(Painterly&&) = delete;

  const StyleKind& kind() const override { return painterlyKind(); }
  scene::ArFrameNeeds needs() const override;
  const config::ParameterValues& parameters() const override { return values_; }
  hal::Result<void> prepare(const config::ParameterValues& values) override;
  void setParameters(const config::ParameterValues& values) override;
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view) override;
  const marks::AnchorSet* anchors() const override;
  std::vector<marks::Anchor> readAnchors() const override;
  const marks::MotionLayers* movers() const override;
  void reset() override;

  /// The anchors and strokes of a layer, for measures: 0 is the coarsest. None before the first
  /// frame; valid until the next call.
  struct PaintedLayer {
    const marks::AnchorSet& anchors;
    const marks::StrokeSet& strokes;
  };
  std::size_t layerCount() const;
  PaintedLayer layer(std::size_t number) const;

 private:
  struct State;

  void warmUp(SceneContents contents);

  config::ParameterValues values_;
  PainterlyParameters p_;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::styles

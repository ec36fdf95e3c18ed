#pragma once

#include <memory>

#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/styles/style.h"
#include "pipeline/styles/watercolor/cell_tiling.h"
#include "pipeline/styles/watercolor/watercolor_parameters.h"
#include "pipeline/styles/watercolor/watercolor_surfaces.h"

namespace pleinair::styles {

/// The style "watercolor".
const StyleKind& watercolorKind();

/// Chapter III of the thesis, and on: the frame tiled by the Voronoi cells of seeds that are drawn
/// to the edges. A seed belongs to an anchor (marks::AnchorSet) and goes with the thing it lies on.
/// Each cell keeps a dark and a light colour; the smoothed picture decides which of those around a
/// pixel it gets, so that washes end where things do and cells do not show, unless `mosaic` asks
/// for the thesis's flat ones. Over that dark edges, granulation, paper. All on the GPU, nothing is
/// read back.
///
/// The substrate, with all that is uneven about the paint, goes with ArFrame::canvasFromPicture. An
/// object's silhouette (ids) counts as an edge.
///
/// Movers (marks::MotionLayers) have cells of their own; those of the background stay as they are
/// until they are seen again. Models are hidden by movers before them.
///
/// Time: edges and colours are taken from a picture that is averaged along its motion
/// (marks::FilteredFrame), and colours of cells once more, so that a still scene is a still
/// painting: sensor noise moves no seed, and newborn cells begin with the colours of those they
/// grow in. A first frame (after reset(), a cut, another full size, another `cell_size` or `seed`)
/// starts anew and re-tiles a few times at once, so that it looks as settled as later ones. At
/// another level of quality (ArFrame::fullSize) the same cells go on. A seed moves by the share of
/// its way that its time constant gives for the time since the frame before; a time that runs
/// backwards counts as none, and never more than one second.
class Watercolor final : public Style {
 public:
  /// The library, which outlives it, holds gpu::watercolorShaders(), substrateShaders(),
  /// marksShaders() and gpu::sceneShaders().
  explicit Watercolor(const gpu::ShaderLibrary& library,
                      SceneContents contents = SceneContents::kModels);
  ~Watercolor() override;
  Watercolor(const Watercolor&) = delete;
  Watercolor& operator=(const Watercolor&) = delete;
  Watercolor(Watercolor&&) = delete;
  Watercolor& operator=(Watercolor&&) = delete;

  const StyleKind& kind() const override { return watercolorKind(); }
  const config::ParameterValues& parameters() const override { return values_; }
  void setParameters(const config::ParameterValues& values) override;
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view) override;
  const marks::AnchorSet* anchors() const override;
  std::vector<marks::Anchor> readAnchors() const override;
  const marks::MotionLayers* movers() const override;
  void reset() override;

  /// Results of the last frame's passes, on the GPU, for measures and tests.
  struct Inner {
    const CellTiling* tiler;        ///< seeds, means
    const gpu::Texture* tiling;     ///< R32UI a pixel: shaders/tiling_word.glsl
    const gpu::Texture* filtered;   ///< the image that edges and colours are taken from
    const gpu::Texture* guide;      ///< RGBA8 for 2×2 px: shaders/guide.frag
    const gpu::Texture* darkWash;   ///< RGBA8, a texel a slot: shaders/washes.comp
    const gpu::Texture* lightWash;  ///< the same, with its share in A
  };
  Inner inner() const;

 private:
  struct Passes;
  struct Marks;

  void takeMarks(const scene::ArFrame& frame);
  void takeCanvas(const scene::ArFrame& frame);
  void findMovers(const scene::ArFrame& frame);
  void filtered(const scene::ArFrame& frame);
  void tile(const scene::ArFrame& frame, bool wantsMeans);
  void findGliding();
  void paintWashes(const scene::ArFrame& frame);
  void mixWashes();
  void compose(const scene::ArFrame& frame);
  void showView(const scene::ArFrame& frame, std::string_view view);
  void warmUp(SceneContents contents);

  const gpu::ShaderLibrary* library_;
  config::ParameterValues values_;
  WatercolorParameters p_;
  std::unique_ptr<Passes> passes_;
  std::unique_ptr<Marks> marks_;
  gpu::PerSize<WatercolorCanvas> canvases_;
  const WatercolorCanvas* canvas_ = nullptr;          // of this frame
  const WatercolorCanvas* previousCanvas_ = nullptr;  // of the one before
  const gpu::Texture* picture_ = nullptr;             // that edges and colours are taken from
  float pixelsOfFull_ = 1.0F;                         // of this frame
  hal::Duration step_{0};                             // since the one before
  hal::TimePoint lastTime_;
  bool hasPast_ = false;
};

}  // namespace pleinair::styles

#pragma once

#include <memory>
#include <vector>

#include "pipeline/gpu/shader_library.h"
#include "pipeline/styles/style.h"
#include "pipeline/styles/watercolor/watercolor_parameters.h"
#include "pipeline/styles/watercolor/watercolor_surfaces.h"

namespace pleinair::styles {

/// The style's inner pictures, apart from the finished one.
std::span<const ViewInfo> watercolorViews();

/// Chapter III of the thesis, and on: the frame tiled by the Voronoi cells of jittered seeds that
/// are drawn to the edges in every frame. Each cell keeps a dark and a light colour; the smoothed
/// picture decides which of those around a pixel it gets, so that washes end where things do and
/// cells do not show, unless `mosaic` asks for the thesis's flat ones. Over that dark edges,
/// granulation, paper. All on the GPU, nothing is read back.
///
/// The sheet, with all that is uneven about the paint, goes with ArFrame::canvasFromPicture. An
/// object's silhouette (ids) counts as an edge.
///
/// Time: a first frame (after reset(), another full size, another `cell_size` or `seed`) starts
/// with seeds at home and re-tiles a few times at once, so that it looks as settled as later ones.
/// At another level of quality (ArFrame::fullSize) the same cells go on, their seeds scaled. A seed
/// moves by the share of its way that its time constant gives for the time since the frame before;
/// a time that runs backwards counts as none, and never more than one second.
class Watercolor final : public Style {
 public:
  /// The library holds gpu::watercolorShaders().
  explicit Watercolor(const gpu::ShaderLibrary& library);
  ~Watercolor() override;
  Watercolor(const Watercolor&) = delete;
  Watercolor& operator=(const Watercolor&) = delete;
  Watercolor(Watercolor&&) = delete;
  Watercolor& operator=(Watercolor&&) = delete;

  std::string_view name() const override { return "watercolor"; }
  std::span<const ViewInfo> views() const override { return watercolorViews(); }
  bool usesCanvas() const override { return true; }
  const config::ParameterValues& parameters() const override { return values_; }
  void setParameters(const config::ParameterValues& values) override;
  const gpu::Texture& paint(const scene::ArFrame& frame, std::string_view view,
                            gpu::PassTimer& timer) override;
  void reset() override;

  /// What the last frame's passes left on the GPU, for tests.
  struct Inner {
    const gpu::Buffer* seeds;       ///< vec2 a cell, row by row: px of the last, for the next
    const gpu::Texture* tiling;     ///< R32UI a pixel: shaders/tiling_word.glsl
    const gpu::Texture* means;      ///< RGBA16F a cell: linear RGB; 0 in A where it has no pixel.
                                    ///< Only after the view "means" and mosaics
    const gpu::Texture* guide;      ///< RGBA8 for 2×2 px: shaders/guide.frag
    const gpu::Texture* darkWash;   ///< RGBA8 a cell: shaders/washes.comp
    const gpu::Texture* lightWash;  ///< likewise, its share in A
  };
  Inner inner() const;

 private:
  struct Passes;

  bool needsNewTiling(const scene::ArFrame& frame) const;
  void takeCanvas(const scene::ArFrame& frame);
  void startTiling(const scene::ArFrame& frame);
  void scaleSeeds(hal::FrameSize from);
  void tileAndRetile(const scene::ArFrame& frame, gpu::PassTimer& timer, bool atOnce,
                     bool wantsMeans);
  void paintWashes(const scene::ArFrame& frame, gpu::PassTimer& timer);
  void compose(const scene::ArFrame& frame, gpu::PassTimer& timer);
  void showView(const scene::ArFrame& frame, std::string_view view);
  void makePaper();
  void warmUp();

  config::ParameterValues values_;
  WatercolorParameters p_;
  std::unique_ptr<Passes> passes_;
  std::unique_ptr<WatercolorCells> cells_;
  std::vector<std::unique_ptr<WatercolorCanvas>> canvases_;  // of each size that was painted
  const WatercolorCanvas* canvas_ = nullptr;                 // of this frame
  glm::vec2 cellPixels_{1.0F};                               // on it
  float pixelsOfFull_ = 1.0F;                                // likewise
  unsigned seed_ = 0;                                        // of the tiling
  gpu::Texture paper_;
  hal::TimePoint lastTime_;
  bool hasPast_ = false;
};

}  // namespace pleinair::styles

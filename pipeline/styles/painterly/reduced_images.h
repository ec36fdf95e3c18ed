#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/strokes/stroke_set.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {
class MotionLayers;
}

namespace pleinair::styles {

/// A frame's picture at half its size, a quarter and on, for strokes to take their colours from:
/// of the background, of movers and of all models, each by itself, so that none is tinted by
/// another (thesis §5.5). Keeps textures for each size of picture it has seen. All calls on the
/// thread of the GL context it was made in.
class ReducedImages {
 public:
  static constexpr std::size_t kHalvings = 5;

  /// `library` has gpu::painterlyShaders(), gpu::sceneShaders() and gpu::marksShaders().
  explicit ReducedImages(const gpu::ShaderLibrary& library);

  /// Without `layers`, nothing is a mover.
  void update(const scene::ArFrame& frame, const marks::MotionLayers* layers = nullptr);
  /// The images whose texels are at most `px` of the frame wide. Valid until the next update().
  marks::StrokePaint paintOf(double px) const;
  /// The same of all of the picture, whatever it shows.
  marks::StrokePaint wholePaintOf(double px) const;
  /// All of the picture, `halvings` times reduced. Precondition: 1 to kHalvings.
  const gpu::Texture& whole(std::size_t halvings) const;
  /// Frees what it keeps.
  void clear();

 private:
  /// RGBA, of premultiplied colour where it is of a part of the picture.
  struct Pyramid {
    Pyramid(hal::FrameSize size, gpu::TextureFormat format);
    std::array<gpu::Texture, kHalvings> levels;
    std::array<gpu::RenderTarget, kHalvings> targets;
  };
  struct Apart {
    Apart(hal::FrameSize size, bool mayHaveModels);
    Pyramid background;
    Pyramid movers;
    std::optional<Pyramid> models;
    gpu::RenderTarget first;  // the first levels of all
  };
  struct Surfaces {
    explicit Surfaces(hal::FrameSize pictureSize);
    hal::FrameSize size;
    Pyramid whole;
    std::optional<Apart> apart;
  };

  static void halve(gpu::Program& halving, const Pyramid& pyramid);
  /// The level whose texels are at most `px` wide; nothing: the picture's own.
  static std::optional<std::size_t> levelOf(double px);
  float texelPx(std::size_t halvings) const;

  gpu::Program halve_;       // RGBA8 images
  gpu::Program halveApart_;  // RGBA16F images
  gpu::Program part_;
  gpu::Program partWithModels_;
  gpu::PerSize<Surfaces> surfaces_;
  const Surfaces* now_ = nullptr;
  const gpu::Texture* picture_ = nullptr;
  bool isApart_ = false;
  bool hasObjects_ = false;
  bool hasMovers_ = false;
  marks::LayerTextures layerTextures_;
  gpu::Texture noIds_;
  double pixelsOfFull_ = 1.0;
};

}  // namespace pleinair::styles

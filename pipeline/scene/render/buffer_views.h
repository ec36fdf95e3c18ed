#pragma once

#include <span>
#include <string_view>

#include "pipeline/gpu/images/per_size.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::scene {

/// A picture of one of an AR frame's buffers, for people to look at.
struct BufferView {
  std::string_view name;  ///< "motion"
  std::string_view help;
  ArFrameNeeds needs;  ///< of the frames that it shows
};

/// All views.
std::span<const BufferView> bufferViews();
/// Returns null if no view has that name.
const BufferView* findBufferView(std::string_view name);

/// Draws buffer views. All calls on the thread of the GL context that it was made in.
class BufferViewer {
 public:
  /// `library` has gpu::gpuShaders() and gpu::sceneShaders().
  explicit BufferViewer(const gpu::ShaderLibrary& library);

  /// Draws a view of a frame, RGBA8, of the frame's size; valid until the next call with that size.
  /// Pixels without data are black. Precondition: the frame was made with the view's needs.
  const gpu::Texture& show(const BufferView& view, const ArFrame& frame);

 private:
  struct Canvas {
    explicit Canvas(hal::FrameSize size);
    gpu::Texture picture;
    gpu::RenderTarget target;
  };

  gpu::Program program_;
  gpu::Texture noIds_;     // stands in for a texture that a frame lacks
  gpu::Texture noMotion_;  // stands in for a texture that a frame lacks
  gpu::PerSize<Canvas> canvases_;
};

}  // namespace pleinair::scene

#pragma once

#include <span>
#include <string_view>

#include "pipeline/gpu/per_size.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/render_target.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::scene {

/// A picture of one of an AR frame's buffers, for people.
struct BufferView {
  std::string_view name;  ///< "motion"
  std::string_view help;
  ArFrameNeeds needs;  ///< of the frames it shows
};

/// All of them.
std::span<const BufferView> bufferViews();
/// Null where none has that name.
const BufferView* findBufferView(std::string_view name);

/// Draws them. All calls on the thread of the GL context it was made in.
class BufferViewer {
 public:
  /// `library` has gpu::gpuShaders() and gpu::sceneShaders().
  explicit BufferViewer(const gpu::ShaderLibrary& library);

  /// The view of a frame, RGBA8, of its size; valid until the next call with that size. What the
  /// frame knows nothing of is black. Precondition: the frame was made with the view's needs.
  const gpu::Texture& show(const BufferView& view, const ArFrame& frame);

 private:
  struct Canvas {
    explicit Canvas(hal::FrameSize size);
    gpu::Texture picture;
    gpu::RenderTarget target;
  };

  gpu::Program program_;
  gpu::Texture noIds_;     // in place of what a frame does not have
  gpu::Texture noMotion_;  // likewise
  gpu::PerSize<Canvas> canvases_;
};

}  // namespace pleinair::scene

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/pixel_format.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/handle.h"

namespace pleinair::gpu {

enum class TextureFormat {
  kR8,
  kRg8,
  kRgb8,  ///< upload only; not a render target
  kRgba8,
  kRgba16f,
  kRg16f,
  kR32f,
  kRgba32f,
  kR32ui,
  kRg32ui,
  kDepth24,
};

/// How samplers read between texels and beyond the border. 32-bit floats and integers are always
/// read kNearest (GPU rules, rule 5).
enum class TextureFilter { kNearest, kLinear };

bool isRenderable(TextureFormat format);
bool isFilterable(TextureFormat format);

/// What lies beyond the border: its own texel, or the texture once more.
enum class TextureWrap { kClamp, kRepeat };

/// A 2-D texture of immutable size with one level. Belongs to the context it was made in.
class Texture {
 public:
  /// Holds nothing; only assignment and size() are allowed.
  Texture() = default;
  /// Undefined content. Preconditions: 1 px or more a side; the filter suits the format. Throws
  /// hal::StartupError (kUnsupported) where the GPU has no memory for it.
  Texture(TextureFormat format, hal::FrameSize size, TextureFilter filter = TextureFilter::kNearest,
          TextureWrap wrap = TextureWrap::kClamp);

  TextureFormat format() const { return format_; }
  hal::FrameSize size() const { return size_; }
  GLuint name() const { return handle_.get(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }

  /// Replaces the content. `strideBytes` may exceed the packed row. Not for depth.
  void upload(std::span<const std::uint8_t> bytes, std::size_t strideBytes);

 private:
  TextureHandle handle_;
  TextureFormat format_ = TextureFormat::kRgba8;
  hal::FrameSize size_;
};

/// GL's names of a format, for image bindings and read-back.
struct GlFormat {
  GLenum internal;
  GLenum format;
  GLenum type;
  int bytesPerTexel;
};
GlFormat glFormat(TextureFormat format);

}  // namespace pleinair::gpu

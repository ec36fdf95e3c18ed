#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "hal/pixel_format.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/handle.h"

namespace pleinair::gpu {

enum class TextureFormat {
  kR8,
  kRg8,
  kRgb8,  ///< upload only; not a render target
  kRgba8,
  kSrgba8,  ///< upload only; sampled as linear light, alpha as it is
  kRgba16f,
  kRg16f,
  kR32f,
  kRgba32f,
  kR32ui,
  kRg32ui,
  kDepth24,
};

/// How samplers read between texels. 32-bit floats and integers are always read kNearest
/// (docs/gpu.md, rule 5). kTrilinear: with all smaller levels, which upload() makes.
enum class TextureFilter { kNearest, kLinear, kTrilinear };

/// The texels beyond the border: its own texel, the texture once more, or its mirror image.
enum class TextureWrap { kClamp, kRepeat, kMirror };

bool isRenderable(TextureFormat format);
bool isFilterable(TextureFormat format);

/// A 2-D texture of immutable size, with one level unless it is kTrilinear. Belongs to the context
/// it was made in.
class Texture {
 public:
  /// Holds nothing; only assignment and size() are allowed.
  Texture() = default;
  /// Undefined content. Preconditions: 1 px or more a side; the filter suits the format. Throws
  /// hal::Failure (kUnsupported) where the GPU has no memory for it.
  Texture(TextureFormat format, hal::FrameSize size, TextureFilter filter = TextureFilter::kNearest,
          TextureWrap wrap = TextureWrap::kClamp);

  /// One that has its memory from elsewhere, with its filter set.
  Texture(TextureHandle handle, hal::FrameSize size, TextureFormat format = TextureFormat::kRgba8)
      : handle_(std::move(handle)), format_(format), size_(size) {}

  TextureFormat format() const { return format_; }
  hal::FrameSize size() const { return size_; }
  GLuint name() const { return handle_.get(); }
  explicit operator bool() const { return static_cast<bool>(handle_); }

  /// Beyond the left and right edges, and beyond the upper and lower ones.
  void setWrap(TextureWrap across, TextureWrap down);
  /// Replaces the content. `strideBytes` may exceed the packed row. Not for depth.
  void upload(std::span<const std::uint8_t> bytes, std::size_t strideBytes);

 private:
  TextureHandle handle_;
  TextureFormat format_ = TextureFormat::kRgba8;
  hal::FrameSize size_;
  bool hasLevels_ = false;
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

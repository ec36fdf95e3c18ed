#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

#include <glm/vec4.hpp>

#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// The target of a pass: up to 4 colour textures of one size and at most one depth texture. The
/// textures belong to the caller and outlive it.
class RenderTarget {
 public:
  RenderTarget() = default;
  /// Throws hal::Failure (kUnsupported) where the GPU cannot draw into them.
  explicit RenderTarget(std::initializer_list<const Texture*> colours,
                        const Texture* depth = nullptr);

  hal::FrameSize size() const { return size_; }
  explicit operator bool() const { return static_cast<bool>(handle_); }

  /// Binds it with its whole area as the viewport, old content invalidated: a tile-based GPU does
  /// not load it. For passes that write every pixel.
  void beginDiscarding() const;
  /// Binds it and keeps what is there: for drawing over it.
  void beginKeeping() const;
  /// Binds its colour textures as images, by their places, for a compute shader that writes to
  /// them. Precondition: `formats` are theirs.
  void bindAsImages(std::span<const TextureFormat> formats) const;
  /// Clears one bound colour attachment (float or normalised formats).
  void clearColour(int attachment, glm::vec4 colour) const;
  /// Clears one bound colour attachment of an unsigned integer format.
  void clearUnsigned(int attachment, glm::uvec4 value) const;
  void clearDepth() const;
  /// Tells the driver that depth will not be read again (docs/gpu.md, rule 10).
  void discardDepth() const;

 private:
  static constexpr std::size_t kMaxColours = 4;  // docs/gpu.md, rule 3
  struct Colour {
    GLuint texture = 0;
    TextureFormat format = TextureFormat::kRgba8;
  };

  FramebufferHandle handle_;
  hal::FrameSize size_;
  std::array<Colour, kMaxColours> colours_{};
  int colourCount_ = 0;
  bool hasDepth_ = false;
};

}  // namespace pleinair::gpu

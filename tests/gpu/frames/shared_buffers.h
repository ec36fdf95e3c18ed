#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hal/captured_frame.h"
#include "pipeline/gpu/frames/frame_planes.h"
#include "pipeline/gpu/gl.h"
#include "pipeline/gpu/gpu_loss.h"
#include "tests/support/gl_pictures.h"

namespace pleinair::support {

/// A camera's buffers that a GPU imports, without a driver that can: each plane is a texture whose
/// texels are written together with the processor's bytes. Descriptors are numbers of ours.
class SharedBuffers {
 public:
  SharedBuffers(hal::FrameFormat format, std::uint32_t count)
      : format_(format), pool_(hal::nextBufferPool()) {
    for (std::uint32_t i = 0; i < count; ++i) buffers_.emplace_back(format);
  }

  /// For GpuTestHook::importPlane.
  unsigned import(const hal::GpuSurface& surface) {
    ++imports;
    if (refusesFrom && imports > *refusesFrom) return 0;
    const auto index = static_cast<std::uint32_t>(surface.surface.id);
    const int plane = surface.surface.planes[0].dmaBuf % kPlanes;
    const gpu::PlaneTexture layout = gpu::importedPlane(format_, plane);
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexStorage2D(GL_TEXTURE_2D, 1, gpu::glFormat(layout.format).internal, layout.size.width,
                   layout.size.height);
    const GLint filter = layout.filter == gpu::TextureFilter::kLinear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    names_[{index, plane}] = name;
    copyToTexture(index, plane);
    return name;
  }

  /// Fills a buffer, for both readers.
  void write(std::uint32_t index, const hal::Image& picture) {
    buffers_.at(index) = picture;
    if (isStale) return;
    for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
      if (names_.contains({index, plane})) copyToTexture(index, plane);
    }
  }

  /// The frame that lies in a buffer.
  hal::CapturedFrame frame(std::uint32_t index, std::shared_ptr<const void> lease = nullptr) {
    hal::CapturedFrame frame{.image = buffers_.at(index).view(),
                             .lease = lease ? std::move(lease) : std::make_shared<int>(0)};
    for (int plane = 0; plane < planeCount(format_.pixelFormat); ++plane) {
      frame.dmaBufs.at(static_cast<std::size_t>(plane)) = {
          .fd = kFirst + static_cast<int>(index) * kPlanes + plane,
          .strideBytes = frame.image.strideBytes(plane)};
    }
    frame.buffer = {.pool = pool_, .index = index};
    return frame;
  }

  const hal::Image& at(std::uint32_t index) const { return buffers_.at(index); }

  int imports = 0;
  std::optional<int> refusesFrom;  ///< after so many planes
  bool isWrong = false;            ///< what is imported has other pixels
  bool isStale = false;            ///< what is imported is a snapshot

 private:
  static constexpr int kPlanes = 4;
  static constexpr int kFirst = 4000;

  void copyToTexture(std::uint32_t index, int plane) {
    if (glIsTexture(names_.at({index, plane})) == GL_FALSE) return;  // it was forgotten
    const gpu::PlaneTexture layout = gpu::importedPlane(format_, plane);
    const gpu::GlFormat gl = gpu::glFormat(layout.format);
    const std::span<std::uint8_t> own = buffers_.at(index).plane(plane);
    std::vector<std::uint8_t> bytes(own.begin(), own.end());
    if (isWrong) bytes.at(bytes.size() / 2) ^= 0x40;
    glBindTexture(GL_TEXTURE_2D, names_.at({index, plane}));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, layout.size.width, layout.size.height, gl.format,
                    gl.type, bytes.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D, 0);
  }

  hal::FrameFormat format_;
  std::uint64_t pool_;
  std::vector<hal::Image> buffers_;
  std::map<std::pair<std::uint32_t, int>, GLuint> names_;
};

}  // namespace pleinair::support

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

inline constexpr std::uint32_t kXrgb8888 = drmFourcc('X', 'R', '2', '4');  ///< bytes B, G, R, X
inline constexpr std::uint32_t kArgb8888 = drmFourcc('A', 'R', '2', '4');  ///< bytes B, G, R, A
inline constexpr std::uint32_t kXbgr8888 = drmFourcc('X', 'B', '2', '4');  ///< bytes R, G, B, X
inline constexpr std::uint32_t kAbgr8888 = drmFourcc('A', 'B', '2', '4');  ///< bytes R, G, B, A

/// "rows (linear)", "modifier 0x0100000000000001".
std::string layoutText(std::uint64_t modifier);

/// Which of its output's surfaces one is. It lasts as long as the surface does, so that what was
/// imported is kept by it, never by a file descriptor's number.
enum class SurfaceId : std::uint32_t {};

/// A plane of a surface.
struct SurfacePlane {
  int dmaBuf = -1;  ///< a file descriptor of the output's
  std::size_t offsetBytes = 0;
  std::size_t strideBytes = 0;
};

/// A buffer that an output lends. A value that refers to the output's buffer.
struct Surface {
  SurfaceId id{};
  FrameFormat format;  ///< of the picture that it shows
  std::uint32_t fourcc = kXrgb8888;
  std::uint64_t modifier = kLinearModifier;
  int planeCount = 1;
  std::array<SurfacePlane, 4> planes;
};

/// A texture of an output's as the contexts of one EGL display share it, whichever thread they
/// belong to (EGL_KHR_gl_texture_2D_image).
struct SharedTexture {
  void* display = nullptr;      ///< EGLDisplay
  std::shared_ptr<void> image;  ///< EGLImage, RGBA8; keeps the memory. Null: there is none
};

/// A surface that a GPU draws into: a texture, or else memory with descriptors. Its planes are the
/// whole buffer's.
struct GpuSurface {
  Surface surface;
  FrameSize bufferSize;
  int x = 0;  ///< of the picture in the buffer, which is black elsewhere
  int y = 0;
  SharedTexture texture = {};
};

/// A GpuSurface that a painter has, of one of several loans of an output.
struct LentSurface {
  std::uint64_t loan = 0;
  SurfaceId id{};
  friend bool operator==(const LentSurface&, const LentSurface&) = default;
};

/// When a surface's content is complete: a sync_file that it owns, or nothing, where it is
/// already. Move-only; any thread.
class Fence {
 public:
  /// Signalled.
  Fence() = default;
  /// Takes the descriptor over.
  explicit Fence(int syncFile) : syncFile_(syncFile) {}
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  Fence(Fence&& other) noexcept : syncFile_(std::exchange(other.syncFile_, -1)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(syncFile_, other.syncFile_);
    return *this;
  }
  ~Fence();

  /// −1: signalled.
  int syncFile() const { return syncFile_; }
  /// Never waits.
  bool hasSignalled() const;

 private:
  int syncFile_ = -1;
};

/// Ends the processor's access to a surface. An output implements it; SurfaceMapping calls it.
class SurfaceUnmapper {
 public:
  virtual void unmap(SurfaceId surface) = 0;

 protected:
  ~SurfaceUnmapper() = default;
};

/// The processor's access to a surface, from map() until it is destroyed: what lies between the
/// start and the end of DMA_BUF_IOCTL_SYNC for buffers that need it. Move-only; the output outlives
/// it; the output's thread.
class SurfaceMapping {
 public:
  /// `planes`: the bytes of each plane from its offset on.
  SurfaceMapping(SurfaceUnmapper& unmapper, SurfaceId surface,
                 std::array<std::span<std::uint8_t>, 4> planes)
      : unmapper_(&unmapper), surface_(surface), planes_(planes) {}
  SurfaceMapping(const SurfaceMapping&) = delete;
  SurfaceMapping& operator=(const SurfaceMapping&) = delete;
  SurfaceMapping(SurfaceMapping&& other) noexcept
      : unmapper_(std::exchange(other.unmapper_, nullptr)),
        surface_(other.surface_),
        planes_(other.planes_) {}
  SurfaceMapping& operator=(SurfaceMapping&&) = delete;
  ~SurfaceMapping() {
    if (unmapper_ != nullptr) unmapper_->unmap(surface_);
  }

  std::span<std::uint8_t> plane(std::size_t index) const { return planes_.at(index); }

 private:
  SurfaceUnmapper* unmapper_;
  SurfaceId surface_;
  std::array<std::span<std::uint8_t>, 4> planes_;
};

/// Copies an RGBA picture of the surface's size into its memory, in the surface's order of
/// channels. Errors: kUnsupported (another picture format, fourcc or modifier), kInvalidArgument
/// (the sizes differ, or the mapping is too small).
Result<void> copyToSurface(const ImageView& picture, const Surface& surface,
                           const SurfaceMapping& mapping);

}  // namespace pleinair::hal

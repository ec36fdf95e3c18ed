#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/frames/frame_upload.h"
#include "pipeline/gpu/gpu_loss.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/gpu/texture.h"

namespace pleinair::gpu {

/// How the frames of a camera reach the GPU.
enum class FramePath {
  kUploaded,  ///< the processor copies their planes
  kTrying,    ///< copied while a trial of importing them runs
  kImported,  ///< the GPU reads the camera's memory
};
std::string_view toString(FramePath path);

/// What became of a camera's frames so far.
struct FramePathStatus {
  FramePath path = FramePath::kUploaded;
  std::string reason;      ///< why they are uploaded, or how they are imported; empty: no frame yet
  hal::Duration trial{0};  ///< from the first frame of the memory to the verdict
  std::uint64_t imported = 0;
  std::uint64_t uploaded = 0;
  std::uint64_t uploadedBytes = 0;
  std::uint64_t heldLeases = 0;  ///< buffers that the GPU may still read
};

/// Brings camera frames to the GPU without a copy where the driver truly can, else by upload; the
/// pictures are the same to the bit. The paint thread's, in one GL context.
///
/// That a driver makes an image of a camera's memory without an error proves nothing: one was seen
/// to give other pixels, another to crash in the draw. So each memory (BufferIdentity::pool) is
/// tried with its first frame whose pixels can tell right from wrong, against the processor's view;
/// and once more when a buffer comes round for the first time, because an image may be a snapshot.
/// Frames are uploaded until the verdict, and for ever after a refusal or the first failure; on
/// software renderers always.
///
/// Images are kept by buffer identity. A frame's lease is held until the fence behind the pass that
/// reads the buffer has signalled; while kMostHeld are held, frames are uploaded. Never waits, but
/// for the two comparisons and in the destructor.
class CameraFrames {
 public:
  /// Frames whose buffers the GPU may hold.
  static constexpr std::size_t kMostHeld = 3;

  CameraFrames(const ShaderLibrary& library, const ContextInfo& context,
               const GpuTestHook& testHook = {}, const hal::Clock& clock = hal::steadyClock());
  ~CameraFrames();
  CameraFrames(const CameraFrames&) = delete;
  CameraFrames& operator=(const CameraFrames&) = delete;

  /// As FrameUploader::upload(). Precondition: frame.image.isComplete().
  const Texture& show(const hal::CapturedFrame& frame, hal::FrameSize size, const AspectFill& fit);

  /// The planes of the last frame, as importedPlane() has them, if it was imported; else none.
  /// Valid until the next show().
  std::span<const Texture> importedPlanes() const;
  /// The GPU was given more work that reads the last frame's buffer: its lease is held until that
  /// is done, too.
  void holdLonger();

  const FramePathStatus& status() const { return status_; }
  /// For frames that no camera has made: warming up.
  FrameUploader& uploader() { return uploader_; }

  /// Gives back the frames that the GPU has read. To be called also while no frames come: a camera
  /// that is lost cannot come back before.
  void releaseRead();

 private:
  /// The images of a buffer's planes.
  struct ImportedBuffer {
    std::array<Texture, 3> planes;
    bool isKnown = false;
  };
  struct Reading {
    std::shared_ptr<const void> lease;
    Fence fence;
  };

  const Texture& upload(const hal::CapturedFrame& frame, hal::FrameSize size,
                        const AspectFill& fit);
  void beginMemory(const hal::CapturedFrame& frame);
  std::string problemOf(const hal::CapturedFrame& frame) const;
  bool followTrial(const hal::CapturedFrame& frame);
  ImportedBuffer& imported(const hal::CapturedFrame& frame);
  bool compare(const hal::CapturedFrame& frame);
  void hold(const hal::CapturedFrame& frame);
  void decide(FramePath path, std::string reason);
  void refuse(std::string reason);

  FrameUploader uploader_;
  ContextInfo context_;
  GpuTestHook testHook_;
  const hal::Clock& clock_;
  FramePathStatus status_;

  // Of the memory that frames come in now.
  std::uint64_t pool_ = 0;
  hal::FrameFormat format_;
  std::uint64_t modifier_ = hal::kLinearModifier;
  hal::TimePoint began_;
  bool isConfirmed_ = false;             ///< a buffer has come round
  std::vector<ImportedBuffer> buffers_;  ///< by BufferIdentity::index
  std::optional<std::uint32_t> shown_;   ///< the buffer of the last frame, if it was imported
  std::vector<Reading> readings_;        ///< oldest first
};

}  // namespace pleinair::gpu

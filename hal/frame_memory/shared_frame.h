#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "hal/captured_frame.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/frame_allocator.h"
#include "hal/mapped_memory.h"

namespace pleinair::hal {

/// A frame that no camera has made, in one dma-buf of an allocator, its planes one after the other:
/// for trying whether a GPU reads such memory. One thread.
class SharedFrame {
 public:
  /// Errors: the allocator's; kIo where the memory cannot be mapped.
  static Result<std::unique_ptr<SharedFrame>> make(FrameAllocator& allocator, FrameFormat format);
  SharedFrame(const SharedFrame&) = delete;
  SharedFrame& operator=(const SharedFrame&) = delete;

  /// Precondition: a picture of the same format.
  void write(const ImageView& picture);
  /// The frame, as buffer `identity`; valid while this lives.
  CapturedFrame frame(BufferIdentity identity) const;

 private:
  SharedFrame(FileDescriptor dmaBuf, MappedMemory memory);

  FileDescriptor dmaBuf_;
  MappedMemory memory_;
  FrameFormat format_;
  std::array<DmaBufPlane, 3> planes_;
};

}  // namespace pleinair::hal

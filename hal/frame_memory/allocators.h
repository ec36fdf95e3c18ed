#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/frame_allocator.h"

namespace pleinair::hal {

/// Where memory that a camera and a GPU share can come from.
enum class AllocatorKind {
  kHeap,     ///< /dev/dma_heap: "linux,cma" where there is one, which drivers without an IOMMU need
  kUdmabuf,  ///< pages of this process (/dev/udmabuf)
  kVgem,     ///< the card without hardware that software renderers import from
};
std::string_view toString(AllocatorKind kind);
std::vector<AllocatorKind> allAllocatorKinds();

/// Opens an allocator. Errors: kNotFound (the kernel has none, or its module is not loaded),
/// kPermissionDenied, kIo. Any thread.
Result<std::shared_ptr<FrameAllocator>> openAllocator(AllocatorKind kind);

}  // namespace pleinair::hal

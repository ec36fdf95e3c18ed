#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "hal/image.h"

namespace pleinair::hal::synthetic {

/// Pictures of one format that go around: a lease comes back when its last copy is dropped, on any
/// thread, after the pool itself is gone too.
class FramePool {
 public:
  explicit FramePool(FrameFormat format) : format_(format), shelf_(std::make_shared<Shelf>()) {}

  /// A picture with whatever was in it before; a new one where all are out. Thread-safe.
  std::shared_ptr<Image> take();

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<Image>> free;
  };
  FrameFormat format_;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace pleinair::hal::synthetic

#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "hal/image.h"

namespace pleinair::hal::synthetic {

/// A pool of images of one format. A lease returns its image to the pool when its last copy is
/// dropped, on any thread, also after the destruction of the pool.
class FramePool {
 public:
  explicit FramePool(FrameFormat format) : format_(format), shelf_(std::make_shared<Shelf>()) {}

  /// Lends an image with undefined content; allocates a new one if all are lent. Thread-safe.
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

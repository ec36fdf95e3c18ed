#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "hal/image.h"

namespace pleinair::hal {

/// A pool of images of one format. A lease returns its image to the pool when its last copy is
/// dropped, on any thread, also after the destruction of the pool.
class FramePool {
 public:
  explicit FramePool(FrameFormat format) : format_(format), shelf_(std::make_shared<Shelf>()) {}

  /// Lends an image with undefined content; allocates a new one if all are lent. Thread-safe.
  std::shared_ptr<Image> take() {
    std::unique_ptr<Image> image;
    {
      const std::scoped_lock lock(shelf_->mutex);
      if (!shelf_->free.empty()) {
        image = std::move(shelf_->free.back());
        shelf_->free.pop_back();
      }
    }
    if (!image) image = std::make_unique<Image>(format_);
    return {image.release(), [shelf = shelf_](Image* returned) {
              std::unique_ptr<Image> owned(returned);
              const std::scoped_lock lock(shelf->mutex);
              shelf->free.push_back(std::move(owned));
            }};
  }

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<Image>> free;
  };
  FrameFormat format_;
  std::shared_ptr<Shelf> shelf_;
};

}  // namespace pleinair::hal

#include "hal/cameras/synthetic/frame_pool.h"

#include <utility>

namespace pleinair::hal::synthetic {

std::shared_ptr<Image> FramePool::take() {
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

}  // namespace pleinair::hal::synthetic

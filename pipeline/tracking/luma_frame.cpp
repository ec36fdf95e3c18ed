#include "pipeline/tracking/luma_frame.h"

#include <algorithm>

#include "pipeline/tracking/luma_pyramid.h"

namespace pleinair::tracking {

void LumaFrame::take(const hal::ImageView& image) {
  image_ = image;
  size_ = image.format.size;
  luma_.reset();
  pyramid_.reset();
}

void LumaFrame::take(const hal::PlaneView& luma, hal::FrameSize size) {
  luma_ = luma;
  size_ = size;
  pyramid_.reset();
}

const hal::PlaneView& LumaFrame::luma() {
  if (!luma_) luma_ = converter_.convert(image_);
  return *luma_;
}

std::shared_ptr<const LumaPyramid> LumaFrame::pyramid() {
  if (pyramid_) return pyramid_;
  const auto free =
      std::ranges::find_if(pyramids_, [](const auto& each) { return each.use_count() == 1; });
  const auto made =
      free != pyramids_.end() ? *free : pyramids_.emplace_back(std::make_shared<LumaPyramid>());
  made->load(luma(), size_, kLongSidePx);
  pyramid_ = made;
  return pyramid_;
}

}  // namespace pleinair::tracking

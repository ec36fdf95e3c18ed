#include "hal/cameras/synthetic/tag_bitmap.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <apriltag/apriltag.h>
#include <apriltag/common/image_u8.h>
#include <apriltag/tag36h11.h>

namespace pleinair::hal::synthetic {
namespace {

struct FamilyDeleter {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct ImageDeleter {
  void operator()(image_u8_t* image) const { image_u8_destroy(image); }
};

}  // namespace

TagBitmap tag36h11Bitmap(int id) {
  const std::unique_ptr<apriltag_family_t, FamilyDeleter> family(tag36h11_create());
  assert(id >= 0 && static_cast<std::uint32_t>(id) < family->ncodes);
  const std::unique_ptr<image_u8_t, ImageDeleter> image(
      apriltag_to_image(family.get(), static_cast<std::uint32_t>(id)));
  assert(image->width == kTagCells && image->height == kTagCells);
  TagBitmap bitmap{};
  for (std::size_t row = 0; row < kTagCells; ++row) {
    for (std::size_t column = 0; column < kTagCells; ++column) {
      bitmap[row][column] =
          image->buf[row * static_cast<std::size_t>(image->stride) + column] > 127;
    }
  }
  return bitmap;
}

}  // namespace pleinair::hal::synthetic

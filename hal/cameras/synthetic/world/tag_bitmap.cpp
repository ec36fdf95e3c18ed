#include "hal/cameras/synthetic/world/tag_bitmap.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

namespace pleinair::hal::synthetic {
namespace {

struct FamilyDeleter {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};

}  // namespace

TagBitmap tag36h11Bitmap(int id) {
  const std::unique_ptr<apriltag_family_t, FamilyDeleter> family(tag36h11_create());
  assert(id >= 0 && static_cast<std::uint32_t>(id) < family->ncodes);
  assert(family->total_width == kTagCells && family->width_at_border == kTagCellsPerEdge);
  TagBitmap bitmap{};
  for (std::size_t i = 0; i < kTagCells; ++i) {
    bitmap[0][i] = bitmap[kTagCells - 1][i] = bitmap[i][0] = bitmap[i][kTagCells - 1] = true;
  }
  // Same layout as apriltag_to_image(), which is not used: freeing its image takes a second
  // library.
  constexpr std::size_t kBorderStart = (kTagCells - kTagCellsPerEdge) / 2;
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    const std::size_t row = family->bit_y[bit] + kBorderStart;
    const std::size_t column = family->bit_x[bit] + kBorderStart;
    bitmap[row][column] = (family->codes[id] >> (family->nbits - bit - 1) & 1) != 0;
  }
  return bitmap;
}

}  // namespace pleinair::hal::synthetic

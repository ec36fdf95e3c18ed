#include "hal/cameras/synthetic/world/bench_tags.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/workbench.h"

namespace pleinair::hal {
namespace {

/// A tag that lies face up on an upright object and reads upright along the object's y.
BenchTag lying(int id, double edgeMetres, const glm::dmat4& pose, glm::dvec3 at) {
  const glm::dmat4 tag(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                       glm::dvec4(at, 1));
  return {id, "tag36h11", edgeMetres, pose * tag};
}

/// A tag on an object's front, upright along the object's y.
BenchTag onFront(int id, double edgeMetres, const glm::dmat4& pose, glm::dvec3 at) {
  const glm::dmat4 tag(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0), glm::dvec4(0, 1, 0, 0),
                       glm::dvec4(at, 1));
  return {id, "tag36h11", edgeMetres, pose * tag};
}

}  // namespace

glm::dvec3 tagCorner(double edgeMetres, int corner) {
  assert(corner >= 0 && corner < 4);
  const double half = edgeMetres / 2;
  return {corner == 1 || corner == 2 ? half : -half, corner < 2 ? half : -half, 0};
}

std::vector<BenchTag> benchTags() {
  using namespace synthetic;  // NOLINT(google-build-using-namespace): the layout's names
  return {lying(0, 0.10, glm::dmat4(1), {0, 0, 0}),
          onFront(1, 0.085, kToolboxPose, {0.02, -kToolboxSize.y / 2, kToolboxSize.z / 2 - 0.012}),
          onFront(2, 0.08, kMachinePose, {-0.03, -kMachineSize.y / 2, kMachineSize.z / 2}),
          onFront(3, 0.10, glm::translate(glm::dmat4(1), kWallSheetCentre), {0, 0, -0.02}),
          lying(4, 0.08, kBooksPose, {0.0, 0.0, kBooksHeight})};
}

}  // namespace pleinair::hal

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

#include "pipeline/tracking/pose/tag_detector.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include <apriltag/apriltag.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/tracking/pose/tag_family.h"

namespace pleinair::tracking {
namespace {

using DetectorHandle = std::unique_ptr<apriltag_detector_t, decltype(&apriltag_detector_destroy)>;
using DetectionsHandle = std::unique_ptr<zarray_t, decltype(&apriltag_detections_destroy)>;

TagDetection toDetection(const apriltag_detection_t& found) {
  TagDetection tag{.id = found.id,
                   .hamming = found.hamming,
                   .decisionMargin = static_cast<double>(found.decision_margin)};
  for (std::size_t corner = 0; corner < 4; ++corner) {
    tag.corners[corner] = {found.p[corner][0], found.p[corner][1]};
  }
  return tag;
}

double squaredDistance(const TagCornersPx& a, const TagCornersPx& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return sum;
}

/// The region around a tag: its white border and a margin for motion, a third of the tag's size, or
/// more for small ones. Aligned, so that a reduced region has the pixels of the reduced image.
std::optional<PixelRect> partAround(const TagCornersPx& corners, hal::FrameSize size) {
  constexpr double kMargin = 0.35;
  constexpr double kMinMarginPx = 16.0;
  constexpr int kAlignment = 12;  // a common multiple of all decimations
  glm::dvec2 least = corners[0];
  glm::dvec2 most = corners[0];
  for (const glm::dvec2& corner : corners) {
    least = glm::min(least, corner);
    most = glm::max(most, corner);
  }
  const glm::dvec2 extent = most - least;
  const glm::dvec2 margin(std::max({kMargin * extent.x, kMargin * extent.y, kMinMarginPx}));
  least -= margin;
  most += margin;
  if (!(most.x > 0.0 && most.y > 0.0 && least.x < size.width && least.y < size.height)) {
    return std::nullopt;
  }
  const auto within = [](double px, int end) {
    return static_cast<int>(std::clamp(px, 0.0, static_cast<double>(end)));
  };
  const auto aligned = [&](double px, int end) {
    return within(px, end - std::min(end, kSmallestSearchedSidePx)) / kAlignment * kAlignment;
  };
  PixelRect part{.left = aligned(least.x, size.width),
                 .top = aligned(least.y, size.height),
                 .right = within(most.x, size.width),
                 .bottom = within(most.y, size.height)};
  part.right = std::min(size.width, std::max(part.right, part.left + kSmallestSearchedSidePx));
  part.bottom = std::min(size.height, std::max(part.bottom, part.top + kSmallestSearchedSidePx));
  if (part.right - part.left < kSmallestSearchedSidePx ||
      part.bottom - part.top < kSmallestSearchedSidePx) {
    return std::nullopt;
  }
  return part;
}

bool overlap(const PixelRect& a, const PixelRect& b) {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}

PixelRect hull(const PixelRect& a, const PixelRect& b) {
  return {.left = std::min(a.left, b.left),
          .top = std::min(a.top, b.top),
          .right = std::max(a.right, b.right),
          .bottom = std::max(a.bottom, b.bottom)};
}

}  // namespace

double decimationFor(hal::FrameSize size) {
  const int shorterSide = std::min(size.width, size.height);
  if (shorterSide < 400) return 1.0;
  if (shorterSide < 700) return 1.5;
  return shorterSide < 1000 ? 2.0 : 3.0;
}

DetectionCounters& DetectionCounters::operator+=(const DetectionCounters& other) {
  accepted += other.accepted;
  rejectedMargin += other.rejectedMargin;
  rejectedDuplicate += other.rejectedDuplicate;
  skippedSmallPicture += other.skippedSmallPicture;
  return *this;
}

void selectDetections(std::vector<TagDetection>& candidates, const TagDetectorOptions& options,
                      DetectionCounters& counters, std::span<const ExpectedTag> expected) {
  std::ranges::sort(candidates, [&](const TagDetection& a, const TagDetection& b) {
    if (a.id != b.id) return a.id < b.id;
    const auto known = std::ranges::find(expected, a.id, &ExpectedTag::id);
    if (known == expected.end()) return a.decisionMargin > b.decisionMargin;
    return squaredDistance(a.corners, known->corners) < squaredDistance(b.corners, known->corners);
  });
  auto selectedEnd = candidates.begin();
  for (const TagDetection& tag : candidates) {
    if (tag.decisionMargin < options.minDecisionMargin) {
      ++counters.rejectedMargin;
    } else if (selectedEnd != candidates.begin() && std::prev(selectedEnd)->id == tag.id) {
      ++counters.rejectedDuplicate;
    } else {
      ++counters.accepted;
      *selectedEnd++ = tag;
    }
  }
  candidates.erase(selectedEnd, candidates.end());
}

/// The family must outlive the detector that uses it: members are destroyed last to first.
struct TagDetector::Handles {
  Handles(TagFamily opened, int maxHamming)
      : family(std::move(opened.handle)),
        detector(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family_bits(detector.get(), family.get(),
                                      std::min(opened.correctedBits, maxHamming));
  }
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family;
  DetectorHandle detector;
};

TagDetector::TagDetector(TagDetectorOptions options)
    : options_(std::move(options)),
      handles_(std::make_unique<Handles>(openTagFamily(options_.family), options_.maxHamming)) {
  assert(options_.decimation.value_or(1.0) >= 1.0 && options_.threads >= 1);
  assert(options_.maxHamming >= 0);
  apriltag_detector_t& detector = *handles_->detector;
  detector.nthreads = options_.threads;
  detector.refine_edges = true;
  detector.qtp.min_white_black_diff =
      static_cast<int>(std::clamp(2.0 * options_.minDecisionMargin, 1.0, 255.0));
}

TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

void findSearchParts(std::span<const ExpectedTag> expected, hal::FrameSize size,
                     std::vector<PixelRect>& parts) {
  parts.clear();
  for (const ExpectedTag& tag : expected) {
    const std::optional<PixelRect> part = partAround(tag.corners, size);
    if (part) parts.push_back(*part);
  }
  for (std::size_t i = 0; i < parts.size();) {
    const auto other = std::find_if(parts.begin() + std::ptrdiff_t(i) + 1, parts.end(),
                                    [&](const PixelRect& each) { return overlap(parts[i], each); });
    if (other == parts.end()) {
      ++i;
      continue;
    }
    parts[i] = hull(parts[i], *other);
    parts.erase(other);
    i = 0;  // regions that were disjoint may overlap now
  }
}

void TagDetector::search(const hal::PlaneView& luma, hal::FrameSize size, const PixelRect& part) {
  const int width = part.right - part.left;
  const int height = part.bottom - part.top;
  double decimation = options_.decimation.value_or(decimationFor(size));
  if (std::min(width, height) < kSmallestSearchedSidePx * decimation) decimation = 1.0;
  handles_->detector->quad_decimate = static_cast<float>(decimation);

  const std::size_t first =
      static_cast<std::size_t>(part.top) * luma.strideBytes + static_cast<std::size_t>(part.left);
  // Only read: quad_sigma is 0.
  image_u8_t picture{.width = width,
                     .height = height,
                     .stride = static_cast<std::int32_t>(luma.strideBytes),
                     .buf = const_cast<std::uint8_t*>(luma.bytes.data() + first)};
  const DetectionsHandle found(apriltag_detector_detect(handles_->detector.get(), &picture),
                               apriltag_detections_destroy);
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* one = nullptr;
    zarray_get(found.get(), i, &one);
    TagDetection& tag = found_.emplace_back(toDetection(*one));
    for (glm::dvec2& corner : tag.corners) corner += glm::dvec2(part.left, part.top);
  }
}

std::span<const TagDetection> TagDetector::detect(const hal::PlaneView& luma, hal::FrameSize size,
                                                  DetectionCounters& counters,
                                                  std::span<const ExpectedTag> expected) {
  found_.clear();
  if (std::min(size.width, size.height) < kSmallestSearchedSidePx) {
    ++counters.skippedSmallPicture;  // the library crashes on an image of a few pixels a side
    return {};
  }
  search(luma, size, {.left = 0, .top = 0, .right = size.width, .bottom = size.height});
  selectDetections(found_, options_, counters, expected);
  return found_;
}

std::span<const TagDetection> TagDetector::detectExpected(const hal::PlaneView& luma,
                                                          hal::FrameSize size,
                                                          DetectionCounters& counters,
                                                          std::span<const ExpectedTag> expected) {
  findSearchParts(expected, size, parts_);
  std::int64_t area = 0;
  for (const PixelRect& part : parts_) {
    area += std::int64_t{part.right - part.left} * (part.bottom - part.top);
  }
  if (area > size.pixels() / 2) return detect(luma, size, counters, expected);
  found_.clear();
  for (const PixelRect& part : parts_) search(luma, size, part);
  selectDetections(found_, options_, counters, expected);
  return found_;
}

}  // namespace pleinair::tracking

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::tracking {

/// The supported family. Others are weaker (16h5 gives false hits) or need far more memory and time
/// to start (a hundred megabytes and a second for those of 40,000 codes and more).
inline constexpr std::string_view kDefaultTagFamily = "tag36h11";

/// Checks whether a family of that name can be detected. The error (kInvalidArgument) has `subject`
/// and lists the families that can.
hal::Result<void> checkTagFamily(std::string_view family, std::string subject = "tag family");

struct TagDetectorOptions {
  std::string family{kDefaultTagFamily};
  /// Quads are searched in an image reduced by this factor (≥ 1); codes are read and edges refined
  /// at full size. Unset: decimationFor() the image.
  std::optional<double> decimation;
  int threads = 1;
  /// Most corrected bits of an accepted code, up to those in the family's table (each more takes
  /// memory: two 36 MB for tag36h11, one 1 MB). A code with more is no tag.
  int maxHamming = 1;
  /// Least mean distance of a bit from its decision threshold, in grey levels (0..255). Regions
  /// whose contrast is below twice this are not searched: no tag there would be accepted.
  double minDecisionMargin = 10.0;
};

/// Images with a side below this are not searched.
inline constexpr int kSmallestSearchedSidePx = 32;

/// Returns 1 for images up to 399 px high (or wide, if that is less), 1.5 up to 699, 2 up to 999,
/// and 3 beyond: small tags are found in small images, and large images are searched in few
/// milliseconds.
double decimationFor(hal::FrameSize size);

struct TagDetection {
  int id = 0;
  int hamming = 0;              ///< corrected bits
  double decisionMargin = 0.0;  ///< grey levels
  TagCornersPx corners{};       ///< pixel centres at +0.5; order: tagCorners()
};

/// Outcomes of the quads that read as tags, per image.
struct DetectionCounters {
  std::uint32_t accepted = 0;
  std::uint32_t rejectedMargin = 0;  ///< bits too close to their threshold
  /// Another of its id was nearer to the expected position, or clearer.
  std::uint32_t rejectedDuplicate = 0;
  std::uint32_t skippedSmallPicture = 0;

  DetectionCounters& operator+=(const DetectionCounters& other);
  friend bool operator==(const DetectionCounters&, const DetectionCounters&) = default;
};

/// The expected position of a tag, from earlier frames.
struct ExpectedTag {
  int id = 0;
  TagCornersPx corners{};
};

/// A region of an image, from (left, top) to before (right, bottom).
struct PixelRect {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// Finds the regions in which to search for expected tags: disjoint rectangles within the image,
/// each with one or more tags and a margin for their motion. Tags outside of the image get none.
void findSearchParts(std::span<const ExpectedTag> expected, hal::FrameSize size,
                     std::vector<PixelRect>& parts);

/// Keeps the accepted `candidates`, by rising id, each id once: of several with one id, the one at
/// the tag's expected position, or else the one with the largest margin. Counts the others by
/// reason.
void selectDetections(std::vector<TagDetection>& candidates, const TagDetectorOptions& options,
                      DetectionCounters& counters, std::span<const ExpectedTag> expected = {});

/// Finds the AprilTags of one family (libapriltag: Wang and Olson, AprilTag 2, IROS 2016). Owns its
/// detector and its family, which threads must not share; one thread at a time.
class TagDetector {
 public:
  /// Throws Failure for an unknown family. Precondition: options in their ranges.
  explicit TagDetector(TagDetectorOptions options = {});
  ~TagDetector();
  TagDetector(TagDetector&&) noexcept;
  TagDetector& operator=(TagDetector&&) noexcept;
  TagDetector(const TagDetector&) = delete;
  TagDetector& operator=(const TagDetector&) = delete;

  const TagDetectorOptions& options() const { return options_; }

  /// Detects the tags in a luma plane of `size`. Returns them by rising id, each id once; valid
  /// until the next call. Adds to `counters`.
  std::span<const TagDetection> detect(const hal::PlaneView& luma, hal::FrameSize size,
                                       DetectionCounters& counters,
                                       std::span<const ExpectedTag> expected = {});

  /// The same, but searches only around expected tags, which takes a fraction of the time.
  std::span<const TagDetection> detectExpected(const hal::PlaneView& luma, hal::FrameSize size,
                                               DetectionCounters& counters,
                                               std::span<const ExpectedTag> expected);

 private:
  struct Handles;
  /// Searches a region of the image and adds the tags to found_.
  void search(const hal::PlaneView& luma, hal::FrameSize size, const PixelRect& part);

  TagDetectorOptions options_;
  std::unique_ptr<Handles> handles_;
  std::vector<TagDetection> found_;
  std::vector<PixelRect> parts_;
};

}  // namespace pleinair::tracking

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

/// The family that is promised to work: others are weaker (16h5 gives false hits) or need far more
/// memory and time to start (a hundred megabytes and a second for those of 40,000 codes and more).
inline constexpr std::string_view kDefaultTagFamily = "tag36h11";

/// Whether a family of that name can be detected; else an error (kInvalidArgument) with `subject`
/// that lists those that can.
hal::Result<void> checkTagFamily(std::string_view family, std::string subject = "tag family");

struct TagDetectorOptions {
  std::string family{kDefaultTagFamily};
  /// Quads are searched in a picture reduced by this factor (≥ 1); codes are read and edges refined
  /// at full size. Unset: decimationFor() the picture.
  std::optional<double> decimation;
  int threads = 1;
  /// Corrected bits that are believed, of those that the family's table has (each more takes
  /// memory: two 36 MB for tag36h11, one 1 MB). A code with more is no tag.
  int maxHamming = 1;
  /// Least mean difference of a bit to its decision threshold, in grey levels (0..255). Places
  /// whose contrast is less than twice this are not searched: no tag there could be believed.
  double minDecisionMargin = 10.0;
};

/// Pictures with a side below this are not searched.
inline constexpr int kSmallestSearchedSidePx = 32;

/// 1 for pictures up to 399 px high (or wide, if that is less), 1.5 up to 699, 2 up to 999, 3
/// beyond: small tags are found in small pictures, and large ones are searched in few milliseconds.
double decimationFor(hal::FrameSize size);

struct TagDetection {
  int id = 0;
  int hamming = 0;              ///< corrected bits
  double decisionMargin = 0.0;  ///< grey levels
  TagCornersPx corners{};       ///< pixel centres at +0.5; order: tagCorners()
};

/// What became of the quads that read as tags, per picture.
struct DetectionCounters {
  std::uint32_t accepted = 0;
  std::uint32_t rejectedMargin = 0;     ///< bits too close to their threshold
  std::uint32_t rejectedDuplicate = 0;  ///< another of its id was expected there, or clearer
  std::uint32_t skippedSmallPicture = 0;

  DetectionCounters& operator+=(const DetectionCounters& other);
  friend bool operator==(const DetectionCounters&, const DetectionCounters&) = default;
};

/// Where a tag should be, by what is known from before.
struct ExpectedTag {
  int id = 0;
  TagCornersPx corners{};
};

/// A part of a picture, from (left, top) to before (right, bottom).
struct PixelRect {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
};

/// Where to look for expected tags: rectangles that hold one or more of them with what they may
/// have moved by, within the picture and disjoint; none for tags that are not in it.
void findSearchParts(std::span<const ExpectedTag> expected, hal::FrameSize size,
                     std::vector<PixelRect>& parts);

/// Leaves the accepted of `candidates`, by rising id, each id once: of several the one that is
/// where the tag is expected, or else whose margin is largest. Counts the others by reason.
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

  /// The tags in a luma plane of `size`, by rising id, each id once; valid until the next call.
  /// Adds to `counters`.
  std::span<const TagDetection> detect(const hal::PlaneView& luma, hal::FrameSize size,
                                       DetectionCounters& counters,
                                       std::span<const ExpectedTag> expected = {});

  /// The same, but looks only where tags are expected, and a little around: a fraction of the time.
  std::span<const TagDetection> detectExpected(const hal::PlaneView& luma, hal::FrameSize size,
                                               DetectionCounters& counters,
                                               std::span<const ExpectedTag> expected);

 private:
  struct Handles;
  /// Searches a part of the picture and adds what it finds to found_.
  void search(const hal::PlaneView& luma, hal::FrameSize size, const PixelRect& part);

  TagDetectorOptions options_;
  std::unique_ptr<Handles> handles_;
  std::vector<TagDetection> found_;
  std::vector<PixelRect> parts_;
};

}  // namespace pleinair::tracking

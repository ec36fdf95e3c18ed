#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/clock.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/mover_masks.h"

namespace pleinair::measure {

// The regions of a sequence before a standing camera, each with what is measured in it
// (docs/measuring.md). Frames are added in turn. A value is missing where nothing was compared.

/// A frame and its painting, of one size.
struct MoverFrame {
  hal::TimePoint time;
  const cv::Mat3b& input;
  const cv::Mat3b& output;
  const MoverZones& zones;
};

/// STILL, percent: the share of pixels whose painting changes by more than 8 levels from one frame
/// to the next, among those away from movers whose input does not, and which are as far from where
/// it has changed by more than noise, other than by movers, within a second.
class StillRegion {
 public:
  explicit StillRegion(cv::Size size);

  void add(const MoverFrame& frame);
  std::optional<double> percent() const;
  /// The share of all pixels away from movers whose input changes.
  std::optional<double> inputPercent() const;

 private:
  cv::Mat3b input_, mean_, output_;  // of the previous frame; the second over 3×3 pixels of it
  cv::Mat1b far_;
  std::vector<std::optional<hal::TimePoint>> changedAt_;  // the input at or near each pixel
  Mean changed_;
  Mean inputChanged_;
};

/// Places away from movers whose input changes at once, as where a lamp is switched on, and then
/// stays as it is for a second. FOLLOW: how far the smoothed painting is 0.3 s after that from what
/// it comes to, over how far it was before.
class SuddenChangeRegion {
 public:
  explicit SuddenChangeRegion(cv::Size size);

  void add(const MoverFrame& frame);
  /// Nothing unless 0.3 % of the picture has changed so: less may be a mover that was not found.
  std::optional<double> follow() const;

 private:
  /// A change of one pixel that has not been measured yet.
  struct Change {
    hal::TimePoint at;
    cv::Vec3b before;  // the smoothed painting
    std::optional<cv::Vec3b> soonAfter;
  };
  // The previous frame: its input over 3×3 pixels, its painting smoothed.
  cv::Mat3b mean_, output_;
  cv::Mat1b far_;
  std::vector<std::optional<Change>> changes_;
  Mean apart_;
  Mean whole_;
};

/// What each place showed when it was last seen without a mover.
class Ground {
 public:
  explicit Ground(cv::Size size);

  bool isKnown(cv::Point at) const { return isKnown_(at) != 0; }
  const cv::Vec3b& input(cv::Point at) const { return input_(at); }
  const cv::Vec3b& painted(cv::Point at) const { return painted_(at); }
  /// Where it is not known, a picture that was painted with a mover: the first one.
  const cv::Mat3b& painting() const { return painted_; }
  void take(cv::Point at, const MoverFrame& frame);
  /// Precondition: nothing is known yet.
  void start(const cv::Mat3b& painting) { painted_ = painting.clone(); }

 private:
  cv::Mat3b input_, painted_;
  cv::Mat1b isKnown_;
};

/// Places that a mover covers and leaves again. RETURN: how far the painting differs, a second
/// after a mover has left, from that before it came. GHOST: the same after 0.2 s, over the mover's
/// contrast. Both where the input came back.
class UncoveredRegion {
 public:
  explicit UncoveredRegion(cv::Size size);

  /// Adds to `ground` what is seen without a mover.
  void add(const MoverFrame& frame, Ground& ground);
  std::optional<double> returnLevels() const { return returned_.value(); }
  std::optional<double> ghost() const { return ratio(ghost_.value(), contrast_.value()); }

 private:
  /// The visit of movers at one pixel.
  struct Visit {
    bool isAway = false;  // a mover was here and has left
    bool isGhostTaken = false;
    hal::TimePoint leftAt;
    Mean contrast;
  };
  void cover(Visit& visit, cv::Point at, const MoverFrame& frame, const Ground& ground);
  /// Whether RETURN has still to be measured; until then, the ground stays as it was before.
  bool awaitsReturn(Visit& visit, cv::Point at, const MoverFrame& frame, const Ground& ground);

  cv::Size size_;
  std::vector<Visit> visits_;
  Mean returned_;
  Mean ghost_;
  Mean contrast_;
};

/// The mover's clear pixels. LOST, percent: those whose painting is nearer to the painted ground
/// than to the camera's picture in the painting's palette (inPaletteOf()).
class LostRegion {
 public:
  void add(const MoverFrame& frame, const Ground& ground);
  std::optional<double> percent() const;

 private:
  Mean lost_;
};

/// Places that movers covered in the first frame, from 1 s after they have left. REMAINS, percent:
/// those whose painting is nearer to that of the first frame than to the camera's picture.
class FirstPlaceRegion {
 public:
  void add(const MoverFrame& frame);
  std::optional<double> percent() const;

 private:
  cv::Mat3b input_, painted_;  // of the first frame, the latter smoothed
  cv::Mat1b mover_;
  std::vector<hal::TimePoint> coveredAt_;  // the last time, of each pixel
  Mean remains_;
};

}  // namespace pleinair::measure

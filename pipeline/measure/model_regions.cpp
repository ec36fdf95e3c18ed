#include "pipeline/measure/model_regions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/mover_masks.h"
#include "pipeline/measure/output_measures.h"

namespace pleinair::measure {
namespace {

constexpr int kOutlinePixels = 8;
/// The later picture tells two motions apart where it differs by more; as in POP.
constexpr double kToldLevels = 24.0;
/// Fewer marks of a whole sequence are no share.
constexpr double kMinMarks = 30;
/// With fewer pixels, noise could decide.
constexpr double kMinTold = 300;
/// Marks that are displaced by less could pass as carried.
constexpr float kMovedPixels = 2.0F;

/// 255 where two displacements, or one and none, differ clearly.
cv::Mat1b differing(const cv::Mat2f& a, const cv::Mat2f& b, const cv::Mat1b& within) {
  cv::Mat1b mask(within.size(), 0);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (within(y, x) == 0) continue;
      const cv::Vec2f by = b.empty() ? a(y, x) : a(y, x) - b(y, x);
      mask(y, x) = std::hypot(by[0], by[1]) >= kMovedPixels ? 255 : 0;
    }
  }
  return mask;
}

/// The masks of all regions for a frame with these models, which then move so.
PerRegion<cv::Mat1b> regionsOf(const cv::Mat1b& models, const cv::Mat1b& changed,
                               const MotionMap& motion) {
  const cv::Mat1b outer = grown(models, kOutlinePixels);
  PerRegion<cv::Mat1b> regions;
  cv::bitwise_or(outer, grown(changed, kOutlinePixels), regions[Region::kReal]);
  cv::bitwise_not(regions[Region::kReal], regions[Region::kReal]);
  regions[Region::kVirtual] = models;
  cv::subtract(outer, eroded(models, kOutlinePixels), regions[Region::kSeam]);
  cv::Mat1b followed;
  cv::bitwise_and(models, motion.valid, followed);
  regions[Region::kMoving] = differing(motion.displacement, {}, followed);
  return regions;
}

/// Smooths what a mask (0 or 1) shows, without what is beside it.
cv::Mat3f smoothedWithin(const cv::Mat3f& picture, const cv::Mat1f& mask) {
  cv::Mat1f weight;
  cv::GaussianBlur(mask, weight, {}, kHighPassSigmaPixels);
  cv::Mat3f sum(picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) sum(y, x) = picture(y, x) * mask(y, x);
  }
  cv::GaussianBlur(sum, sum, {}, kHighPassSigmaPixels);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) sum(y, x) *= 1.0F / std::max(weight(y, x), 1e-6F);
  }
  return sum;
}

/// The high pass of models and of the camera's image, each without the other: their difference in
/// colour, which moves on its own, would show up to 15 px beside outlines.
cv::Mat3f highPassOfEach(const cv::Mat3f& picture, const cv::Mat1b& models) {
  cv::Mat1f mask;
  models.convertTo(mask, CV_32F, 1.0 / 255.0);
  cv::Mat1f around;
  cv::subtract(1.0F, mask, around);
  cv::Mat3f smooth = smoothedWithin(picture, around);
  smoothedWithin(picture, mask).copyTo(smooth, models);
  cv::Mat3f fine;
  cv::subtract(picture, smooth, fine);
  return fine;
}

/// Mean square of two high passes at the same point: what unrelated marks would read. Where models
/// are small, there is no room to misalign them.
Mean energyOf(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later) {
  Mean energy;
  for (int y = 0; y < earlier.rows; ++y) {
    for (int x = 0; x < earlier.cols; ++x) {
      if (later.mask(y, x) == 0) continue;
      const cv::Vec3f& a = earlier(y, x);
      const cv::Vec3f& b = later.picture(y, x);
      energy += {static_cast<double>(a.dot(a) + b.dot(b)), 3.0};
    }
  }
  return energy;
}

std::optional<double> scaled(std::optional<double> value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

}  // namespace

void ModelRegions::add(const PerSubject<cv::Mat3f>& pictures, const cv::Mat1b& models,
                       const cv::Mat1b& changed, const ModelMotionFromPast& motion) {
  Earlier now{.greys = {}, .models = models, .changed = changed};
  for (const Subject subject : kAllSubjects) now.greys[subject] = greyOf(pictures[subject]);
  recent_.push_back({.pictures = pictures, .models = models, .changed = changed});
  earlier_.push_back(std::move(now));
  if (motion.shortLag != nullptr && recent_.size() > kShortLag) {
    compareShortLag(*motion.shortLag, motion.forgetting);
  }
  if (motion.longLag != nullptr && earlier_.size() > kLongLag) compareLongLag(*motion.longLag);
  if (recent_.size() > kShortLag) recent_.pop_front();
  if (earlier_.size() > kLongLag) earlier_.pop_front();
}

void ModelRegions::compareShortLag(const MotionMap& motion, const MotionMap* forgetting) {
  const Recent& earlier = recent_.front();
  const Recent& later = recent_.back();
  const PerRegion<cv::Mat1b> regions = regionsOf(earlier.models, earlier.changed, motion);
  PerRegion<MotionMap> maps;
  for (const Region region : kAllRegions) {
    covered_[region] += shareWithinBorder(regions[region]);
    maps[region] = limitedTo(regions[region], motion);
  }
  for (const Subject subject : kAllSubjects) {
    const cv::Mat3f& from = earlier.pictures[subject];
    const cv::Mat3f& to = later.pictures[subject];
    const cv::Mat3f fine = highPassOfEach(from, earlier.models);
    const cv::Mat3f fineLater = highPassOfEach(to, later.models);
    for (const Region region : kAllRegions) {
      Sums& sums = sums_[region][subject];
      const Warped<cv::Mat3f> carried = warpedBack(to, maps[region]);
      sums.error += warpingError(from, carried);
      sums.popped += poppedShare(from, carried);
      const Warped<cv::Mat3f> fineCarried = warpedBack(fineLater, maps[region]);
      sums.highPassError += warpingError(fine, fineCarried);
      sums.unrelated += energyOf(fine, fineCarried);
    }
  }
  if (forgetting != nullptr) compareForgetting(earlier, later, motion, *forgetting);
}

void ModelRegions::compareForgetting(const Recent& earlier, const Recent& later,
                                     const MotionMap& motion, const MotionMap& forgetting) {
  cv::Mat1b known;
  cv::bitwise_and(motion.valid, forgetting.valid, known);
  cv::bitwise_and(known, earlier.models, known);
  const cv::Mat1b where = differing(motion.displacement, forgetting.displacement, known);
  const cv::Mat3f& from = earlier.pictures[Subject::kInput];
  const cv::Mat3f& to = later.pictures[Subject::kInput];
  Warped<cv::Mat3f> followed = warpedBack(to, limitedTo(where, motion));
  Warped<cv::Mat3f> forgotten = warpedBack(to, limitedTo(where, forgetting));
  // A plain wheel looks the same wherever its points are said to have come from.
  cv::bitwise_and(followed.mask, forgotten.mask, followed.mask);
  for (int y = 0; y < from.rows; ++y) {
    for (int x = 0; x < from.cols; ++x) {
      const cv::Vec3f by = followed.picture(y, x) - forgotten.picture(y, x);
      if (cv::norm(by, cv::NORM_INF) <= kToldLevels / 255) followed.mask(y, x) = 0;
    }
  }
  forgotten.mask = followed.mask;
  followed_ += warpingError(from, followed);
  forgotten_ += warpingError(from, forgotten);
}

void ModelRegions::compareLongLag(const MotionMap& motion) {
  const Earlier& earlier = earlier_.front();
  const Earlier& later = earlier_.back();
  const PerRegion<cv::Mat1b> regions = regionsOf(earlier.models, earlier.changed, motion);
  for (const Region region : kAllRegions) {
    const MotionMap map = limitedTo(regions[region], motion);
    if (cv::countNonZero(map.valid) == 0) continue;
    for (const Subject subject : kAllSubjects) {
      sums_[region][subject].lasting +=
          lastingMarks(earlier.greys[subject], warpedBack(later.greys[subject], map));
    }
  }
}

PerRegion<PerSubject<RegionSummary>> ModelRegions::summary() const {
  PerRegion<PerSubject<RegionSummary>> summary;
  for (const Region region : kAllRegions) {
    for (const Subject subject : kAllSubjects) {
      const Sums& sums = sums_[region][subject];
      summary[region][subject] = {
          .coveredPercent = percentOf(covered_[region]).value_or(0),
          .ew2 = scaled(sums.error.value(), 1000.0),
          .nHw2 = ratio(sums.highPassError.value(), sums.unrelated.value()),
          .popPercent = percentOf(sums.popped),
          .s10Percent = sums.lasting.weight < kMinMarks ? std::nullopt : percentOf(sums.lasting)};
    }
  }
  return summary;
}

std::optional<double> ModelRegions::forgettingRatio() const {
  if (followed_.weight < kMinTold) return std::nullopt;
  return ratio(forgotten_.value(), followed_.value());
}

}  // namespace pleinair::measure

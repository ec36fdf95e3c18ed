#include "pipeline/tracking/cut_detector.h"

namespace pleinair::tracking {
namespace {

constexpr double kLostShare = 0.15;     // of features found: fewer are lost
constexpr double kSameScene = 0.8;      // correlation of thumbnails
constexpr double kLeastContrast = 4.0;  // grey levels of one
constexpr int kMostBlankFrames = 12;    // after which what was seen does not come back

}  // namespace

bool CutDetector::isCut(const LumaPyramid& now, double foundShare) {
  now_.load(now);
  if (!seen_) {
    seen_ = now_;
    blankFrames_ = 0;
    return true;
  }
  if (foundShare < kLostShare && now_.contrast() < kLeastContrast) {
    const bool isCut = ++blankFrames_ == kMostBlankFrames && seen_->contrast() >= kLeastContrast;
    if (isCut) seen_ = now_;
    return isCut;
  }
  blankFrames_ = 0;
  const bool isCut = foundShare < kLostShare && seen_->match(now_).correlation < kSameScene;
  seen_ = now_;
  return isCut;
}

}  // namespace pleinair::tracking

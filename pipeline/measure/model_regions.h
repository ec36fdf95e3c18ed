#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/negative_controls.h"

namespace pleinair::measure {

/// The regions of a picture with virtual models.
enum class Region : std::size_t {
  kReal,     ///< the camera's image, 8 px away from models and their shadows
  kVirtual,  ///< models
  kSeam,     ///< within 8 px on both sides of a model's outline
  /// the part of models that moves by 2 px or more between the compared frames, on the screen:
  /// there marks that are fixed to the screen are wrong
  kMoving,
};
inline constexpr std::size_t kRegions = 4;
inline constexpr std::array kAllRegions{Region::kReal, Region::kVirtual, Region::kSeam,
                                        Region::kMoving};

/// The coherence of a region (docs/measuring.md). A value is missing where nothing was compared.
struct RegionSummary {
  double coveredPercent = 0;  ///< of all pixels within the border
  std::optional<double> ew2, nHw2, popPercent, s10Percent;
};

template <class Value>
struct PerRegion {
  std::array<Value, kRegions> values;
  Value& operator[](Region region) { return values.at(static_cast<std::size_t>(region)); }
  const Value& operator[](Region region) const {
    return values.at(static_cast<std::size_t>(region));
  }
};

/// Motion to this frame from earlier ones; null where there is no such frame.
struct ModelMotionFromPast {
  const MotionMap* shortLag = nullptr;
  const MotionMap* longLag = nullptr;
  const MotionMap* forgetting = nullptr;  ///< at the short lag, without the models' motion
};

/// EW2, nHW2, POP (lag 2) and S10 (lag 10) in each region, of a painting and of the controls. The
/// region is that of the earlier frame. What is hidden and what is within 3 px of a motion boundary
/// is left out, as everywhere. The high pass of nHW2 is that of models and of the camera's image,
/// each without the other, so that it needs no wider margin; its error is taken over the energy of
/// both frames, which unrelated marks would read.
class ModelRegions {
 public:
  /// Takes the next frame: RGB in [0, 1], 255 where it shows a model, and where models and their
  /// shadows have changed it.
  void add(const PerSubject<cv::Mat3f>& pictures, const cv::Mat1b& models, const cv::Mat1b& changed,
           const ModelMotionFromPast& motion);

  PerRegion<PerSubject<RegionSummary>> summary() const;
  /// EW2 of the input along a motion that forgets the models over that along the true one, where
  /// both differ by 2 px or more and lead to different colours; nothing if this is hardly so.
  std::optional<double> forgettingRatio() const;

 private:
  struct Recent {
    PerSubject<cv::Mat3f> pictures;
    cv::Mat1b models, changed;
  };
  struct Earlier {
    PerSubject<cv::Mat1f> greys;
    cv::Mat1b models, changed;
  };
  struct Sums {
    Mean error, highPassError, unrelated, popped, lasting;
  };
  void compareShortLag(const MotionMap& motion, const MotionMap* forgetting);
  void compareForgetting(const Recent& earlier, const Recent& later, const MotionMap& motion,
                         const MotionMap& forgetting);
  void compareLongLag(const MotionMap& motion);

  std::deque<Recent> recent_;    ///< three at most, the newest last
  std::deque<Earlier> earlier_;  ///< eleven at most
  PerRegion<PerSubject<Sums>> sums_;
  PerRegion<Mean> covered_;
  Mean followed_, forgotten_;
};

}  // namespace pleinair::measure

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/calibration/lens_choice.h"
#include "pipeline/calibration/view_selection.h"

namespace pleinair::calibration {

/// Why a calibration is not to be trusted.
enum class RefusalReason {
  kNoBoard,         ///< not in any picture
  kBlurred,         ///< never sharp
  kMoving,          ///< never still
  kTooFewViews,     ///< that differ
  kCoverage,        ///< part of the picture was never reached
  kSameAngle,       ///< the focal length is not determined
  kDisagreement,    ///< many views contradict the others
  kLargeError,      ///< of the fit
  kHeldOutError,    ///< of views that had no part in the fit
  kImplausible,     ///< principal point, focal lengths
  kFoldedLens,      ///< the distortion has no inverse in the picture
  kUncertainPlaces  ///< the lens is not determined somewhere in the picture
};

struct Refusal {
  RefusalReason reason = RefusalReason::kNoBoard;
  std::string text;    ///< what, with numbers
  std::string remedy;  ///< what to do
};

/// What came out of the views.
struct CalibrationReport {
  std::optional<LensChoice> choice;  ///< what was fitted, if anything could be
  Coverage coverage;                 ///< of the views that were used
  double typicalSigmaPx = 0.0;       ///< over the places of the picture, their median
  double worstSigmaPx = 0.0;
  std::string worstPlace;         ///< "the lower left corner"
  std::vector<Refusal> refusals;  ///< none: it is good

  bool isGood() const { return choice && refusals.empty(); }
};

/// Fits a lens to the views and judges what comes out.
CalibrationReport solveCalibration(const ViewSelector& selector, hal::FrameSize size);

}  // namespace pleinair::calibration

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pipeline/calibration/lens_choice.h"
#include "pipeline/calibration/view_selection.h"

namespace pleinair::calibration {

/// Reason why a calibration is refused.
enum class RefusalReason {
  kNoBoard,         ///< no image shows the board
  kBlurred,         ///< the board was never sharp
  kMoving,          ///< the board was never at rest
  kTooFewViews,     ///< too few distinct views
  kCoverage,        ///< part of the image was never covered
  kSameAngle,       ///< the focal length is not determined
  kDisagreement,    ///< many views contradict the others
  kLargeError,      ///< error of the fit
  kHeldOutError,    ///< error of views that were not fitted
  kImplausible,     ///< principal point or focal lengths
  kFoldedLens,      ///< the distortion has no inverse in the image
  kUncertainPlaces  ///< the lens is not determined somewhere in the image
};

struct Refusal {
  RefusalReason reason = RefusalReason::kNoBoard;
  std::string text;    ///< the problem, with numbers
  std::string remedy;  ///< the remedy
};

/// The result of a calibration.
struct CalibrationReport {
  std::optional<LensChoice> choice;  ///< the fit, if one was possible
  Coverage coverage;                 ///< of the used views
  double typicalSigmaPx = 0.0;       ///< median over the places of the image
  double worstSigmaPx = 0.0;
  std::string worstPlace;         ///< "the lower left corner"
  std::vector<Refusal> refusals;  ///< none: the calibration is good

  bool isGood() const { return choice && refusals.empty(); }
};

/// Fits a lens to the views and judges the result.
CalibrationReport solveCalibration(const ViewSelector& selector, hal::FrameSize size);

}  // namespace pleinair::calibration

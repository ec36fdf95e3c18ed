#pragma once

#include <string>

#include "pipeline/calibration/verdict.h"

namespace pleinair::calibration {

/// A calibration in the format of tracking::loadCalibration() (TOML), with comments on its data and
/// its quality. The same calibration gives the same text. Precondition: the report has a choice.
std::string calibrationText(const Board& board, const CalibrationReport& report);

}  // namespace pleinair::calibration

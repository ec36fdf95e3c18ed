#pragma once

#include <string>

#include "pipeline/calibration/verdict.h"

namespace pleinair::calibration {

/// A calibration as tracking::loadCalibration() reads it (TOML), with comments that say what it was
/// made from and how good it is. The same calibration gives the same text. Precondition: a choice.
std::string calibrationText(const Board& board, const CalibrationReport& report);

}  // namespace pleinair::calibration

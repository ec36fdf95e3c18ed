#pragma once

#include <string>

#include "hal/image.h"
#include "pipeline/calibration/verdict.h"

namespace pleinair::calibration {

/// A calibration in the format of tracking::loadCalibration() (TOML), with comments on its data and
/// its quality. The same calibration gives the same text. Precondition: the report has a choice.
std::string calibrationText(const Board& board, const CalibrationReport& report);

/// Draws a view as RGB8 for people: its corners, their reprojection errors (50 times enlarged), the
/// cells of the image that it covers, and a line with the image's number. Without a choice, or if
/// the view was rejected, corners are red.
hal::Image viewPicture(const hal::ImageView& grey, const SelectedView& view, std::size_t index,
                       const Board& board, const CalibrationReport& report);

/// Draws the corners of all views and the number of views per cell, as RGB8.
hal::Image coveragePicture(const ViewSelector& selector, const CalibrationReport& report,
                           hal::FrameSize size);

}  // namespace pleinair::calibration

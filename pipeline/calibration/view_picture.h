#pragma once

#include "hal/image.h"
#include "pipeline/calibration/verdict.h"

namespace pleinair::calibration {

/// A view as RGB8, for the eye: its corners, how far each is from where the calibration has it
/// (50 times as long), the cells of the picture that it reaches, and a line that says which picture
/// it was. Without a choice, or where the view was rejected, corners are red.
hal::Image viewPicture(const hal::ImageView& grey, const SelectedView& view, std::size_t index,
                       const Board& board, const CalibrationReport& report);

/// Where corners were in all views, over the cells and the number of views in each, as RGB8.
hal::Image coveragePicture(const ViewSelector& selector, const CalibrationReport& report,
                           hal::FrameSize size);

}  // namespace pleinair::calibration

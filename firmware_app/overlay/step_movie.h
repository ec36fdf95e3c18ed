#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>

#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// The most memory that a movie's frames take, whatever the output's size.
inline constexpr std::size_t kMostMovieBytes = std::size_t{64} << 20U;

/// Decodes a step's movie for a place of that size: 12.5 frames a second, smaller than the place
/// where they would take more than kMostMovieBytes. It takes longer than all else of a step. Null
/// where the file cannot be played any more, or `stop` was requested. Any thread.
std::shared_ptr<const overlay::PanelMovie> readStepMovie(const std::filesystem::path& file,
                                                         hal::FrameSize place,
                                                         const std::stop_token& stop = {});

/// The first frame, so many rows high, with the sign of a movie: RGB8. Nothing where the file
/// cannot be played any more. Any thread.
std::optional<hal::Image> moviePoster(const std::filesystem::path& file, int rows);

/// RGB8, another size.
hal::Image scaledRgb(const hal::ImageView& rgb, hal::FrameSize size);

/// So many rows, and columns by the picture's shape.
hal::FrameSize sizeOfRows(hal::FrameSize picture, int rows);

}  // namespace pleinair::app

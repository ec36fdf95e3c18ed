#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// The most memory that a movie's frames take, whatever the output's size.
inline constexpr std::size_t kMostMovieBytes = std::size_t{64} << 20U;

/// Decodes a step's movie for a place of that size: 12.5 frames a second, smaller than the place
/// where they would take more than kMostMovieBytes. It takes longer than all else of a step. Null
/// where `stop` was requested. Errors: those of hal::forMovieFrames(). Any thread.
hal::Result<std::shared_ptr<const overlay::PanelMovie>> readStepMovie(
    const std::filesystem::path& file, hal::FrameSize place, const std::stop_token& stop = {});

/// A text on black of that size, as a movie that stands. Any thread.
std::shared_ptr<const overlay::PanelMovie> textMovie(const std::string& text, hal::FrameSize place);

/// The first frame, so many rows high, with the sign of a movie: RGB8. Nothing where the file
/// cannot be played any more. Any thread.
std::optional<hal::Image> moviePoster(const std::filesystem::path& file, int rows);

/// RGB8, another size.
hal::Image scaledRgb(const hal::ImageView& rgb, hal::FrameSize size);

/// So many rows, and columns by the picture's shape; fewer rows where that would be more columns
/// than `mostColumns`.
hal::FrameSize sizeOfRows(hal::FrameSize picture, int rows, int mostColumns = hal::kMaxSidePixels);

}  // namespace pleinair::app

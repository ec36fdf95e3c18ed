#pragma once

#include <filesystem>
#include <functional>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::hal {

/// Takes a frame of a movie: RGB8, upright, with square pixels, valid during the call, and its time
/// since the first frame that was taken. Returns false to end.
using TakeMovieFrame = std::function<bool(const ImageView& rgb, Duration time)>;

/// Decodes a movie file, without its sound, and calls `take` with each valid frame at or after
/// `from` of the movie's time. A movie that is truncated ends there, and one whose frames are
/// broken after 250 of them in a row. `isUnwanted` is asked before each packet, also of broken
/// ones: true ends it. One thread. Errors: kNotFound, kPermissionDenied, kIo, kUnsupported (coding
/// or size), kInvalidInput (no movie, or no valid frame from there on).
Result<void> forMovieFrames(const std::filesystem::path& movie, Duration from,
                            const TakeMovieFrame& take,
                            const std::function<bool()>& isUnwanted = nullptr);

}  // namespace pleinair::hal

#pragma once

#include <string>

#include "hal/media/handles.h"
#include "hal/outputs/movie/movie_writer.h"

namespace pleinair::hal::movie {

/// The encoder of a movie's images, open, for I420 of the format's size made even, with times in
/// microseconds. `subject` names the movie in errors: kUnsupported (libav lacks it), kInternal.
Result<libav::CodecContext> openVideoEncoder(const MovieFormat& format, const std::string& subject);

}  // namespace pleinair::hal::movie

#pragma once

#include "hal/media/file_input.h"

namespace pleinair::hal::recording {

/// Whether a Matroska file is truncated: it ends before the end that its Segment declares (RFC 8794
/// §4, RFC 9559 §5.1). False if the size is unknown, as in a live stream.
bool segmentBreaksOff(const libav::FileInput& file);

}  // namespace pleinair::hal::recording

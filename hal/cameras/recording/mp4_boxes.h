#pragma once

#include <cstdint>

#include "hal/media/file_input.h"

namespace pleinair::hal::recording {

/// What the boxes of an MP4 say that libav does not: whether the file was cut off, and how many
/// frames its fragments announce (ISO/IEC 14496-12 §4.2, §8.8).
struct Mp4Boxes {
  bool aborted = false;  ///< its last box ends after the file does
  std::uint64_t fragmentSamples = 0;
};

/// Reads box headers only; gives up, claiming nothing, on files of more than a million boxes.
Mp4Boxes scanMp4(const libav::FileInput& file, std::uint32_t trackId);

}  // namespace pleinair::hal::recording

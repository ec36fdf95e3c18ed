#pragma once

#include <cstdint>

#include "hal/media/file_input.h"

namespace pleinair::hal::recording {

/// Facts about an MP4 file that libav does not report: whether the file is truncated, and how many
/// frames its fragments announce (ISO/IEC 14496-12 §4.2, §8.8).
struct Mp4Boxes {
  bool aborted = false;  ///< its last box would end beyond the end of the file
  std::uint64_t fragmentSamples = 0;
};

/// Scans an MP4 file's box headers. Gives the default result for files of more than a million
/// boxes.
Mp4Boxes scanMp4(const libav::FileInput& file, std::uint32_t trackId);

}  // namespace pleinair::hal::recording

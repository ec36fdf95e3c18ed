#pragma once

#include <cstdint>

#include "hal/media/file_input.h"

namespace pleinair::hal::libav {

// Facts about a movie's container that libav does not report, read from the headers of its parts.

struct Mp4Boxes {
  bool aborted = false;               ///< the file's last box would end beyond the end of the file
  std::uint64_t fragmentSamples = 0;  ///< frames that the fragments announce
};

/// Scans an MP4 file's box headers (ISO/IEC 14496-12 §4.2, §8.8). Gives the default result for
/// files of more than a million boxes.
Mp4Boxes scanMp4(const FileInput& file, std::uint32_t trackId);

/// An MP4 file's size; less where its end cuts off a fragment's head (moof) or a box's first 8
/// bytes: then where that box begins.
std::int64_t readableMp4Bytes(const FileInput& file);

/// Whether a Matroska file is truncated: it ends before the end that its Segment declares (RFC 8794
/// §4, RFC 9559 §5.1). False if the size is unknown, as in a live stream.
bool segmentBreaksOff(const FileInput& file);

}  // namespace pleinair::hal::libav

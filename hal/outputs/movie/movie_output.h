#pragma once

#include <filesystem>
#include <memory>

#include "hal/output.h"
#include "hal/output_kind.h"
#include "hal/pending_file.h"

namespace pleinair::hal {

/// A movie file; its ending chooses the kind:
/// - .mp4: H.264 in fragmented MP4, readable up to where it broke off; times to 1 µs, with at most
///   35 minutes between two pictures
/// - .mkv: H.264 in Matroska; times to 1 µs
/// - .y4m: uncompressed; holds one frame rate only, so the times given to write() are dropped
///   and the nominal period (1/30 s where there is none) counts
///
/// start() answers I420, limited range, BT.709 from 720 lines up, else BT.601 (tagged in MP4 and
/// MKV), of the requested size. H.264 holds even sizes only: an odd last column or row is
/// repeated once in the file. The same pictures give the same bytes on every machine with the same
/// x264. Errors of start() also: kInvalidArgument (unknown ending), kUnsupported (no x264).
std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path,
                                              FileSystem& files = systemFiles());

/// Whether the ending is one of the above (".MP4" as well).
bool isMovieName(const std::filesystem::path& path);

/// A path with such an ending, where no folder has it.
OutputKind movieKind();

}  // namespace pleinair::hal

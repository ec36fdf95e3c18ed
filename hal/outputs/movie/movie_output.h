#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

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

/// x264's constant rate factor: 0 … 51, less is better and larger. 18 shows no loss to the eye.
inline constexpr double kDefaultCrf = 18;

struct MovieOptions {
  double crf = kDefaultCrf;  ///< of .mp4 and .mkv
  /// A recording whose sound is kept, as it is coded: its time 0 is the first frame at or after
  /// `soundFrom`. Nothing where it has none.
  std::optional<std::filesystem::path> soundOf = std::nullopt;
  Duration soundFrom{0};
  /// Called in start() with a line where the recording has sound that the file cannot hold.
  std::function<void(const std::string&)> onNotice = nullptr;
};

/// The same with options. Errors of start() also: those of reading the recording of the sound.
std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path, MovieOptions options,
                                              FileSystem& files = systemFiles());

/// Y4M on standard output, frame by frame, for a program that reads it from a pipe: as .y4m above.
/// Errors of write() also: kIo (the reader is gone). Nothing else may write to standard output.
std::unique_ptr<MemoryOutput> openMovieStream();

/// Whether the ending is one of the above (".MP4" as well).
bool isMovieName(const std::filesystem::path& path);

/// A path with such an ending, where no folder has it.
OutputKind movieKind();

}  // namespace pleinair::hal

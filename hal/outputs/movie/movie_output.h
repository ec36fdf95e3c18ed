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
/// - .mp4: H.264 (or another codec of the options) in fragmented MP4, readable up to where it broke
/// off; times to 1 µs, with at most
///   35 minutes between two pictures
/// - .mkv: the same in Matroska; times to 1 µs
/// - .y4m: uncompressed; holds one frame rate only, so the times given to write() are dropped
///   and the nominal period (1/30 s where there is none) counts
///
/// start() answers I420, limited range, BT.709 from 720 lines up, else BT.601 (tagged in MP4 and
/// MKV), of the requested size. The codecs hold even sizes only: an odd last column or row is
/// repeated once in the file. The same pictures give the same bytes on every machine with the same
/// x264. Errors of start() also: kInvalidArgument (unknown ending), kUnsupported (libav lacks the
/// encoder; the container cannot hold the codec).
std::unique_ptr<MemoryOutput> openMovieOutput(std::filesystem::path path,
                                              FileSystem& files = systemFiles());

/// How .mp4 and .mkv code images: H.264 is played everywhere; HEVC and AV1 are smaller and slower;
/// FFV1 (.mkv only) loses nothing of Y'CbCr 4:2:0.
enum class VideoCodec { kH264, kHevc, kAv1, kFfv1 };

struct MovieOptions {
  VideoCodec codec = VideoCodec::kH264;
  /// The encoder's constant rate factor: 0 … 51 (AV1: 63), less is better and larger. Unset: 18 for
  /// H.264, 22 for HEVC, 26 for AV1, which show no loss to the eye. FFV1 has none.
  std::optional<double> crf = std::nullopt;
  /// A recording whose sound is kept, as it is coded where the container can hold that, else as
  /// AAC: its time 0 is the first frame at or after
  /// `soundFrom`. Nothing where it has none.
  std::optional<std::filesystem::path> soundOf = std::nullopt;
  Duration soundFrom{0};
  /// Called in start() with a line where the recording has sound that is coded anew or left out.
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

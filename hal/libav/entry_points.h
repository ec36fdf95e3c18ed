#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "hal/cameras/recording/movie_frames.h"
#include "hal/cameras/recording/recording.h"
#include "hal/captures/capture_writer.h"
#include "hal/media/motion_jpeg.h"
#include "hal/media/picture_file.h"
#include "hal/outputs/movie/movie_output.h"

namespace pleinair::hal::libav {

/// The version that this was built as. A program and a module of two versions would call each
/// other wrongly.
inline constexpr std::string_view kBuild = PLEINAIR_BUILD;

/// The functions of the HAL that need libav.
struct EntryPoints {
  std::string_view build;  ///< kBuild of the module
  decltype(&hal::readPicture) readPicture;
  decltype(&hal::readPictureRgb) readPictureRgb;
  decltype(&hal::readPictureRgba) readPictureRgba;
  decltype(&hal::decodeRgba) decodeRgba;
  decltype(&hal::readRgb16) readRgb16;
  decltype(&libav::decodeMotionJpeg) decodeMotionJpeg;
  decltype(&hal::openRecording) openRecording;
  decltype(&hal::forMovieFrames) forMovieFrames;
  std::unique_ptr<MemoryOutput> (*openMovieOutput)(std::filesystem::path, MovieOptions,
                                                   FileSystem&);
  decltype(&hal::openMovieStream) openMovieStream;
  decltype(&captures::CaptureWriter::open) openCapture;
};

/// The module's file, beside the program or where it is installed, and its only symbol, which is a
/// function `const EntryPoints* ()`.
inline constexpr const char* kModuleFile = "pleinair-libav.so";
inline constexpr const char* kModuleSymbol = "pleinairLibavEntryPoints";

}  // namespace pleinair::hal::libav

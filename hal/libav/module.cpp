#include "hal/libav/entry_points.h"

// The module that loader.cpp loads.
extern "C" __attribute__((visibility("default"))) const pleinair::hal::libav::EntryPoints*
pleinairLibavEntryPoints();

const pleinair::hal::libav::EntryPoints* pleinairLibavEntryPoints() {
  using namespace pleinair::hal;
  static constexpr libav::EntryPoints kEntryPoints{.build = libav::kBuild,
                                                   .readPicture = readPicture,
                                                   .readPictureRgb = readPictureRgb,
                                                   .readPictureRgba = readPictureRgba,
                                                   .decodeRgba = decodeRgba,
                                                   .readRgb16 = readRgb16,
                                                   .decodeMotionJpeg = libav::decodeMotionJpeg,
                                                   .openRecording = openRecording,
                                                   .forMovieFrames = forMovieFrames,
                                                   .openMovieOutput = openMovieOutput,
                                                   .openMovieStream = openMovieStream,
                                                   .openCapture = captures::CaptureWriter::open};
  return &kEntryPoints;
}

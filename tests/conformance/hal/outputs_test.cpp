#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/headless/headless_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "tests/conformance/output_conformance.h"

namespace pleinair::hal::conformance {
namespace {

OutputCase movie(const std::string& name, const std::string& file) {
  return {.name = name,
          .make = [file](const auto& folder) { return openMovieOutput(folder / file); },
          .backend = "movie",
          .file = file};
}

OutputCase frames(const std::string& name, const std::string& file, const std::string& published,
                  int maxPictures = 1000) {
  return {.name = name,
          .make = [file](const auto& folder) { return openFramesOutput(folder / file); },
          .backend = "frames",
          .file = published,
          .maxPictures = maxPictures};
}

OutputCase headless(const std::string& name, PixelFormat format) {
  return {.name = name,
          .make = [format](const auto&) { return std::make_unique<HeadlessOutput>(format); },
          .backend = "headless",
          .file = ""};
}

INSTANTIATE_TEST_SUITE_P(Outputs, OutputConformance,
                         testing::Values(movie("Mp4", "movie.mp4"), movie("Mkv", "movie.mkv"),
                                         movie("Y4m", "movie.y4m"),
                                         frames("SinglePicture", "one.png", "one.png", 1),
                                         frames("Folder", "pictures", ""),
                                         frames("Pattern", "%03d.png", ""),
                                         headless("HeadlessRgb", PixelFormat::kRgb8),
                                         headless("HeadlessI420", PixelFormat::kI420)),
                         outputCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance

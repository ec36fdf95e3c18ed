#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/headless/headless_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/outputs/v4l2_loopback/loopback_output.h"
#include "tests/conformance/output_conformance.h"
#include "tests/support/fake_loopback.h"

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

/// On a fake device that every output of a test opens.
OutputCase loopback(const std::string& name, PixelFormat layout) {
  const auto fake = std::make_shared<support::FakeLoopback>();
  fake->node("/dev/video50");
  return {.name = name,
          .make =
              [fake, layout](const auto&) {
                return *openLoopback("loopback:/dev/video50", layout, {.calls = fake.get()});
              },
          .backend = "loopback",
          .file = "",
          .hasEvenSides = true};
}

INSTANTIATE_TEST_SUITE_P(Outputs, OutputConformance,
                         testing::Values(movie("Mp4", "movie.mp4"), movie("Mkv", "movie.mkv"),
                                         movie("Y4m", "movie.y4m"),
                                         frames("SinglePicture", "one.png", "one.png", 1),
                                         frames("Folder", "pictures", ""),
                                         frames("Pattern", "%03d.png", ""),
                                         headless("HeadlessRgb", PixelFormat::kRgb8),
                                         headless("HeadlessI420", PixelFormat::kI420),
                                         loopback("LoopbackYuyv", PixelFormat::kYuyv),
                                         loopback("LoopbackNv12", PixelFormat::kNv12),
                                         loopback("LoopbackI420", PixelFormat::kI420)),
                         outputCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance

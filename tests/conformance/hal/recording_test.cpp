#include "hal/cameras/recording/recording.h"

#include "tests/conformance/camera_conformance.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal::conformance {
namespace {

/// A recording written on first use; its folder lives as long as the case does.
CameraCase recording(const std::string& name, const std::string& file, int frames, Pacing pacing,
                     FrameSize size = {64, 48}) {
  struct Written {
    support::TemporaryFolder folder;
    bool done = false;
  };
  return {.name = name,
          .make =
              [=, written = std::shared_ptr<Written>()](Clock& clock) mutable {
                if (!written) written = std::make_shared<Written>();
                const auto path = written->folder.path() / file;
                if (!std::exchange(written->done, true)) support::writeMedia(path, frames, size);
                return openRecording(path, clock, {.pacing = pacing});
              },
          .backend = "recording",
          .frames = static_cast<std::uint64_t>(frames)};
}

INSTANTIATE_TEST_SUITE_P(
    Recording, CameraConformance,
    testing::Values(recording("Mp4", "a.mp4", 7, Pacing::kStepped),
                    recording("Mp4RealTime", "a.mp4", 7, Pacing::kRealTime),
                    recording("MkvRealTime", "a.mkv", 7, Pacing::kRealTime),
                    recording("Y4m", "a.y4m", 7, Pacing::kStepped),
                    recording("Y4mOdd", "a.y4m", 3, Pacing::kRealTime, {33, 17}),
                    recording("Folder", "pictures", 4, Pacing::kStepped),
                    recording("FolderRealTime", "pictures", 4, Pacing::kRealTime),
                    recording("Pattern", "%03d.png", 4, Pacing::kStepped),
                    recording("SinglePicture", "one.png", 1, Pacing::kStepped),
                    recording("OnePixel", "one.png", 1, Pacing::kRealTime, {1, 1})),
    cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance

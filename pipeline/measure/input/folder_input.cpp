#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "hal/media/picture_file.h"
#include "hal/media/picture_paths.h"
#include "pipeline/measure/input/kitti_flow.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/input/motion_file.h"

namespace pleinair::measure {
namespace {

namespace fs = std::filesystem;

struct FolderContents {
  std::vector<fs::path> frames, flows, occlusions;
};

hal::Error wrong(const fs::path& subject, std::string problem, std::string remedy) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = subject.string(),
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

hal::Result<FolderContents> contentsOf(const fs::path& folder) {
  auto pictures = hal::picturesIn(folder);
  if (!pictures) return tl::unexpected(pictures.error());
  FolderContents contents;
  for (fs::path& path : *pictures) {
    const std::string name = path.filename().string();
    const bool isFlow = name.starts_with("flow");
    const bool isMask = name.starts_with("occ");
    (isFlow   ? contents.flows
     : isMask ? contents.occlusions
              : contents.frames)
        .push_back(std::move(path));
  }
  if (contents.frames.empty()) {
    return tl::unexpected(wrong(folder, "holds flow and masks, and no frames",
                                "give the folder that holds the frames too"));
  }
  return contents;
}

/// Checks for one flow file from each frame to the next, and as many masks or none.
hal::Result<void> checkCounts(const fs::path& folder, const FolderContents& contents) {
  const std::size_t steps = contents.frames.size() - 1;
  const bool fits = contents.flows.size() == steps &&
                    (contents.occlusions.empty() || contents.occlusions.size() == steps);
  if (fits) return {};
  return tl::unexpected(
      wrong(folder,
            fmt::format("holds {} frames, {} flow files and {} masks", contents.frames.size(),
                        contents.flows.size(), contents.occlusions.size()),
            "give one flow file from each frame to the next, and a mask (occ…) for each or none"));
}

class FolderInput final : public MeasuredInput {
 public:
  FolderInput(const fs::path& folder, std::vector<fs::path> frames, hal::FrameSize size)
      : folder_(folder), frames_(std::move(frames)), size_(size) {}

  void setMotion(std::unique_ptr<TrueMotion> motion) { motion_ = std::move(motion); }
  void addNotice(std::string notice) { notices_.push_back(std::move(notice)); }

  std::string description() const override { return folder_.string(); }
  hal::FrameFormat format() const override {
    return {.pixelFormat = hal::PixelFormat::kRgb8, .size = size_, .encoding = {}};
  }
  std::optional<std::uint64_t> frameCount() const override { return frames_.size(); }
  TrueMotion* motion() override { return motion_.get(); }
  std::vector<std::string> notices() const override { return notices_; }

  hal::Result<std::optional<hal::CapturedFrame>> next() override {
    if (next_ == frames_.size()) return std::nullopt;
    const fs::path& path = frames_[next_];
    hal::Result<hal::Image> picture = hal::readPictureRgb(path);
    if (!picture) return tl::unexpected(picture.error());
    if (picture->size() != size_) {
      return tl::unexpected(
          wrong(path,
                fmt::format("has {}x{} px, the first frame {}x{}", picture->size().width,
                            picture->size().height, size_.width, size_.height),
                "give frames of one size"));
    }
    const auto image = std::make_shared<const hal::Image>(std::move(*picture));
    const hal::TimePoint time{kFramePeriod * static_cast<std::int64_t>(next_)};
    return hal::CapturedFrame{.image = image->view(),
                              .sequence = next_++,
                              .captureTime = time,
                              .timestampSource = hal::TimestampSource::kRecording,
                              .lease = image};
  }

 private:
  fs::path folder_;
  std::vector<fs::path> frames_;
  hal::FrameSize size_;
  std::unique_ptr<TrueMotion> motion_;
  std::vector<std::string> notices_;
  std::size_t next_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<MeasuredInput>> openPictureFolder(const fs::path& folder) {
  hal::Result<FolderContents> contents = contentsOf(folder);
  if (!contents) return tl::unexpected(contents.error());
  const hal::Result<hal::Image> first = hal::readPictureRgb(contents->frames.front());
  if (!first) return tl::unexpected(first.error());
  const cv::Size size(first->size().width, first->size().height);
  const std::uint64_t count = contents->frames.size();
  auto input = std::make_unique<FolderInput>(folder, contents->frames, first->size());

  const fs::path motionPath = folder / "motion.json";
  std::error_code ignored;
  if (fs::exists(motionPath, ignored)) {
    const hal::Result<MotionFile> file = readMotion(motionPath);
    if (!file) return tl::unexpected(file.error());
    auto motion = motionOf(*file, size, count, motionPath.string());
    if (!motion) return tl::unexpected(motion.error());
    input->setMotion(std::move(*motion));
  } else if (!contents->flows.empty()) {
    if (auto counts = checkCounts(folder, *contents); !counts) {
      return tl::unexpected(counts.error());
    }
    input->setMotion(flowSequence(size, contents->flows, contents->occlusions));
  }
  return input;
}

}  // namespace pleinair::measure

#include "firmware_app/thesis/stage_times.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"
#include "pipeline/engine/painter.h"

namespace pleinair::app {
namespace {

/// Whether a pass is one of those, by the begin of its name.
bool beginsWithOneOf(std::string_view pass, std::initializer_list<std::string_view> names) {
  return std::ranges::any_of(names, [&](std::string_view name) { return pass.starts_with(name); });
}

ThesisStage stageOf(const std::string& pass) {
  if (beginsWithOneOf(pass, {"tensors: gradient", "tensors: edge_", "tensors: tensor_"})) {
    return ThesisStage::kTensorField;
  }
  if (pass == "follow picture") return ThesisStage::kFeatures;
  if (beginsWithOneOf(pass, {"marks: feature_layers", "marks: motion_field", "anchors: anchor_"})) {
    return ThesisStage::kWarping;
  }
  return ThesisStage::kPainting;
}

std::vector<hal::CapturedFrame> workbench(hal::FrameSize size, int count) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = size, .frameCount = static_cast<std::uint64_t>(count)},
                              clock);
  hal::orThrow(camera.start({}));
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < count; ++i) {
    hal::NextFrame next = camera.next(hal::kNoDeadline);
    frames.push_back(std::get<hal::CapturedFrame>(std::move(next)));
  }
  return frames;
}

/// Paints the workbench's frames forwards and backwards, repeatedly.
class Easel {
 public:
  Easel(hal::FrameSize size, int frames, gpu::PassTiming timing)
      : frames_(workbench(size, frames)),
        painter_({.pictureSize = size,
                  .scene = {},
                  .style = "painterly",
                  .tracksTags = false,
                  .passTiming = timing}),
        parameters_(painter_.defaultParameters()) {
    round();
  }

  /// ms per frame.
  double round() {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const std::size_t at = isBack_ ? frames_.size() - 1 - i : i;
      hal::CapturedFrame frame = frames_[at];
      frame.sequence = number_;
      frame.captureTime =
          hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number_++));
      hal::orThrow(painter_.paint(frame, parameters_));
    }
    hal::orThrow(painter_.snapshot());  // waits for the GPU
    isBack_ = !isBack_;
    const auto end = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(end - start).count() /
           static_cast<double>(frames_.size());
  }

  /// Totals since the start.
  std::array<double, kThesisStages> stages() const {
    std::array<double, kThesisStages> sums{};
    for (const gpu::PassTime& each : painter_.passTimes()) {
      sums.at(static_cast<std::size_t>(stageOf(each.pass))) +=
          std::chrono::duration<double, std::milli>(each.total).count();
    }
    return sums;
  }

 private:
  std::vector<hal::CapturedFrame> frames_;
  Painter painter_;
  PaintParameters parameters_;
  std::uint64_t number_ = 0;
  bool isBack_ = false;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

StageTimes measureStages(hal::FrameSize size, int frames, int rounds) {
  StageTimes times;
  {
    std::array<std::vector<double>, kThesisStages> stages;
    Easel easel(size, frames, gpu::PassTiming::kFences);
    for (int i = 0; i < rounds; ++i) {
      const std::array<double, kThesisStages> before = easel.stages();
      easel.round();
      const std::array<double, kThesisStages> after = easel.stages();
      for (std::size_t k = 0; k < kThesisStages; ++k) {
        stages.at(k).push_back((after.at(k) - before.at(k)) / frames);
      }
    }
    for (std::size_t k = 0; k < kThesisStages; ++k) times.stages.at(k) = median(stages.at(k));
  }
  Easel easel(size, frames, gpu::PassTiming::kOff);
  std::vector<double> whole;
  whole.reserve(static_cast<std::size_t>(rounds));
  for (int i = 0; i < rounds; ++i) whole.push_back(easel.round());
  times.whole = median(whole);
  return times;
}

}  // namespace pleinair::app

#pragma once

#include <optional>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "hal/cameras/aravis/aravis_camera.h"
#include "tests/support/fake_aravis.h"

namespace pleinair::hal::aravis {

/// A camera on a fake device. Change `fake` and `options` before start().
class FakeGigeTest : public testing::Test {
 protected:
  Result<StreamFormat> start(const StreamRequest& request = {.size = FrameSize{64, 48}}) {
    camera_.reset();
    library_.unplugAll();
    library_.plug(fake);
    camera_ = std::make_unique<AravisCamera>(fake.id, options, library_, clock_);
    return camera_->start(request);
  }
  /// The error of start() as a line, or "started".
  std::string failure(const StreamRequest& request = {.size = FrameSize{64, 48}}) {
    const Result<StreamFormat> format = start(request);
    return format ? "started" : format.error().message();
  }
  /// The next frame; fails where there is none.
  CapturedFrame frame() {
    NextFrame next = camera_->next(clock_.now() + std::chrono::seconds(1));
    if (auto* frame = std::get_if<CapturedFrame>(&next)) return std::move(*frame);
    ADD_FAILURE() << "variant " << next.index();
    return {};
  }

  SteppedClock clock_{TimePoint(std::chrono::seconds(100))};
  support::FakeAravis library_{clock_};
  support::FakeGigeCamera fake;
  AravisOptions options;
  std::unique_ptr<AravisCamera> camera_;
};

}  // namespace pleinair::hal::aravis

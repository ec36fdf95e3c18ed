#pragma once

#include <memory>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "hal/cameras/libcamera/libcamera_camera.h"
#include "tests/support/fake_libcamera.h"

namespace pleinair::hal::libcamera {

/// A camera on a fake sensor. Change `sensor` and `options` before start().
class FakeSensorTest : public testing::Test {
 protected:
  Result<StreamFormat> start(const StreamRequest& request = {.size = FrameSize{64, 48}}) {
    camera_.reset();
    library_.unplugAll();
    library_.plug(sensor);
    camera_ = std::make_unique<LibcameraCamera>(sensor.id, options, library_, clock_);
    return camera_->start(request);
  }
  /// The error of start() as a line, or "started".
  std::string failure(const StreamRequest& request = {.size = FrameSize{64, 48}}) {
    const Result<StreamFormat> format = start(request);
    return format ? "started" : format.error().message();
  }
  NextFrame next() { return camera_->next(clock_.now() + std::chrono::seconds(1)); }
  /// The next frame; fails where there is none.
  CapturedFrame frame() {
    NextFrame answer = next();
    if (auto* frame = std::get_if<CapturedFrame>(&answer)) return std::move(*frame);
    ADD_FAILURE() << "variant " << answer.index();
    return {};
  }

  SteppedClock clock_{TimePoint(std::chrono::seconds(100))};
  support::FakeLibcamera library_{clock_};
  support::FakeSensor sensor;
  LibcameraOptions options;
  std::unique_ptr<LibcameraCamera> camera_;
};

}  // namespace pleinair::hal::libcamera

#pragma once

#include <cerrno>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include "hal/cameras/v4l2/v4l2_camera.h"
#include "tests/support/fake_v4l2.h"
#include "tests/support/test_pictures.h"

namespace pleinair::hal::v4l2 {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using std::chrono_literals::operator""s;

/// A camera on a fake device at /dev/video0, which is plugged in on first use.
class FakeCamera : public testing::Test {
 protected:
  static constexpr const char* kNode = "/dev/video0";

  support::FakeVideo& plug(support::FakeVideo video = {}) {
    video.node = kNode;
    return kernel_.plug(std::move(video));
  }
  Camera& camera() {
    if (!camera_) camera_ = std::make_unique<V4l2Camera>(kNode, system(), clock_, options);
    return *camera_;
  }
  System system() { return {.calls = kernel_, .nodes = nodes_}; }

  StreamFormat startOrFail(const StreamRequest& request = {}) {
    const Result<StreamFormat> format = camera().start(request);
    EXPECT_TRUE(format) << (format ? "" : format.error().message());
    return format.value_or(StreamFormat{});
  }
  Error startError(const StreamRequest& request = {}) {
    const Result<StreamFormat> format = camera().start(request);
    EXPECT_FALSE(format);
    return format ? Error{} : format.error();
  }
  CapturedFrame frameOrFail() {
    NextFrame next = camera().next(clock_.now() + 10s);
    if (auto* frame = std::get_if<CapturedFrame>(&next)) return std::move(*frame);
    ADD_FAILURE() << "variant " << next.index();
    return {};
  }
  template <class T>
  T answerOrFail() {
    NextFrame next = camera().next(clock_.now() + 10s);
    if (auto* answer = std::get_if<T>(&next)) return std::move(*answer);
    ADD_FAILURE() << "variant " << next.index();
    return {};
  }
  void destroyCamera() { camera_.reset(); }

  static void expectPicture(const CapturedFrame& frame, int number) {
    const Image expected = support::testPicture(frame.image.format, number);
    ASSERT_TRUE(frame.image.isComplete());
    for (int plane = 0; plane < planeCount(frame.image.format.pixelFormat); ++plane) {
      const int rows =
          planeRows(frame.image.format.pixelFormat, plane, frame.image.format.size.height);
      for (int y = 0; y < rows; ++y) {
        ASSERT_THAT(frame.image.map().view().row(plane, y),
                    testing::ElementsAreArray(expected.view().row(plane, y)))
            << "plane " << plane << " row " << y << " of frame " << number;
      }
    }
  }
  void expectNothingLeft() const {
    EXPECT_EQ(kernel_.descriptors(), 0);
    EXPECT_EQ(kernel_.dmaBufs(), 0);
    EXPECT_EQ(kernel_.mappings(), 0);
    EXPECT_EQ(kernel_.buffers(), 0);
  }

  V4l2Options options;  ///< before first use of camera()
  SteppedClock clock_{TimePoint(100s)};
  support::FakeV4l2 kernel_{clock_};
  support::FakeNodes nodes_;

 private:
  std::unique_ptr<Camera> camera_;
};

}  // namespace pleinair::hal::v4l2

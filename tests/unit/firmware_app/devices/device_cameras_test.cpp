#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/devices/inventory.h"

namespace pleinair::app {
namespace {

class FixedBackend final : public hal::CameraBackend {
 public:
  explicit FixedBackend(hal::Result<std::vector<hal::CameraDescription>> answer)
      : answer_(std::move(answer)) {}
  std::string_view name() const override { return "fixed"; }
  hal::Result<std::vector<hal::CameraDescription>> list() override { return answer_; }
  std::unique_ptr<hal::Camera> make(const std::string&, hal::Clock&) override { return nullptr; }
  hal::Result<hal::OfferedModes> offeredModes(const std::string& id,
                                              const hal::StreamRequest& request) override {
    if (id == "b") return hal::CameraBackend::offeredModes(id, request);
    return hal::OfferedModes{
        .modes = {{.layout = "YUYV", .size = *request.size, .periods = {}}},
        .chosen = {.mode = {.layout = "YUYV", .size = *request.size, .periods = {}},
                   .reason = "no other"}};
  }

 private:
  hal::Result<std::vector<hal::CameraDescription>> answer_;
};

hal::CameraDescription camera(const std::string& id) {
  return {.identity = {.backend = "fixed", .id = id}};
}

TEST(DeviceCameras, AreThoseOfAllBackEndsThoughOneFails) {
  const hal::Error broken{.kind = hal::ErrorKind::kIo, .subject = "second", .problem = "is broken"};
  const std::vector<hal::SelectableBackend> backends{
      {std::make_shared<FixedBackend>(std::vector{camera("a"), camera("b")})},
      {std::make_shared<FixedBackend>(tl::unexpected(broken))},
      {std::make_shared<FixedBackend>(std::vector{camera("c")})}};
  const DeviceCameras all = listDeviceCameras(backends);
  std::vector<std::string> ids;
  for (const hal::CameraDescription& each : all.cameras) ids.push_back(each.identity.id);
  EXPECT_THAT(ids, testing::ElementsAre("a", "b", "c"));
  ASSERT_EQ(all.problems.size(), 1u);
  EXPECT_EQ(all.problems[0].subject, "second");
}

TEST(DeviceCameras, TellTheModeThatTheyWouldTake) {
  const std::vector<hal::SelectableBackend> backends{
      {std::make_shared<FixedBackend>(std::vector{camera("a"), camera("b")})}};
  DeviceCameras all = listDeviceCameras(backends);
  all.cameras[0].areModesKnown = false;
  askModes(all, backends, {.size = hal::FrameSize{64, 48}});
  ASSERT_TRUE(all.cameras[0].chosen);
  EXPECT_EQ(all.cameras[0].chosen->mode.size, (hal::FrameSize{64, 48}));
  EXPECT_EQ(all.cameras[0].modes.size(), 1u);
  EXPECT_TRUE(all.cameras[0].areModesKnown);
  EXPECT_FALSE(all.cameras[1].chosen);
  ASSERT_TRUE(all.cameras[1].problem);
  EXPECT_EQ(all.cameras[1].problem->message(), "b: does not tell its modes before it streams");
}

}  // namespace
}  // namespace pleinair::app

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

}  // namespace
}  // namespace pleinair::app

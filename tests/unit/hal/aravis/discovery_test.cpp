#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cameras/aravis/aravis_kind.h"
#include "hal/supervisor/camera_selector.h"
#include "tests/support/fake_aravis.h"

namespace pleinair::hal::aravis {
namespace {

using testing::ElementsAre;

class AravisDiscoveryTest : public testing::Test {
 protected:
  std::vector<std::string> ids(AravisDiscovery discovery = {}) {
    std::vector<std::string> all;
    const auto cameras = AravisBackend({}, discovery, library_).list();
    for (const CameraDescription& each : *cameras) all.push_back(each.identity.id);
    return all;
  }
  SteppedClock clock_;
  support::FakeAravis library_{clock_};
};

TEST_F(AravisDiscoveryTest, ListsEachCameraUnderALastingName) {
  library_.plug({.id = "Fake-Cam-2", .physicalId = "b"});
  library_.plug({.id = "Fake-Cam-1", .physicalId = "a", .transport = Transport::kUsb3});
  EXPECT_THAT(ids(), ElementsAre("Fake-Cam-1", "Fake-Cam-2"));
  EXPECT_THAT(ids({.gige = false}), ElementsAre("Fake-Cam-1"));
  EXPECT_THAT(ids({.usb3 = false}), ElementsAre("Fake-Cam-2"));
  const auto cameras = AravisBackend({}, {}, library_).list();
  EXPECT_EQ(cameras->at(1).serial, "2");
  EXPECT_EQ(cameras->at(1).node, "10.0.0.2");
  EXPECT_EQ(cameras->at(1).identity.description, "Fake Cam");
  EXPECT_FALSE(cameras->at(1).areModesKnown);
}

TEST_F(AravisDiscoveryTest, TellsModesAndTheOneThatIsTaken) {
  // Mono8, BayerRG8, BayerRG12p, and one that is not read.
  library_.plug({.id = "Fake-Cam-1", .formats = {0x01080001, 0x01080009, 0x010C0059, 0x02100032}});
  AravisBackend backend({}, {}, library_);
  const auto modes = backend.offeredModes("Fake-Cam-1", {.size = FrameSize{66, 49}});
  ASSERT_TRUE(modes) << modes.error().message();
  ASSERT_EQ(modes->modes.size(), 4u);
  EXPECT_EQ(modes->modes[0].layout, "Mono8");
  EXPECT_EQ(modes->modes[0].size, (FrameSize{128, 96}));
  EXPECT_EQ(modes->chosen.mode.layout, "BayerRG8");
  EXPECT_EQ(modes->chosen.mode.size, (FrameSize{64, 48}));
  EXPECT_EQ(modes->chosen.reason,
            "colour comes before grey, and few bits a pixel before many; a region of 128x96 px");
  EXPECT_FALSE(backend.offeredModes("Fake-Cam-2", {}));
}

TEST_F(AravisDiscoveryTest, TellsCamerasOfOneNameApart) {
  library_.plug({.id = "Fake-Cam-0", .physicalId = "aa:01", .address = "10.0.0.2"});
  library_.plug({.id = "Fake-Cam-0", .physicalId = "aa:02", .address = "10.0.0.3"});
  EXPECT_THAT(ids(), ElementsAre("aa:01", "aa:02"));
  for (const std::string name : {"aa:02", "10.0.0.3"}) {
    const auto camera = AravisBackend({}, {}, library_).make(name, clock_);
    EXPECT_TRUE(camera->start({})) << name;
  }
}

TEST_F(AravisDiscoveryTest, IsOpenedByIdAddressAndSerialNumber) {
  library_.plug({.id = "Fake-Cam-7", .physicalId = "a", .address = "10.0.0.7"});
  for (const std::string choice :
       {"auto", "aravis", "aravis:Fake-Cam-7", "aravis:10.0.0.7", "serial:7"}) {
    CameraSelector selector({{.backend = std::make_shared<AravisBackend>(
                                  AravisOptions{}, AravisDiscovery{}, library_)}},
                            choice, clock_);
    const auto opened = selector.open({});
    ASSERT_TRUE(opened) << choice << ": " << opened.error().message();
    EXPECT_EQ(opened->camera->identity().backend, "aravis") << choice;
  }
}

}  // namespace
}  // namespace pleinair::hal::aravis

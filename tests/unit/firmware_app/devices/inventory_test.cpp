#include "firmware_app/devices/inventory.h"

#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace pleinair::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using testing::HasSubstr;

Inventory full() {
  Inventory inventory;
  inventory.cameras.cameras = {
      {.identity = {.backend = "v4l2", .id = "usb-046d", .description = "C920"},
       .serial = "A1",
       .node = "/dev/video0",
       .modes = {{.layout = "YUYV",
                  .size = {640, 480},
                  .periods = {nanoseconds(33366667), milliseconds(100)}},
                 {.layout = "YUYV", .size = {1280, 720}, .periods = {}},
                 {.layout = "H264", .size = {1920, 1080}, .periods = {}, .isSupported = false}}},
      {.identity = {.backend = "v4l2", .id = "usb-2", .description = ""},
       .node = "/dev/video2",
       .problem = hal::Error{.kind = hal::ErrorKind::kPermissionDenied,
                             .subject = "/dev/video2",
                             .problem = "cannot open: Permission denied",
                             .remedy = "join the group video"}}};
  inventory.outputs = {
      {.kind = "window", .listing = {.outputs = {{.target = "window"}}}},
      {.kind = "loopback",
       .listing =
           {.outputs = {{.target = "loopback:/dev/video50",
                         .name = "pleinair",
                         .formats = {"YUYV", "NV12"}},
                        {.target = "loopback:/dev/video51", .name = "other", .isBusy = true}}}},
      {.kind = "movie", .help = "a movie", .forms = {"a.mp4", "a.mkv"}, .isFile = true}};
  inventory.keyboards = {
      {.description = {.node = "/dev/input/event2", .name = "AT keyboard", .isKeyboard = true}},
      {.description = {.node = "/dev/input/event4", .name = "Foot Switch"},
       .problem = hal::Error{.kind = hal::ErrorKind::kPermissionDenied,
                             .subject = "/dev/input/event4",
                             .problem = "cannot open: Permission denied",
                             .remedy = "join the group input"}}};
  return inventory;
}

TEST(Inventory, IsALineADeviceAndALayout) {
  EXPECT_EQ(asText(full()),
            "Cameras (--camera ID)\n"
            "  v4l2:usb-046d  C920  /dev/video0  serial:A1\n"
            "    YUYV  640x480 at 29.97, 10; 1280x720\n"
            "    H264  1920x1080 (not supported)\n"
            "  v4l2:usb-2  /dev/video2\n"
            "    cannot open: Permission denied\n"
            "    -> join the group video\n"
            "\n"
            "Outputs (--output NAME)\n"
            "  window\n"
            "  loopback:/dev/video50  pleinair  YUYV NV12\n"
            "  loopback:/dev/video51  other  (another program writes to it)\n"
            "  a.mp4, a.mkv: a movie\n"
            "\n"
            "Keyboards (--set input.keyboards=NAME)\n"
            "  AT keyboard  /dev/input/event2\n"
            "  Foot Switch  /dev/input/event4  (not in \"auto\")\n"
            "    cannot open: Permission denied\n"
            "    -> join the group input\n");
}

Inventory withModes() {
  Inventory inventory = full();
  inventory.asked = {.size = hal::FrameSize{640, 480}, .framePeriod = nanoseconds(33333333)};
  inventory.cameras.cameras[0].chosen = {
      .mode = {.layout = "YUYV", .size = {640, 480}, .periods = {nanoseconds(33366667)}},
      .reason = "no other format of it is read"};
  return inventory;
}

TEST(Inventory, OfModesIsOfCamerasAloneAndTellsTheChoice) {
  EXPECT_EQ(asText(withModes()),
            "Cameras (--camera ID), asked for 640x480 at 30\n"
            "  v4l2:usb-046d  C920  /dev/video0  serial:A1\n"
            "    YUYV  640x480 at 29.97, 10; 1280x720\n"
            "    H264  1920x1080 (not supported)\n"
            "    takes YUYV 640x480 at 29.97: no other format of it is read\n"
            "  v4l2:usb-2  /dev/video2\n"
            "    cannot open: Permission denied\n"
            "    -> join the group video\n");
  const nlohmann::json document = nlohmann::json::parse(asJson(withModes()));
  const nlohmann::json& chosen = document["cameras"][0]["chosen"];
  EXPECT_EQ(chosen["layout"], "YUYV");
  EXPECT_EQ(chosen["width"], 640);
  EXPECT_NEAR(chosen["rate"].get<double>(), 29.97, 1e-4);
  EXPECT_EQ(chosen["reason"], "no other format of it is read");
  EXPECT_TRUE(document["cameras"][1]["chosen"].is_null());
}

TEST(Inventory, SaysWhatToDoWhereThereIsNothing) {
  Inventory empty;
  empty.outputs = {{.kind = "window",
                    .listing = {.problem = hal::Error{.kind = hal::ErrorKind::kNotFound,
                                                      .subject = "window",
                                                      .problem = "there is no display",
                                                      .remedy = "start a desktop"}}}};
  const std::string text = asText(empty);
  EXPECT_THAT(text, HasSubstr("  none. Plug one in, see `pleinair doctor`"));
  EXPECT_THAT(text, HasSubstr("  no window\n    there is no display\n    -> start a desktop\n"));
}

TEST(Inventory, TellsOfBackEndsThatFail) {
  Inventory inventory;
  inventory.cameras.problems = {
      {.kind = hal::ErrorKind::kIo, .subject = "v4l2", .problem = "cannot list /dev"}};
  const std::string text = asText(inventory);
  EXPECT_THAT(text, HasSubstr("  v4l2: cannot list /dev\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("none. Plug")));
}

TEST(Inventory, IsJson) {
  Inventory inventory = full();
  inventory.outputs[1].listing.outputs[0].name = "l\xff";
  const nlohmann::json document = nlohmann::json::parse(asJson(inventory));
  const nlohmann::json& camera = document["cameras"][0];
  EXPECT_EQ(camera["id"], "usb-046d");
  EXPECT_EQ(camera["formats"].size(), 3u);
  EXPECT_NEAR(camera["formats"][0]["rates"][0].get<double>(), 29.97, 1e-4);
  EXPECT_EQ(camera["formats"][2]["read"], false);
  EXPECT_TRUE(camera["problem"].is_null());
  EXPECT_EQ(document["cameras"][1]["problem"],
            "/dev/video2: cannot open: Permission denied; join the group video");
  EXPECT_EQ(document["outputs"].size(), 3u);
  EXPECT_EQ(document["outputs"][0]["kind"], "window");
  EXPECT_EQ(document["outputs"][1]["target"], "loopback:/dev/video50");
  EXPECT_EQ(document["outputs"][1]["formats"][1], "NV12");
  EXPECT_EQ(document["outputs"][2]["busy"], true);
  EXPECT_TRUE(document["problems"].empty());
}

}  // namespace
}  // namespace pleinair::app

#include "hal/cameras/v4l2/modes.h"

#include "hal/cameras/v4l2/v4l2_kind.h"
#include "hal/v4l2/formats.h"
#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::HasSubstr;

constexpr v4l2_fract kFps30{1, 30};
constexpr v4l2_fract kFps10{1, 10};
constexpr FrameSize kVga{640, 480};
constexpr FrameSize kHd{1280, 720};

class V4l2Modes : public FakeCamera {
 protected:
  ModeChoice chosen(std::vector<support::FakeFormat> formats, const StreamRequest& request) {
    plug({.formats = std::move(formats)});
    const Result<Device> device = Device::open(kernel_, kNode);
    EXPECT_TRUE(device);
    const Result<ModeChoice> choice = chooseMode(*device, request);
    EXPECT_TRUE(choice) << choice.error().message();
    return choice.value_or(ModeChoice{});
  }
  static std::string nameOf(const ModeChoice& choice) { return fourccText(choice.layout->fourcc); }

  /// A webcam's modes: large uncompressed frames are slow.
  const std::vector<support::FakeFormat> webcam_{
      {.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga, kHd}, .periods = {kFps10}},
      {.fourcc = V4L2_PIX_FMT_MJPEG, .sizes = {kVga, kHd}, .periods = {kFps30}}};
};

TEST_F(V4l2Modes, TakeUncompressedPicturesAtTheRateAskedFor) {
  EXPECT_EQ(nameOf(chosen(webcam_, {.size = kHd, .framePeriod = 100ms})), "YUYV");
}

TEST_F(V4l2Modes, TakeJpegsWhereUncompressedPicturesAreTooSlow) {
  const ModeChoice choice = chosen(webcam_, {.size = kHd, .framePeriod = Duration(33'333'333)});
  EXPECT_EQ(nameOf(choice), "MJPG");
  EXPECT_EQ(choice.size, kHd);
  EXPECT_EQ(nameOf(chosen(webcam_, {})), "MJPG") << "fluent where nothing is asked for";
}

TEST_F(V4l2Modes, TakeUncompressedPicturesAtTheRateOfTheNtscToo) {
  EXPECT_EQ(nameOf(chosen({{.fourcc = V4L2_PIX_FMT_YUYV, .periods = {{1001, 30000}}},
                           {.fourcc = V4L2_PIX_FMT_MJPEG, .periods = {kFps30}}},
                          {.framePeriod = Duration(33'333'333)})),
            "YUYV");
}

TEST_F(V4l2Modes, TakeTheSizeBeforeTheRate) {
  const ModeChoice choice =
      chosen({{.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga}, .periods = {kFps30}},
              {.fourcc = V4L2_PIX_FMT_NV12, .sizes = {kHd}, .periods = {kFps10}}},
             {.size = kHd, .framePeriod = 33ms});
  EXPECT_EQ(nameOf(choice), "NV12");
}

TEST_F(V4l2Modes, TakeThePixelFormatAskedForBeforeAll) {
  const ModeChoice choice = chosen({{.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kHd}},
                                    {.fourcc = V4L2_PIX_FMT_GREY, .sizes = {kVga}}},
                                   {.size = kHd, .pixelFormat = PixelFormat::kGrey8});
  EXPECT_EQ(nameOf(choice), "GREY");
}

TEST_F(V4l2Modes, TakeColorBeforeGrey) {
  EXPECT_EQ(nameOf(chosen({{.fourcc = V4L2_PIX_FMT_GREY, .sizes = {kHd}},
                           {.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga}}},
                          {.size = kHd})),
            "YUYV");
}

TEST_F(V4l2Modes, LeaveOutWhatIsNotRead) {
  EXPECT_EQ(nameOf(chosen({{.fourcc = V4L2_PIX_FMT_H264, .sizes = {kHd}},
                           {.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga}}},
                          {.size = kHd})),
            "YUYV");
}

TEST_F(V4l2Modes, SayWhatDecided) {
  EXPECT_EQ(chosen(webcam_, {.size = kHd, .framePeriod = Duration(33'333'333)}).reason,
            "YUYV reaches 10 of 30 frames/s at that size");
  EXPECT_EQ(chosen(webcam_, {.size = kHd, .framePeriod = 100ms}).reason, "MJPG is compressed");
  EXPECT_EQ(
      chosen({{.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga}, .periods = {kFps10}}},
             {.size = kHd, .framePeriod = 40ms})
          .reason,
      "nearest to 1280x720 px; no mode of that size is faster than 10 frames/s; no other format "
      "of it is read");
  EXPECT_EQ(chosen({{.fourcc = V4L2_PIX_FMT_YUYV, .sizes = {kVga}},
                    {.fourcc = V4L2_PIX_FMT_NV12, .sizes = {kHd}}},
                   {.size = kHd})
                .reason,
            "YUYV comes no nearer than 640x480 px");
  EXPECT_EQ(chosen({{.fourcc = V4L2_PIX_FMT_GREY}, {.fourcc = V4L2_PIX_FMT_YUYV}}, {}).reason,
            "GREY has no colour");
  EXPECT_EQ(chosen({{.fourcc = V4L2_PIX_FMT_YUYV}, {.fourcc = V4L2_PIX_FMT_NV12}}, {}).reason,
            "YUYV costs more to paint");
  EXPECT_EQ(chosen({{.fourcc = V4L2_PIX_FMT_YUYV}, {.fourcc = V4L2_PIX_FMT_GREY}},
                   {.pixelFormat = PixelFormat::kGrey8})
                .reason,
            "YUYV is not the pixel format asked for");
}

TEST_F(V4l2Modes, AreToldWithTheOneThatStartTakes) {
  plug({.formats = webcam_});
  V4l2Backend backend(system());
  const StreamRequest request{.size = FrameSize{1200, 700}, .framePeriod = Duration(33'333'333)};
  const Result<OfferedModes> modes = backend.offeredModes(kNode, request);
  ASSERT_TRUE(modes) << modes.error().message();
  EXPECT_EQ(modes->modes.size(), 4u);
  EXPECT_EQ(modes->chosen.mode.layout, "MJPG");
  EXPECT_EQ(modes->chosen.mode.size, kHd);
  EXPECT_THAT(modes->chosen.mode.periods, testing::ElementsAre(Duration(33'333'333)));
  EXPECT_EQ(modes->chosen.reason,
            "nearest to 1200x700 px; YUYV reaches 10 of 30 frames/s at that size");
  EXPECT_EQ(startOrFail(request).frame.size, kHd);
  destroyCamera();
  expectNothingLeft();
}

TEST_F(V4l2Modes, OfADeviceThatIsNotThereAreAnError) {
  V4l2Backend backend(system());
  EXPECT_FALSE(backend.offeredModes(kNode, {}));
}

TEST_F(V4l2Modes, OfADeviceWithNoneThatIsReadAreRefusedByName) {
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_H264}, {.fourcc = V4L2_PIX_FMT_Y16_BE}}});
  const Error error = startError();
  EXPECT_EQ(error.kind, ErrorKind::kUnsupported);
  EXPECT_THAT(error.message(), HasSubstr("offers only H264, Y16-BE; choose a camera with one of "
                                         "NV12, NM12, YU12, YM12, YUYV"));
}

TEST_F(V4l2Modes, OfARangeAreOnItsSteps) {
  const std::vector<support::FakeFormat> range{
      {.sizes = {{32, 16}, {1920, 1080}}, .step = FrameSize{16, 8}}};
  EXPECT_EQ(chosen(range, {.size = FrameSize{650, 483}}).size, (FrameSize{656, 480}));
  EXPECT_EQ(chosen(range, {.size = FrameSize{1, 1}}).size, (FrameSize{32, 16}));
  EXPECT_EQ(chosen(range, {.size = FrameSize{8000, 8000}}).size, (FrameSize{1920, 1080}));
}

TEST_F(V4l2Modes, OfARangeAreListedAtTheLargest) {
  plug({.formats = {{.sizes = {{32, 16}, {1920, 1080}},
                     .periods = {kFps10, kFps30},
                     .step = FrameSize{16, 8}},
                    {.fourcc = V4L2_PIX_FMT_H264, .sizes = {kVga}, .periods = {}}}});
  const Result<Device> device = Device::open(kernel_, kNode);
  ASSERT_TRUE(device);
  const std::vector<CameraMode> modes = modesOf(*device);
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_EQ(modes[0].layout, "YUYV");
  EXPECT_EQ(modes[0].size, (FrameSize{1920, 1080}));
  EXPECT_THAT(modes[0].periods, testing::ElementsAre(Duration(33'333'333), Duration(100ms)));
  EXPECT_TRUE(modes[0].isSupported);
  EXPECT_EQ(modes[1].layout, "H264");
  EXPECT_FALSE(modes[1].isSupported);
  EXPECT_TRUE(modes[1].periods.empty());
}

TEST(V4l2Fourcc, IsReadable) {
  EXPECT_EQ(fourccText(V4L2_PIX_FMT_YUYV), "YUYV");
  EXPECT_EQ(fourccText(V4L2_PIX_FMT_Y16), "Y16");
  EXPECT_EQ(fourccText(V4L2_PIX_FMT_Y16_BE), "Y16-BE");
  EXPECT_EQ(fourccText(0x41420A01), "\\x01\\x0aBA");
}

}  // namespace
}  // namespace pleinair::hal::v4l2

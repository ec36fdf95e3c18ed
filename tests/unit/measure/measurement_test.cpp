#include "pipeline/measure/measurement.h"

#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/png_file.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/negative_controls.h"
#include "pipeline/styles/registry.h"
#include "tests/support/deep_png.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

using testing::HasSubstr;

constexpr hal::FrameSize kFrame{200, 180};

/// Paints by a function of the image and the number of calls so far.
class FunctionPainter final : public MeasuredPainter {
 public:
  using Function = std::function<cv::Mat3f(const cv::Mat3f&, int)>;
  explicit FunctionPainter(Function function) : function_(std::move(function)) {}
  hal::Result<PaintedFrame> paint(const hal::CapturedFrame& frame) override {
    const cv::Mat3f input = toFloat(frame.image.map().view());
    return PaintedFrame{.input = hal::Image(frame.image),
                        .output = toImage(function_(input, calls++)),
                        .anchors = {}};
  }
  void reset() override { ++resets; }
  int calls = 0;
  int resets = 0;

 private:
  Function function_;
};

/// Shows a sheet of blobs that moves by (2, 1) px a frame over the picture, and paints faithfully.
class SheetPainter final : public MeasuredPainter {
 public:
  /// What it says of the sheet's motion, px a frame.
  explicit SheetPainter(cv::Point2f told) : told_(told) {}
  hal::Result<PaintedFrame> paint(const hal::CapturedFrame& frame) override {
    const cv::Rect sheet(cv::Point(50, 45) + calls_ * cv::Point(2, 1), cv::Size(60, 56));
    cv::Mat3f shown = toFloat(frame.image.map().view());
    windowOf(sheet_, {0, 0}, sheet.size()).copyTo(shown(sheet));
    PaintedModels models{.ids = cv::Mat1i(shown.size(), 0),
                         .barycentrics = cv::Mat2f(shown.size(), cv::Vec2f()),
                         .place = {},
                         .changed = {}};
    constexpr int kObject = 1 << PaintedModels::kTriangleBits;
    models.ids(sheet).setTo(kObject);
    models.changed = models.mask();
    const cv::Point2f origin = cv::Point2f(50, 45) + static_cast<float>(calls_) * told_;
    for (int y = sheet.y; y < sheet.br().y; ++y) {
      for (int x = sheet.x; x < sheet.br().x; ++x) {
        models.barycentrics(y, x) = {static_cast<float>(x) - origin.x,
                                     static_cast<float>(y) - origin.y};
      }
    }
    models.place = [origin](int, const cv::Vec2f& at) {
      return std::optional(cv::Point2f(at[0] + origin.x, at[1] + origin.y));
    };
    ++calls_;
    return PaintedFrame{.input = toImage(shown),
                        .output = toImage(shown),
                        .anchors = {},
                        .models = std::move(models),
                        .camera = hal::Image(frame.image)};
  }
  void reset() override { calls_ = 0; }

 private:
  cv::Mat3f sheet_ = strongBlobs({60, 56}, 9);
  cv::Point2f told_;
  int calls_ = 0;
};

class MeasurementTest : public testing::Test {
 protected:
  MeasurementTest() {
    hal::orThrow(hal::writePng(path("photo.png"), toImage(strongBlobs({400, 300}, 1)).view()));
  }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  std::unique_ptr<MeasuredInput> photograph(PhotographMotion motion, std::uint64_t frames = 14) {
    return hal::orThrow(
        openPhotograph(path("photo.png"), {.size = kFrame, .motion = motion, .frames = frames}));
  }
  /// Writes the frames of a pan into a folder.
  void writeFrames(int count, hal::FrameSize size = kFrame) {
    std::filesystem::create_directory(path("in"));
    const cv::Mat3f canvas = blobPicture({400, 300}, 2);
    for (int i = 0; i < count; ++i) {
      const cv::Mat3f frame = windowOf(canvas, {4 + 2 * i, 4 + i}, {size.width, size.height});
      hal::orThrow(
          hal::writePng(path("in/frame_" + std::to_string(i) + ".png"), toImage(frame).view()));
    }
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(path(name)) << text;
  }
  Report runWithSheet(cv::Point2f told) {
    const auto input = photograph({.pan = {-1, 0}});
    SheetPainter painter(told);
    return *hal::orThrow(measure(*input, painter,
                                 {.style = "painterly",
                                  .coherence = styles::styleKind("painterly").coherence,
                                  .stillFrames = 4,
                                  .stillSettle = 1}));
  }
  static Report run(MeasuredInput& input, const FunctionPainter::Function& function,
                    MeasurementOptions options = {
                        .style = "watercolor",
                        .coherence = styles::styleKind("watercolor").coherence,
                        .stillFrames = 4,
                        .stillSettle = 1}) {
    FunctionPainter painter(function);
    return *hal::orThrow(measure(input, painter, options));
  }

  support::TemporaryFolder folder_;
};

cv::Mat3f itself(const cv::Mat3f& input, int) {
  return input;
}

TEST_F(MeasurementTest, ComposesTheTruthOfTheCameraAndTheModels) {
  const Report report = runWithSheet({2, 1});
  EXPECT_THAT(report.motion, HasSubstr("and the models' own motion"));
  EXPECT_EQ(report.motionKind, MotionKind::kOther);
  EXPECT_TRUE(report.areControlsValid()) << reportText(report);
  ASSERT_TRUE(report.models);
  EXPECT_LT(*report.models->regions[Region::kVirtual][Subject::kPainting].nHw2, 0.01);
  EXPECT_LT(*report.models->regions[Region::kReal][Subject::kPainting].nHw2, 0.01);
  EXPECT_LT(*report.measures[Subject::kPainting].nHw2, 0.01);
  // Beside the sheet, whose still scene moves, only the noise of the camera is seen.
  EXPECT_NEAR(*report.measures[Subject::kPainting].xFlk, 1.0, 1e-6);
}

/// With the camera's motion for the models', nothing in the report is to be relied on.
TEST_F(MeasurementTest, ATruthThatForgetsTheModelsMakesTheControlsWrong) {
  const Report report = runWithSheet({-1, 0});
  EXPECT_FALSE(report.areControlsValid());
  EXPECT_THAT(reportText(report), HasSubstr("WRONG         the input follows the models' motion"));
}

TEST_F(MeasurementTest, OfTheInputItselfIsPerfectButForItsNoise) {
  const auto input = photograph({.pan = {-1.5, -0.5}});
  const Report report = run(*input, itself);
  const Measures& own = report.measures[Subject::kPainting];
  EXPECT_EQ(own.xEw2, 1.0);
  EXPECT_EQ(own.xFlk, 1.0);
  EXPECT_EQ(own.det, 1.0);
  EXPECT_LT(*own.nHw2, 0.02);
  EXPECT_EQ(own.popPercent, 0.0);
  EXPECT_EQ(own.s10Percent, 100.0);
  EXPECT_LT(std::abs(*own.scr), 0.1);
  EXPECT_TRUE(report.areControlsValid());
  EXPECT_FALSE(report.areGatesPassed());  // noise passes through, and nothing is painted
  EXPECT_EQ(report.frames, 14u);
  EXPECT_EQ(report.overTime.size(), 14u);
  EXPECT_FALSE(report.worst.empty());
}

TEST_F(MeasurementTest, SeesMarksThatStayOnTheScreen) {
  const auto input = photograph({.pan = {-1.5, -0.5}});
  const VoronoiTiling tiles({kFrame.width, kFrame.height}, 77);
  const Report report =
      run(*input, [&tiles](const cv::Mat3f& frame, int) { return tiles.paint(frame); });
  const Measures& own = report.measures[Subject::kPainting];
  EXPECT_GT(*own.scr, 0.25);
  EXPECT_LT(*own.xFlk, 0.2);
  EXPECT_FALSE(report.areGatesPassed());
}

TEST_F(MeasurementTest, SeesMarksThatAreRedrawnAlsoUnderZoomAndRoll) {
  for (const PhotographMotion& motion :
       {PhotographMotion{.zoomPercent = 1}, PhotographMotion{.rollDegrees = 1}}) {
    const auto input = photograph(motion, 5);
    const Report report = run(*input, [](const cv::Mat3f& frame, int call) {
      return VoronoiTiling(frame.size(), 100 + static_cast<std::uint64_t>(call)).paint(frame);
    });
    EXPECT_GT(*report.measures[Subject::kPainting].nHw2, 0.5);
    EXPECT_GT(*report.measures[Subject::kPainting].xFlk, 1);
    EXPECT_LT(*report.measures[Subject::kInput].nHw2, 0.05);
    EXPECT_TRUE(report.areControlsValid());
  }
}

TEST_F(MeasurementTest, CannotBePassedByBlurring) {
  const auto input = photograph({.pan = {-1.5, -0.5}});
  const Report report = run(*input, [](const cv::Mat3f& frame, int) {
    cv::Mat3f blurred;
    cv::GaussianBlur(frame, blurred, {}, 6.0);
    return blurred;
  });
  EXPECT_LT(*report.measures[Subject::kPainting].xEw2, 0.1);
  EXPECT_LT(*report.measures[Subject::kPainting].det, 0.5);
}

TEST_F(MeasurementTest, PaintsBeforeItMeasuresAndAStillAfterwards) {
  const auto input = photograph({.pan = {-1.5, -0.5}}, 9);
  FunctionPainter painter(itself);
  int calls = 0;
  const MeasurementOptions options{.style = "none",
                                   .frames = 4,
                                   .settle = 5,
                                   .stillFrames = 3,
                                   .stillSettle = 2,
                                   .goesOn = [&calls] { return ++calls > 0; }};
  EXPECT_EQ(framesToPaint(*input, options), 14u);
  const auto report = hal::orThrow(measure(*input, painter, options));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->frames, 4u);
  EXPECT_EQ(report->overTime.front().frame, 5u);
  EXPECT_EQ(painter.calls, 14);
  EXPECT_EQ(painter.resets, 1);
  EXPECT_EQ(calls, 14);
  EXPECT_TRUE(report->gates.empty());
}

TEST_F(MeasurementTest, SaysThatTheInputEndsBeforeTheFramesThatWereAskedFor) {
  writeFrames(4);
  const auto input = hal::orThrow(openPictureFolder(path("in")));
  const MeasurementOptions options{.style = "none", .frames = 9, .stillFrames = 0};
  EXPECT_THAT(run(*input, itself, options).notices,
              testing::ElementsAre(HasSubstr("of 9 frames that were asked for 4")));
  const auto again = hal::orThrow(openPictureFolder(path("in")));
  EXPECT_THAT(run(*again, itself, {.style = "none", .frames = 4, .stillFrames = 0}).notices,
              testing::IsEmpty());
}

TEST_F(MeasurementTest, TakesAPhotographAtItsOwnSizeOrFewerPixels) {
  const auto own = hal::orThrow(openPhotograph(path("photo.png"), {}));
  EXPECT_EQ(own->format().size, (hal::FrameSize{400, 300}));
  EXPECT_THAT(own->notices(), testing::IsEmpty());
  hal::orThrow(hal::writePng(path("large.png"), toImage(strongBlobs({1600, 900}, 1)).view()));
  const auto large = hal::orThrow(openPhotograph(path("large.png"), {.motion = {.pan = {1, 0}}}));
  EXPECT_EQ(large->format().size, (hal::FrameSize{739, 416}));
  EXPECT_THAT(large->notices(), testing::IsEmpty());
}

TEST_F(MeasurementTest, SaysWhereAPhotographGoesOnMirrored) {
  const auto panned = hal::orThrow(openPhotograph(path("photo.png"), {.motion = {.pan = {1, 0}}}));
  EXPECT_THAT(panned->notices(), testing::ElementsAre(HasSubstr("the frames' way")));
  const auto wide =
      hal::orThrow(openPhotograph(path("photo.png"), {.size = hal::FrameSize{500, 300}}));
  EXPECT_THAT(wide->notices(), testing::ElementsAre(HasSubstr("500x300 reach beyond")));
}

TEST_F(MeasurementTest, CanBeAborted) {
  const auto input = photograph({.pan = {-1.5, -0.5}});
  FunctionPainter painter(itself);
  const auto report =
      hal::orThrow(measure(*input, painter, {.goesOn = [&painter] { return painter.calls < 3; }}));
  EXPECT_FALSE(report);
  EXPECT_EQ(painter.calls, 3);
}

TEST_F(MeasurementTest, TakesAFolderWithItsMotion) {
  writeFrames(13);
  write("in/motion.json", R"({"v": [-2, -1]})");
  const auto input = hal::orThrow(openPictureFolder(path("in")));
  EXPECT_EQ(input->frameCount(), 13u);
  const Report report = run(*input, itself);
  EXPECT_EQ(report.motionKind, MotionKind::kPan);
  EXPECT_EQ(*report.measures[Subject::kPainting].ew2, 0.0);  // no noise, whole steps
  EXPECT_EQ(report.measures[Subject::kPainting].s10Percent, 100.0);
}

TEST_F(MeasurementTest, TakesAFolderWithFlowFiles) {
  writeFrames(4);
  for (int i = 0; i < 3; ++i) {
    support::constantFlow(kFrame.width, kFrame.height, -2, -1)
        .write(path("in/flow_" + std::to_string(i) + ".png"));
  }
  const auto input = hal::orThrow(openPictureFolder(path("in")));
  EXPECT_EQ(input->frameCount(), 4u);
  const Report report = run(*input, itself);
  EXPECT_EQ(report.motionKind, MotionKind::kOther);
  EXPECT_LT(*report.measures[Subject::kPainting].ew2, 1e-9);
  EXPECT_THAT(report.leftOut,
              testing::Contains(HasSubstr("S10 %, SCR: it compares frames 10 apart")));
  std::filesystem::remove(path("in/flow_1.png"));
  EXPECT_THAT(openPictureFolder(path("in")).error().message(),
              testing::AllOf(HasSubstr("4 frames"), HasSubstr("2 flow files")));
}

TEST_F(MeasurementTest, SaysWhatCannotBeHadWithoutTruth) {
  writeFrames(13);
  const auto input = hal::orThrow(openPictureFolder(path("in")));
  const Report report = run(*input, itself);
  const Measures& own = report.measures[Subject::kPainting];
  EXPECT_FALSE(own.ew2 || own.nHw2 || own.s10Percent || own.popPercent);
  EXPECT_TRUE(own.scr && own.dep && own.det && own.xFlk);
  EXPECT_THAT(report.leftOut, testing::Contains(HasSubstr("motion.json")));
}

/// Such a movie does not give its number of frames.
TEST(MeasuredRecording, RefusesToGoOnBeyondItsMotion) {
  const support::TemporaryFolder folder;
  support::writeMedia(folder.path() / "in.mkv", 4);
  std::ofstream(folder.path() / "m.json") << R"({"homographies": [[1,0,0, 0,1,0, 0,0,1]]})";
  const auto input = openPlainRecording(folder.path() / "in.mkv", folder.path() / "m.json");
  ASSERT_TRUE(input) << input.error().message();
  EXPECT_FALSE((*input)->frameCount());
  for (int i = 0; i < 2; ++i) ASSERT_TRUE((*input)->next());
  const auto beyond = (*input)->next();
  ASSERT_FALSE(beyond);
  EXPECT_THAT(beyond.error().message(), HasSubstr("2 frames"));
}

TEST_F(MeasurementTest, RefusesWhatIsTooShortOrTooSmall) {
  writeFrames(2);
  FunctionPainter painter(itself);
  const auto input = hal::orThrow(openPictureFolder(path("in")));
  EXPECT_THAT(measure(*input, painter, {}).error().message(),
              testing::AllOf(HasSubstr("2 frames"), HasSubstr("3 at least")));
  writeFrames(4, {150, 200});
  const auto small = hal::orThrow(openPictureFolder(path("in")));
  EXPECT_THAT(measure(*small, painter, {}).error().message(), HasSubstr("160x160"));
}

}  // namespace
}  // namespace pleinair::measure

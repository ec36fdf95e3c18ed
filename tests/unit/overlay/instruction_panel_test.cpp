#include "firmware_app/overlay/instruction_panel.h"

#include <algorithm>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "hal/media/png_file.h"
#include "pipeline/procedure/procedure.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

class InstructionPanelTest : public testing::Test {
 protected:
  static hal::Image panelOf(const std::string& title, const std::string& body,
                            hal::FrameSize output) {
    procedure::Procedure procedure;
    procedure.languages = {"de"};
    procedure.steps.resize(1);
    procedure.steps[0].id = "a";
    procedure.steps[0].text["de"] = {.title = title, .body = body};
    return instructionPanel({.procedure = std::make_shared<const procedure::Procedure>(procedure),
                             .language = "de",
                             .request = "Bild ab: fertig"},
                            {}, output)
        .image;
  }
  /// The rightmost column and the lowest row with bright ink.
  struct Extent {
    int right = 0;
    int bottom = 0;
  };
  static Extent inkOf(const hal::Image& panel) {
    Extent extent;
    for (int y = 0; y < panel.size().height; ++y) {
      const auto row = panel.view().row(0, y);
      for (int x = 0; x < panel.size().width; ++x) {
        if (row[4 * static_cast<std::size_t>(x) + 1] < 150) continue;
        extent.right = std::max(extent.right, x);
        extent.bottom = std::max(extent.bottom, y);
      }
    }
    return extent;
  }
};

TEST_F(InstructionPanelTest, LongWordsAndMixedDirectionsStayInside) {
  const std::string word = "Zahnflankenspielmessuhrhalterungsbefestigungsschraubenanzugsmoment";
  const std::string arabic = "افحص صمام الزيت قبل تشغيل المحرك";
  for (const hal::FrameSize output : {hal::FrameSize{640, 480}, {1280, 720}, {320, 240}}) {
    for (const std::string& body :
         {word + word, arabic + " (Ölablassschraube M12) " + arabic, arabic + word}) {
      const hal::Image panel = panelOf(word, body, output);
      EXPECT_EQ(panel.size().width, output.width);
      EXPECT_LE(panel.size().height, 2 * output.height / 5);
      const Extent ink = inkOf(panel);
      EXPECT_LT(ink.right, output.width - 4) << "beside the border";
      EXPECT_GT(ink.bottom, panel.size().height / 3);
      EXPECT_LT(ink.bottom, panel.size().height - 2) << "no line is cut in its middle";
    }
  }
}

TEST_F(InstructionPanelTest, ALongTextIsSetInSmallerLetters) {
  std::string body;
  for (int i = 0; i < 36; ++i) body += "Schraube lösen. ";
  const hal::Image panel = panelOf("Lang", body, {640, 480});
  EXPECT_LE(panel.size().height, 192);
  EXPECT_LT(inkOf(panel).bottom, panel.size().height - 2) << "all of it is there";
}

TEST_F(InstructionPanelTest, AMoviesPlaceIsInsideBesideTheText) {
  auto procedure = std::make_shared<procedure::Procedure>();
  procedure->languages = {"de"};
  procedure->warnings.push_back({.id = "hot", .text = {{"de", "Heiß"}}});
  procedure->steps.resize(1);
  procedure->steps[0].text["de"] = {.title = "Lösen", .body = "Langsam."};
  procedure->steps[0].movie = procedure::StepMovie{.file = "m.mp4", .size = {1920, 1080}};
  for (const hal::FrameSize output : {hal::FrameSize{640, 480}, {1280, 720}, {320, 240}}) {
    for (const bool isWarned : {false, true}) {
      procedure->steps[0].warnings.clear();
      if (isWarned) procedure->steps[0].warnings = {0, 0};
      const InstructionPanel panel =
          instructionPanel({.procedure = procedure, .language = "de"}, {}, output);
      ASSERT_TRUE(panel.movie);
      const overlay::MoviePlace& place = *panel.movie;
      EXPECT_NEAR(place.size.width / static_cast<double>(place.size.height), 16.0 / 9.0, 0.05);
      EXPECT_LE(place.topLeft.x + place.size.width, output.width * 69 / 100);
      EXPECT_LT(place.topLeft.y + place.size.height, panel.image.size().height);
      EXPECT_GT(place.topLeft.y, 0);
    }
  }
  procedure->steps[0].movie.reset();
  EXPECT_FALSE(instructionPanel({.procedure = procedure, .language = "de"}, {}, {640, 480}).movie);
}

TEST_F(InstructionPanelTest, APictureOrMovieOfAnyShapeLeavesRoomForText) {
  const support::TemporaryFolder folder;
  ASSERT_TRUE(hal::writePng(
      folder.path() / "wide.png",
      hal::Image({.pixelFormat = hal::PixelFormat::kGrey8, .size = {8192, 16}}).view()));
  auto procedure = std::make_shared<procedure::Procedure>();
  procedure->languages = {"de"};
  procedure->steps.resize(1);
  procedure->steps[0].text["de"] = {.title = "Lösen", .body = "Langsam drehen."};
  const auto panelIn = [&](hal::FrameSize output) {
    return instructionPanel({.procedure = procedure, .language = "de"}, folder.path(), output);
  };
  for (const hal::FrameSize output : {hal::FrameSize{640, 480}, {1280, 720}, {320, 240}}) {
    for (const hal::FrameSize size : {hal::FrameSize{8192, 16}, {16, 8192}, {1920, 1080}}) {
      procedure->steps[0].movie = procedure::StepMovie{.file = "m.mp4", .size = size};
      const InstructionPanel panel = panelIn(output);
      ASSERT_TRUE(panel.movie);
      EXPECT_GT(panel.movie->topLeft.x, output.width * 35 / 100) << "text has half of the room";
      EXPECT_GE(panel.movie->size.height, 1);
      EXPECT_LE(panel.movie->topLeft.x + panel.movie->size.width, output.width * 69 / 100);
    }
    procedure->steps[0].movie.reset();
    const int plain = panelIn(output).image.size().height;
    procedure->steps[0].text["de"].pictures = {{.file = "wide.png", .caption = ""}};
    EXPECT_LE(panelIn(output).image.size().height, 2 * plain) << "no line a letter wide";
    procedure->steps[0].text["de"].pictures.clear();
  }
}

}  // namespace
}  // namespace pleinair::app

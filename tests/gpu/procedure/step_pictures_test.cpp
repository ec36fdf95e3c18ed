#include "firmware_app/procedure/step_pictures.h"

#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/procedure/procedure_file.h"

namespace pleinair::app {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";
constexpr hal::FrameSize kSize{240, 180};

/// The share of pixels in the colour that is reserved for instructions (overlay::kReservedRgb, with
/// shading), in percent.
double reservedPercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      count += row[i] > 2 * row[i + 1] && row[i + 2] > 3 * row[i + 1] / 2 ? 1 : 0;
    }
  }
  return 100.0 * count / (image.size().width * image.size().height);
}

/// The share of pixels that are not the paper, in percent.
double drawnPercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) count += row[i + 1] < 245 ? 1 : 0;
  }
  return 100.0 * count / (image.size().width * image.size().height);
}

class StepPicturesTest : public testing::Test {
 protected:
  void SetUp() override {
    try {
      const gpu::EglContext context;
    } catch (const hal::Failure& failure) {
      GTEST_SKIP() << failure.what();
    }
  }
  std::size_t step(const char* id) const { return *procedure_.findStep(id); }

  procedure::Procedure procedure_ = procedure::loadProcedure(kFolder);
};

TEST_F(StepPicturesTest, EveryStepShowsItsParts) {
  StepPictures pictures(procedure_, kSize);
  for (std::size_t i = 0; i < procedure_.steps.size(); ++i) {
    const hal::Image image = pictures.draw(i, {});
    EXPECT_EQ(image.size(), kSize);
    EXPECT_GT(reservedPercent(image), 0.15) << procedure_.steps[i].id;
    EXPECT_LT(reservedPercent(image), 60.0) << procedure_.steps[i].id;
  }
}

TEST_F(StepPicturesTest, PartsThatAreOffAreNotDrawn) {
  StepPictures pictures(procedure_, kSize);
  const std::size_t plug = step("drain");
  const double whole = drawnPercent(pictures.draw(plug, {}));
  std::set<std::size_t> others;
  for (std::size_t part = 0; part < procedure_.model->parts.size(); ++part) {
    if (part != procedure_.steps[plug].parts.front()) others.insert(part);
  }
  const hal::Image alone = pictures.draw(plug, others);
  EXPECT_GT(whole, 20.0);
  EXPECT_LT(drawnPercent(alone), 10.0) << "it, and its close-up";
  EXPECT_GT(reservedPercent(alone), 0.15) << "the step's part is drawn all the same";
}

/// The share of pixels in a pale shade of the reserved colour, as of ghosts before the paper or
/// other parts, in percent.
double palePercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      const bool isReserved = row[i] > 2 * row[i + 1];
      const bool isPurple = row[i] > row[i + 1] + 50 && row[i + 2] > row[i + 1] + 40;
      count += isPurple && !isReserved ? 1 : 0;
    }
  }
  return 100.0 * count / (image.size().width * image.size().height);
}

TEST_F(StepPicturesTest, AnExplodedViewIsDrawnApart) {
  const std::size_t index = step("cover_off");
  procedure::Step& lifted = procedure_.steps[index];
  const std::size_t cover = lifted.parts.front();
  StepPictures pictures(procedure_, kSize);
  const double without = palePercent(pictures.draw(index, {}));
  lifted.apart = {{cover, 0.1}};
  EXPECT_GT(palePercent(pictures.draw(index, {})), without + 3.0);
  lifted.apart = {{cover, 0.0}};
  EXPECT_LT(palePercent(pictures.draw(index, {})), without + 1.0) << "it lies on the part";
}

TEST_F(StepPicturesTest, PartsAreShownAsTheStepSays) {
  const std::size_t index = step("drain");
  procedure::Step& drained = procedure_.steps[index];
  drained.motion = procedure::Motion::kNone;
  const std::size_t cover = procedure_.steps[step("cover_off")].parts.front();
  StepPictures pictures(procedure_, kSize);
  const hal::Image usual = pictures.draw(index, {});
  drained.views = {{cover, procedure::PartView::kTint}};
  EXPECT_GT(palePercent(pictures.draw(index, {})), palePercent(usual) + 5.0);
  drained.views = {{cover, procedure::PartView::kFocus}};
  EXPECT_GT(reservedPercent(pictures.draw(index, {})), reservedPercent(usual) + 5.0);
  drained.views = {{cover, procedure::PartView::kOutline}};
  const double outlined = reservedPercent(pictures.draw(index, {}));
  EXPECT_GT(outlined, reservedPercent(usual) + 0.3) << "a line around it";
  EXPECT_LT(outlined, reservedPercent(usual) + 4.0) << "and nothing on it";
  drained.views = {{cover, procedure::PartView::kGhost}};
  EXPECT_GT(palePercent(pictures.draw(index, {})), palePercent(usual) + 5.0);
  drained.views = {{drained.parts.front(), procedure::PartView::kHidden}};
  EXPECT_LT(reservedPercent(pictures.draw(index, {})), 0.05);
}

/// The share of pixels of the line around a close-up, in percent.
double closeUpLinePercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
      count += row[i] == 60 && row[i + 1] == 60 && row[i + 2] == 60 ? 1 : 0;
    }
  }
  return 100.0 * count / (image.size().width * image.size().height);
}

TEST_F(StepPicturesTest, ASmallPartHasACloseUp) {
  StepPictures pictures(procedure_, kSize);
  const hal::Image plug = pictures.draw(step("drain"), {});
  EXPECT_GT(closeUpLinePercent(plug), 0.5);
  EXPECT_GT(reservedPercent(plug), 2.0) << "it is seen large";
  EXPECT_EQ(closeUpLinePercent(pictures.draw(step("cover_off"), {})), 0.0);
}

TEST_F(StepPicturesTest, PartsThatAreShownAndNotMeantDoNotChooseTheView) {
  const std::size_t index = step("drain");
  StepPictures pictures(procedure_, kSize);
  const double usual = closeUpLinePercent(pictures.draw(index, {}));
  const std::size_t cover = procedure_.steps[step("cover_off")].parts.front();
  procedure_.steps[index].views = {{cover, procedure::PartView::kOutline}};
  EXPECT_NEAR(closeUpLinePercent(pictures.draw(index, {})), usual, 0.3)
      << "the plug is as near as before";
}

TEST_F(StepPicturesTest, AxesAreDrawnWhereAskedFor) {
  const std::size_t index = step("cover_off");
  const auto bluePixels = [](const hal::Image& image) {
    int count = 0;
    for (int y = 0; y < image.size().height; ++y) {
      const auto row = image.view().row(0, y);
      for (std::size_t i = 0; i + 2 < row.size(); i += 3) {
        count += row[i] < 60 && row[i + 1] < 120 && row[i + 2] > 190 ? 1 : 0;
      }
    }
    return count;
  };
  EXPECT_EQ(bluePixels(StepPictures(procedure_, kSize).draw(index, {})), 0);
  EXPECT_GT(bluePixels(StepPictures(procedure_, kSize, true).draw(index, {})), 30) << "z";
}

}  // namespace
}  // namespace pleinair::app

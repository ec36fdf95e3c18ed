// A step that compares a still with its template, down to the record.
#include <cmath>
#include <fstream>

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "firmware_app/repair_station/live_procedure.h"
#include "hal/media/png_file.h"
#include "pipeline/record/record_check.h"
#include "pipeline/scene/models/model.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using procedure::StepCommandKind;
using testing::HasSubstr;

constexpr hal::FrameSize kSize{320, 240};

class LiveComparisonTest : public testing::Test {
 protected:
  LiveComparisonTest() {
    std::filesystem::create_directories(folder_.path() / "records");
    std::ofstream(folder_.path() / "procedure.toml")
        << "name = \"service\"\nversion = \"1\"\nlanguages = [\"en\"]\n"
           "step = [{ id = \"seal\", parts = [\"oil_plug\"], "
           "check = { kind = \"compare\", template = \"seal.png\" } },"
           "{ id = \"close\", removes = [\"oil_plug\"] }]\n[model]\nsource = \"builtin:gearbox\"\n";
    std::ofstream(folder_.path() / "en.md") << "# S\n## seal: A\n? Right?\n## close: B\n";
    hal::orThrow(hal::writePng(folder_.path() / "seal.png", picture(0.31).view()));
    live_.emplace(LiveProcedureOptions{.folder = folder_.path(),
                                       .records = folder_.path() / "records",
                                       .operatorName = "Jo",
                                       .program = "1"},
                  clock_);
    std::ofstream(folder_.path() / "seal.toml") << inspection::templatePoseText(placeAt(0.0));
  }

  /// Texture of a frequency.
  static hal::Image picture(double frequency) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      const auto row = image.row(0, y);
      for (std::size_t i = 0; i < row.size(); ++i) {
        const auto x = static_cast<double>(i / 3);
        row[i] = static_cast<std::uint8_t>(
            120 + 50 * std::sin(frequency * x + 2 * std::sin(0.07 * y)) + 40 * std::cos(0.2 * y));
      }
    }
    return image;
  }

  /// The machine with the plug in the middle of the picture, turned about it.
  inspection::TemplatePose placeAt(double degrees) const {
    const scene::Model& model = *live_->procedure().model;
    scene::Model plug = model;
    plug.parts = {*scene::findPart(model, "oil_plug")};
    scene::numberParts(plug);
    const scene::BoundingSphere sphere = scene::boundingSphere(plug);
    const double distance = 6.0 * sphere.radiusMetres;
    return {.camera = {{.fx = 480, .fy = 480, .cx = 160, .cy = 120}, {}, kSize},
            .cameraFromModel =
                glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, distance)) *
                glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0)) *
                glm::translate(glm::dmat4(1.0), -glm::dvec3(sphere.centre))};
  }

  void compare(double frequency, const std::optional<inspection::TemplatePose>& place) {
    clock_.advance(std::chrono::seconds(1));
    obey(StepCommandKind::kNext);
    ASSERT_TRUE(live_->takeStillRequest());
    live_->putStill(picture(frequency), place);
    live_->finish();
  }
  void obey(StepCommandKind kind) {
    live_->obey({.kind = kind, .operatorName = {}}, "pedal");
    live_->finish();
  }
  std::string step() const { return live_->status().step; }
  std::string notice() { return live_->takeNotice().value_or(""); }
  /// The outcomes in the record, with who found them.
  std::vector<std::string> outcomes() const {
    std::vector<std::string> outcomes;
    const auto reading = record::checkRecordFile(live_->status().record);
    for (const auto& entry : reading->entries) {
      const auto* done = std::get_if<record::StepDone>(&entry.event);
      if (done != nullptr) {
        outcomes.push_back(std::string(procedure::nameOf(done->outcome)) + " " + done->by);
      }
    }
    return outcomes;
  }

  support::TemporaryFolder folder_;
  hal::SteppedClock clock_{hal::TimePoint(std::chrono::seconds(100))};
  std::optional<LiveProcedure> live_;
};

TEST_F(LiveComparisonTest, WhatIsRightPassesAndWhatIsWrongStays) {
  compare(0.19, placeAt(2.0));
  EXPECT_EQ(step(), "seal");
  EXPECT_THAT(notice(), HasSubstr("do this step again"));
  compare(0.31, placeAt(0.0));
  EXPECT_EQ(step(), "close");
  EXPECT_THAT(outcomes(), testing::ElementsAre("fail program", "pass program"));
}

TEST_F(LiveComparisonTest, NobodyPassesItByHandUnlessTheProgramIsUncertain) {
  obey(StepCommandKind::kYes);
  EXPECT_EQ(step(), "seal");
  EXPECT_THAT(notice(), HasSubstr("the picture decides"));
  compare(0.31, placeAt(30.0));
  EXPECT_EQ(step(), "seal");
  EXPECT_THAT(notice(), testing::AllOf(HasSubstr("30° off"), HasSubstr("yes or no")));
  clock_.advance(std::chrono::seconds(1));
  obey(StepCommandKind::kYes);
  EXPECT_EQ(step(), "close");
  EXPECT_THAT(outcomes(), testing::ElementsAre("uncertain program", "pass operator"));
}

TEST_F(LiveComparisonTest, AMachineThatIsNotLocatedIsSaid) {
  compare(0.31, std::nullopt);
  EXPECT_EQ(step(), "seal");
  EXPECT_THAT(notice(), HasSubstr("not located"));
  EXPECT_TRUE(outcomes().empty());
}

TEST_F(LiveComparisonTest, WithoutItsPlaceATemplateIsComparedByEye) {
  std::filesystem::remove(folder_.path() / "seal.toml");
  obey(StepCommandKind::kNext);
  EXPECT_FALSE(live_->takeStillRequest());
  obey(StepCommandKind::kYes);
  EXPECT_EQ(step(), "close");
  EXPECT_THAT(outcomes(), testing::ElementsAre("pass operator"));
}

}  // namespace
}  // namespace pleinair::app

// The overlays of the procedure that comes with the program.
#include "firmware_app/overlay/step_content.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/overlay/machine.h"
#include "firmware_app/overlay/procedure_film.h"
#include "hal/error.h"
#include "pipeline/overlay/reserved_colours.h"
#include "pipeline/procedure/procedure_file.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using overlay::OverlayContent;
using overlay::PartLook;

const std::filesystem::path kFolder =
    std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox";
constexpr hal::FrameSize kOutput{640, 480};

/// A scene with a gearbox on a tag, and something else.
scene::Scene gearboxScene() {
  scene::Scene scene;
  scene.tags.push_back({.id = 0, .edgeMetres = 0.1});
  const auto add = [&](const char* name, const scene::ModelSource& source) {
    scene.models.push_back(
        {.name = name,
         .source = source,
         .model = std::make_shared<const scene::Model>(scene::modelOf(source).value()),
         .tagId = 0});
  };
  add("box", scene::BoxSource{});
  add("machine", scene::GearboxSource{});
  return scene;
}

std::size_t partOf(const scene::Model& model, const char* name) {
  return static_cast<std::size_t>(scene::findPart(model, name) - model.parts.data());
}

/// The share of pixels in the reserved colour, in percent.
double reservedPercent(const hal::Image& image) {
  int count = 0;
  const int pixels = image.size().width * image.size().height;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 3 < row.size(); i += 4) {
      count += row[i] > 100 && row[i + 1] < row[i] / 2 && row[i + 2] > row[i] / 2 ? 1 : 0;
    }
  }
  return 100.0 * count / pixels;
}

class StepContentTest : public testing::Test {
 protected:
  OverlayContent contentOf(const std::string& step, const std::string& language = "en") {
    scene_ = gearboxScene();
    ProcedureFilm film({.folder = kFolder, .language = language, .step = step}, scene_);
    machine_ = scene_.models[film.machine()].model;
    return *film.at(hal::Duration{0}, kOutput);
  }
  PartLook lookOf(const OverlayContent& content, const char* part) const {
    return content.looks[partOf(*machine_, part)];
  }
  bool hasGhost(const OverlayContent& content, const char* part) const {
    return std::ranges::count(content.ghosts, partOf(*machine_, part), &overlay::Ghost::part) > 0;
  }

  scene::Scene scene_;
  std::shared_ptr<const scene::Model> machine_;
};

TEST_F(StepContentTest, APartThatIsRemovedIsCrispWithAGhostThatLeaves) {
  const OverlayContent content = contentOf("drain");
  EXPECT_EQ(lookOf(content, "oil_plug"), PartLook::kFocus);
  EXPECT_EQ(lookOf(content, "cover"), PartLook::kPlain);
  ASSERT_EQ(content.ghosts.size(), 1U);
  EXPECT_FALSE(content.ghosts[0].comesHome);
  EXPECT_LT(content.ghosts[0].apartMetres.y, -0.01) << "out of the front";
  ASSERT_EQ(content.arrows.size(), 1U);
  EXPECT_EQ(content.arrows[0].kind, overlay::ArrowKind::kUnscrew);
}

TEST_F(StepContentTest, WhatIsOffIsHiddenAndComesBackAsAGhost) {
  const OverlayContent without = contentOf("backlash");
  EXPECT_EQ(lookOf(without, "cover"), PartLook::kHidden);
  EXPECT_EQ(lookOf(without, "cover_bolt_1"), PartLook::kHidden);
  EXPECT_EQ(lookOf(without, "gear_4"), PartLook::kFocus);
  const OverlayContent fitted = contentOf("cover_on");
  EXPECT_EQ(lookOf(fitted, "cover"), PartLook::kHidden);
  EXPECT_TRUE(hasGhost(fitted, "cover"));
  EXPECT_TRUE(std::ranges::all_of(fitted.ghosts, &overlay::Ghost::comesHome));
}

TEST_F(StepContentTest, EveryStepHasAnInstructionALabelAndAnInset) {
  scene_ = gearboxScene();
  ProcedureFilm film({.folder = kFolder, .language = "de", .secondsPerStep = 1.0}, scene_);
  EXPECT_EQ(film.steps(), 19U) << "all but the one that a bad outcome leads to";
  for (std::size_t i = 0; i < film.steps(); ++i) {
    const auto content = film.at(hal::fromSeconds(static_cast<double>(i) + 0.5), kOutput);
    EXPECT_EQ(content->panel.size().width, kOutput.width);
    EXPECT_LE(content->panel.size().height, 2 * kOutput.height / 5) << i;
    EXPECT_GE(content->panel.size().height, 40) << i;
    EXPECT_EQ(content->labels.size(), 1U);
    EXPECT_GT(reservedPercent(content->labels[0].picture), 10.0);
    EXPECT_GT(reservedPercent(content->inset), 0.8) << "step " << i + 1 << " shows its parts";
  }
}

TEST_F(StepContentTest, PicturesScaleWithTheOutput) {
  scene_ = gearboxScene();
  ProcedureFilm film({.folder = kFolder, .step = "drain"}, scene_);
  const int usual = film.at(hal::Duration{0}, kOutput)->panel.size().height;
  scene_ = gearboxScene();
  ProcedureFilm large({.folder = kFolder, .step = "drain"}, scene_);
  const auto content = large.at(hal::Duration{0}, {1920, 1080});
  EXPECT_EQ(content->panel.size().width, 1920);
  EXPECT_NEAR(content->panel.size().height, 3 * usual, 30);
}

/// The gearbox's procedure with another line for the step "seat".
class EditedProcedure {
 public:
  explicit EditedProcedure(const std::string& keys) {
    for (const char* const name : {"procedure.toml", "en.md", "de.md"}) {
      std::ifstream file(kFolder / name);
      std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      const std::string line = "{ id = \"seat\", ";
      if (const std::size_t at = text.find(line); at != std::string::npos) {
        text.insert(at + line.size(), keys + ", ");
      }
      std::ofstream(folder_.path() / name) << text;
    }
  }
  const std::filesystem::path& path() const { return folder_.path(); }

 private:
  support::TemporaryFolder folder_;
};

TEST_F(StepContentTest, AStepSaysHowPartsAreShown) {
  const EditedProcedure edited(
      R"(show = { housing = "tint", "gear_*" = "hidden", cover = "ghost" }, apart = { output_key = 0.05 }, motion = "turn")");
  scene_ = gearboxScene();
  ProcedureFilm film({.folder = edited.path(), .step = "seat"}, scene_);
  machine_ = scene_.models[film.machine()].model;
  const OverlayContent content = *film.at(hal::Duration{0}, kOutput);
  EXPECT_EQ(lookOf(content, "housing"), PartLook::kTint);
  EXPECT_EQ(lookOf(content, "gear_2"), PartLook::kHidden);
  EXPECT_EQ(lookOf(content, "output_shaft"), PartLook::kFocus);
  EXPECT_TRUE(hasGhost(content, "cover"));
  const auto away =
      std::ranges::find(content.ghosts, partOf(*machine_, "output_key"), &overlay::Ghost::part);
  ASSERT_NE(away, content.ghosts.end());
  EXPECT_TRUE(away->stays);
  EXPECT_NEAR(glm::length(away->apartMetres), 0.05, 1e-9);
  ASSERT_EQ(content.arrows.size(), 1U);
  EXPECT_EQ(content.arrows[0].kind, overlay::ArrowKind::kTurn);
}

/// The share of pixels in a pale shade of the reserved colour, in percent.
double palePercent(const hal::Image& image) {
  int count = 0;
  for (int y = 0; y < image.size().height; ++y) {
    const auto row = image.view().row(0, y);
    for (std::size_t i = 0; i + 3 < row.size(); i += 4) {
      const bool isPurple = row[i] > row[i + 1] + 50 && row[i + 2] > row[i + 1] + 40;
      count += isPurple && row[i + 1] > row[i] / 2 ? 1 : 0;
    }
  }
  return 100.0 * count / (image.size().width * image.size().height);
}

TEST_F(StepContentTest, TheInsetTellsLooksAndGhostsApart) {
  const auto insetOf = [&](const std::string& keys) {
    const EditedProcedure edited(keys);
    scene_ = gearboxScene();
    ProcedureFilm film({.folder = edited.path(), .step = "seat"}, scene_);
    return film.at(hal::Duration{0}, kOutput)->inset;
  };
  const hal::Image plain = insetOf(R"(motion = "none")");
  const hal::Image focus = insetOf(R"(motion = "none", show = { housing = "focus" })");
  const hal::Image tint = insetOf(R"(motion = "none", show = { housing = "tint" })");
  const hal::Image outline = insetOf(R"(motion = "none", show = { housing = "outline" })");
  const hal::Image apart = insetOf(R"(motion = "none", apart = { housing = 0.15 })");
  EXPECT_GT(reservedPercent(focus), reservedPercent(plain) + 8.0);
  EXPECT_GT(palePercent(tint), palePercent(plain) + 8.0);
  EXPECT_LT(reservedPercent(tint), reservedPercent(plain) + 4.0);
  EXPECT_GT(reservedPercent(outline), reservedPercent(plain) + 0.5);
  EXPECT_LT(reservedPercent(outline) + palePercent(outline),
            reservedPercent(plain) + palePercent(plain) + 8.0);
  EXPECT_GT(palePercent(apart), palePercent(plain) + 4.0) << "translucent, beside its place";
}

TEST_F(StepContentTest, MistakesInHowPartsAreShownAreNamed) {
  for (const char* const keys :
       {R"(show = { houzing = "tint" })", R"(show = { housing = "tinted" })",
        R"(apart = { cover = "far" })", R"(motion = "unscrews")"}) {
    const EditedProcedure edited(keys);
    EXPECT_THROW(procedure::loadProcedure(edited.path()), config::ConfigError) << keys;
  }
}

TEST_F(StepContentTest, AStepThatIsNotThereIsRefused) {
  EXPECT_THROW(contentOf("drian"), hal::Failure);
  EXPECT_THROW(contentOf("21"), hal::Failure);
  EXPECT_NO_THROW(contentOf("20"));
  EXPECT_THROW(contentOf("drain", "fr"), hal::Failure);
}

TEST_F(StepContentTest, AMachineOfOtherUnitsIsRefused) {
  procedure::Procedure procedure = procedure::loadProcedure(kFolder);
  scene::Scene scene = gearboxScene();
  scene.models.at(1).source = scene::FileSource{"gearbox.glb"};
  EXPECT_NO_THROW(putMachine(scene, 1, procedure));
  procedure.unitMetres = 0.001;
  scene.models.at(1).source = scene::FileSource{"gearbox.glb"};
  EXPECT_THROW(putMachine(scene, 1, procedure), hal::Failure);
}

TEST_F(StepContentTest, InTheStandInsPlaceAModelHasItsOwnUnits) {
  procedure::Procedure procedure = procedure::loadProcedure(kFolder);
  procedure.unitMetres = 0.001;
  scene::Scene scene = gearboxScene();
  const glm::dmat4 before = scene.models.at(1).attachFromModel;
  putMachine(scene, 1, procedure);
  const glm::dvec4 along =
      glm::inverse(before) * scene.models.at(1).attachFromModel * glm::dvec4(1.0, 0.0, 0.0, 0.0);
  EXPECT_NEAR(along.x, 0.001, 1e-12);
  EXPECT_EQ(scene.models.at(1).unitMetres, 0.001);
}

TEST_F(StepContentTest, AModelThatStandsInForAFileIsUprightAsTheFileSays) {
  procedure::Procedure procedure = procedure::loadProcedure(kFolder);
  procedure.uprightFromModel =
      glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(90.0), glm::dvec3(1.0, 0.0, 0.0)));
  const auto upIn = [&](scene::Scene scene) {
    const glm::dmat4 before = scene.models.at(1).attachFromModel;
    putMachine(scene, 1, procedure);
    return glm::dvec3(glm::inverse(before) * scene.models.at(1).attachFromModel *
                      glm::dvec4(0.0, 1.0, 0.0, 0.0));
  };
  EXPECT_NEAR(upIn(gearboxScene()).z, 1.0, 1e-12);
  scene::Scene ofFile = gearboxScene();
  ofFile.models.at(1).source = scene::FileSource{"gearbox.glb"};
  EXPECT_NEAR(upIn(ofFile).y, 1.0, 1e-12) << "the scene says its own";
}

TEST_F(StepContentTest, TheMachineIsFoundByNameOrSource) {
  const procedure::Procedure procedure = procedure::loadProcedure(kFolder);
  scene::Scene scene = gearboxScene();
  EXPECT_EQ(machineIn(scene, procedure, "auto"), 1U);
  EXPECT_EQ(machineIn(scene, procedure, "box"), 0U);
  EXPECT_THROW(machineIn(scene, procedure, "gear"), hal::Failure);
  EXPECT_THROW(machineIn({}, procedure, "auto"), hal::Failure);
  scene.models.push_back(scene.models[1]);
  EXPECT_THROW(machineIn(scene, procedure, "auto"), hal::Failure) << "there are two";
}

}  // namespace
}  // namespace pleinair::app

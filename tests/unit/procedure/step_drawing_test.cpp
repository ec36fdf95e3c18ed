// Views, composites and tiles of steps, on the processor.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "firmware_app/procedure/step_arrows.h"
#include "firmware_app/procedure/step_composite.h"
#include "firmware_app/procedure/step_tile.h"
#include "firmware_app/procedure/step_view.h"
#include "pipeline/overlay/reserved_colours.h"
#include "pipeline/procedure/procedure_file.h"
#include "pipeline/scene/builtin/builtin_gearbox.h"
#include "tests/unit/procedure/procedure_texts.h"

namespace pleinair::app {
namespace {

glm::dvec3 seen(const glm::dmat4& cameraFromWorld, const glm::dvec3& point) {
  return glm::dvec3(cameraFromWorld * glm::dvec4(point, 1.0));
}

TEST(StepView, LooksAtThePartFromItsSideWithTheMachineUpright) {
  const scene::BoundingSphere whole{.centre = {0.0, 0.0, 0.1}, .radiusMetres = 0.2};
  const scene::BoundingSphere part{.centre = {0.05, -0.1, 0.05}, .radiusMetres = 0.01};
  for (const ViewAngles& view : candidateViews()) {
    const glm::dmat4 camera = cameraFromModel(view, part, whole);
    const glm::dvec3 at = seen(camera, part.centre);
    const double halfWidth = at.z * std::tan(0.5 * kStepViewDeg * 3.14159265 / 180.0);
    EXPECT_GT(at.z, part.radiusMetres);
    EXPECT_LT(std::hypot(at.x, at.y), 0.6 * halfWidth) << "near the middle";
    const glm::dvec3 above = seen(camera, part.centre + glm::dvec3(0.0, 0.0, 0.01));
    EXPECT_LT(above.y, at.y) << "y goes down in the image";
    EXPECT_NEAR(above.x, at.x, 1e-9);
  }
  const glm::dmat4 front = cameraFromModel({.azimuthDeg = 0.0, .elevationDeg = 0.0}, part, whole);
  EXPECT_GT(seen(front, {0.1, 0.0, 0.0}).x, seen(front, {0.0, 0.0, 0.0}).x);
  EXPECT_LT(seen(front, {0.0, -0.1, 0.0}).z, seen(front, {0.0, 0.0, 0.0}).z);
}

TEST(StepView, AModelWhoseUpIsAnotherAxisStandsUpright) {
  const scene::BoundingSphere whole{.centre = {0.0, 0.1, 0.0}, .radiusMetres = 0.2};
  const scene::BoundingSphere part{.centre = {0.05, 0.05, 0.1}, .radiusMetres = 0.01};
  const glm::dmat3 zFromY(1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0);
  for (const ViewAngles& view : candidateViews()) {
    const glm::dmat4 camera = cameraFromModel(view, part, whole, zFromY);
    const glm::dvec3 at = seen(camera, part.centre);
    const glm::dvec3 above = seen(camera, part.centre + glm::dvec3(0.0, 0.01, 0.0));
    EXPECT_LT(above.y, at.y);
    EXPECT_NEAR(above.x, at.x, 1e-9);
  }
}

TEST(StepView, KeepsTheChosenParts) {
  const scene::Model gearbox = scene::gearboxModel({});
  const scene::Model chosen = withParts(gearbox, std::array<std::size_t, 2>{1, 3});
  ASSERT_EQ(chosen.parts.size(), 2U);
  EXPECT_EQ(chosen.parts[0].name, gearbox.parts[1].name);
  EXPECT_EQ(chosen.parts[1].firstTriangle, chosen.parts[0].triangleCount);
  EXPECT_EQ(chosen.parts[0].radiansPerSecond, 0.0) << "a still picture";
}

/// The middle of a picture that is 64 px of one kind in a frame of ground.
std::array<int, 3> middleOf(StepPixel pixel) {
  constexpr int kSide = 96;
  hal::Image shaded({.pixelFormat = hal::PixelFormat::kRgb8, .size = {kSide, kSide}});
  std::ranges::fill(shaded.plane(0), std::uint8_t{100});
  std::vector<StepPixel> pixels(kSide * kSide, StepPixel::kGround);
  for (int y = 16; y < 80; ++y) {
    for (int x = 16; x < 80; ++x) pixels[static_cast<std::size_t>(y * kSide + x)] = pixel;
  }
  const hal::Image image = stepComposite(shaded, pixels);
  EXPECT_EQ(image.size(), (hal::FrameSize{48, 48}));
  const auto row = image.view().row(0, 24);
  return {row[72], row[73], row[74]};
}

TEST(StepComposite, TellsPartsFromTheirSurroundings) {
  EXPECT_EQ(middleOf(StepPixel::kGround), (std::array{100, 100, 100})) << "as it is";
  const auto context = middleOf(StepPixel::kContext);
  EXPECT_GT(context[0], 150) << "pale";
  EXPECT_EQ(context[0], context[2]) << "and grey";
  const auto focus = middleOf(StepPixel::kFocus);
  EXPECT_GT(focus[0], focus[1] + 120) << "in the reserved colour";
  const auto hidden = middleOf(StepPixel::kFocusHidden);
  EXPECT_GT(hidden[0], hidden[1] + 20);
  EXPECT_NE(hidden, focus);
}

TEST(StepArrows, AStepThatMovesPartsHasArrowsInItsPicture) {
  const procedure::Procedure procedure = procedure::loadProcedure(
      std::filesystem::path(PLEINAIR_TESTS_DIR).parent_path() / "config/procedures/gearbox");
  const scene::Model& model = *procedure.model;
  const auto shownOf = [&](const char* id) {
    const procedure::Step& step = procedure.steps[*procedure.findStep(id)];
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {240, 180}});
    std::ranges::fill(image.plane(0), std::uint8_t{255});
    const scene::BoundingSphere whole = scene::boundingSphere(model);
    drawArrows(image, arrowsOf(step, model), model,
               cameraFromModel(candidateViews().front(), whole, whole), stepCamera(image.size()),
               1.0);
    int count = 0;
    for (std::size_t i = 0; i + 2 < image.plane(0).size(); i += 3) {
      count += image.plane(0)[i + 1] == overlay::kReservedRgb[1] ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(shownOf("drain"), 50);
  EXPECT_GT(shownOf("cover_off"), 50);
  EXPECT_EQ(shownOf("as_found"), 0) << "nothing is moved";
}

TEST(StepArrows, GoAlongTheStepsAxis) {
  const scene::Model model = scene::gearboxModel({.isClosed = true});
  procedure::Step step;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (model.parts[i].name == "cover_bolt_1") step.removes = {i};
  }
  ASSERT_EQ(step.removes.size(), 1U);
  const scene::BoundingSphere whole = scene::boundingSphere(model);
  // The place of the middle of all that is drawn.
  const auto middle = [&] {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {240, 180}});
    std::ranges::fill(image.plane(0), std::uint8_t{255});
    drawArrows(image, arrowsOf(step, model), model,
               cameraFromModel({.azimuthDeg = 0.0, .elevationDeg = 0.0}, whole, whole),
               stepCamera(image.size()), 1.0);
    glm::dvec2 sum(0.0);
    double count = 0.0;
    for (int y = 0; y < 180; ++y) {
      for (int x = 0; x < 240; ++x) {
        const auto at = static_cast<std::size_t>(3 * (y * 240 + x));
        if (image.plane(0)[at + 1] != overlay::kReservedRgb[1]) continue;
        sum += glm::dvec2(x, y);
        count += 1.0;
      }
    }
    EXPECT_GT(count, 20.0);
    return sum / std::max(count, 1.0);
  };
  const glm::dvec2 up = middle();
  step.axis = {0.0, 0.0, -1.0};
  const glm::dvec2 down = middle();
  step.axis = {1.0, 0.0, 0.0};
  const glm::dvec2 right = middle();
  step.axis = {-1.0, 0.0, 0.0};
  const glm::dvec2 left = middle();
  EXPECT_GT(down.y, up.y + 5.0) << "y goes down in the image";
  EXPECT_GT(right.x, left.x + 5.0);
  EXPECT_LT(up.y, right.y);
}

TEST(StepTile, IsAsHighAsItsText) {
  const auto reading = procedure::readSteps(
      "[[step]]\nid = \"a\"\n[[step]]\nid = \"b\"\ncheck = \"yes_no\"\ntorque = \"5 Nm\"\n",
      {"a", "b"}, "? Is everything as it was before, and is nothing left over?");
  const procedure::Procedure& procedure = reading.procedure;
  const int plain = stepTextRows(procedure, 0, "en", 480);
  const int full = stepTextRows(procedure, 1, "en", 480);
  EXPECT_GT(plain, 20);
  EXPECT_GT(full, plain + 40);
  EXPECT_GT(stepTextRows(procedure, 1, "en", 200), full) << "wrapped";
  hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {480, 20}});
  const hal::Image tile = stepTile(procedure, 1, "en", picture, {}, full);
  EXPECT_EQ(tile.size(), (hal::FrameSize{480, 20 + full}));
  int inked = 0;
  for (const std::uint8_t byte : tile.view().row(0, 20 + full / 2)) inked += byte < 128 ? 1 : 0;
  for (const std::uint8_t byte : tile.view().row(0, 36)) inked += byte < 128 ? 1 : 0;
  EXPECT_GT(inked, 0);
}

TEST(StepTile, HasItsMovieAndPicturesBelowTheText) {
  const auto readWith = [](const std::string& keys) {
    return procedure::readSteps("[[step]]\nid = \"a\"\n" + keys, {"a"}, "").procedure;
  };
  const procedure::Procedure plain = readWith("");
  const procedure::Procedure moving = readWith("movie = \"plug.mp4\"\n");
  const int rows = stepTextRows(moving, 0, "en", 200);
  EXPECT_EQ(rows, stepTextRows(plain, 0, "en", 200) + kIllustrationRows + 10);
  const hal::Image picture({.pixelFormat = hal::PixelFormat::kRgb8, .size = {200, 20}});
  const hal::Image dark({.pixelFormat = hal::PixelFormat::kRgb8, .size = {150, kIllustrationRows}});
  const std::vector<hal::Image> both{dark, dark};  // the second one is cut at the border
  const hal::Image tile = stepTile(moving, 0, "en", picture, both, rows);
  const auto row = tile.view().row(0, 20 + rows - kIllustrationRows / 2);
  EXPECT_EQ(row[3 * 50], 0);
  EXPECT_EQ(row[3 * 165], 255) << "between them";
  EXPECT_EQ(row[3 * 199], 0);
}

}  // namespace
}  // namespace pleinair::app

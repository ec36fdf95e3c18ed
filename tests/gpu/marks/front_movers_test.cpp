// A virtual model is hidden by what moves before it, as far as that is known: what covers the place
// where the model stands, and all that hangs together with it.
#include "pipeline/marks/movers/front_movers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/scene/render/model_hiding.h"
#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/gpu/marks/wall_and_disc.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using Place = std::function<bool(glm::dvec2 px)>;

Place disc(glm::dvec2 middle, double radius) {
  return [=](glm::dvec2 px) { return glm::distance(px, middle) < radius; };
}
Place box(glm::dvec2 low, glm::dvec2 high) {
  return [=](glm::dvec2 px) {
    return px.x >= low.x && px.y >= low.y && px.x < high.x && px.y < high.y;
  };
}

class FrontMoversTest : public AnchorLife {
 protected:
  void SetUp() override {
    AnchorLife::SetUp();
    if (IsSkipped()) return;
    layers_.emplace(library_, kSize);
    hiding_.emplace(library_);
  }

  /// A box that is raised by so much above z = 0, where its footprint is some 72 px wide.
  void useBox(double raisedMetres) {
    scene::Scene scene = boxScene();
    scene.models[0].attachFromModel = glm::translate(glm::dmat4(1.0), {0.0, 0.0, -raisedMetres});
    useScene(scene);
  }

  /// A frame in which an orange thing moves before the wall, where `mover` says.
  void see(const Place& mover, const tracking::ImageMotion& motion = panning(0.0, 0.0)) {
    hal::Image image = seen({}, kSize, ++seed_);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (!mover(glm::dvec2(x, y) + 0.5)) continue;
        std::uint8_t* p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        p[0] = 240;
        p[1] = 120;
        p[2] = 20;
      }
    }
    picture_ = support::textureOf(image.view());
    const scene::ArFrame frame =
        compose(*renderer_, boxAt(160.0), seed_ == 1 ? tracking::ImageMotion{} : motion);
    field_->update(frame);
    layers_->update(frame, *field_, options_);
    drawn_ = support::readR32ui(*frame.ids);
    ASSERT_TRUE(layers_->cover());
    hiding_->hide(frame, *layers_->cover());
    ids_ = support::readR32ui(*frame.ids);
    forms_ = support::readR32ui(*frame.forms);
    colour_ = support::readRgba8(*frame.colour);
    camera_ = support::readRgba8(*frame.cameraColour);
    labels_ = support::readRgba32f(layers_->labels());
  }
  void seeNothing(int frames) {
    for (int i = 0; i < frames; ++i) see([](glm::dvec2) { return false; });
  }

  /// The share of the model's pixels in a place that are hidden.
  double hiddenIn(const Place& place) const {
    int model = 0;
    int hidden = 0;
    for (std::size_t i = 0; i < drawn_.size(); ++i) {
      const auto at = static_cast<int>(i);
      if (drawn_[i] == 0 || !place(glm::dvec2(at % kSize.width, at / kSize.width) + 0.5)) continue;
      ++model;
      hidden += ids_[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(model, 100);
    return static_cast<double>(hidden) / std::max(model, 1);
  }

  /// How often the hidden parts are drawn.
  std::uint32_t drawsOfHidden() const {
    std::array<std::uint32_t, 4> command{};
    EXPECT_TRUE(layers_->cover()->command->read(std::as_writable_bytes(std::span(command))));
    EXPECT_EQ(command[0], 3U);
    return command[1];
  }

  /// The number of cells of the model, hidden or not, that count as movers.
  int moversOnModel() const {
    const hal::FrameSize cells = layers_->labels().size();
    int found = 0;
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        constexpr int kSide = MotionLayers::kCellPixels;
        const int pixel = (kSide * y + kSide / 2) * kSize.width + kSide * x + kSide / 2;
        if (drawn_[static_cast<std::size_t>(pixel)] == 0) continue;
        found += labels_[4 * static_cast<std::size_t>(y * cells.width + x)] > 0.5F ? 1 : 0;
      }
    }
    return found;
  }

  MotionLayersOptions options_;
  std::optional<MotionLayers> layers_;
  std::optional<scene::ModelHiding> hiding_;
  std::vector<std::uint32_t> drawn_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> forms_;
  hal::Image colour_;
  hal::Image camera_;
  std::vector<float> labels_;
  unsigned seed_ = 0;
};

constexpr glm::dvec2 kMiddle{160.0, 118.0};
// Its outline reaches 120 px to each side then, the footprint, which is around its bounding
// sphere, 51.
constexpr double kRaised = 0.35;

TEST_F(FrontMoversTest, WhatCoversTheFootprintHidesTheModel) {
  useBox(0.0);
  seeNothing(6);
  EXPECT_EQ(hiddenIn(disc(kMiddle, 200.0)), 0.0);
  EXPECT_EQ(drawsOfHidden(), 0U);
  for (int i = 0; i < 3; ++i) see(disc(kMiddle + glm::dvec2(3.0 * i, 0.0), 22.0));
  EXPECT_EQ(drawsOfHidden(), 1U);
  const glm::dvec2 hand = kMiddle + glm::dvec2(6.0, 0.0);
  EXPECT_GT(hiddenIn(disc(hand, 20.0)), 0.98);
  const Place around = disc(hand, 25.0);
  EXPECT_LT(hiddenIn([&](glm::dvec2 px) { return !around(px); }), 0.01) << "and nothing else is";
  for (std::size_t i = 0; i < ids_.size(); ++i) {
    if (drawn_[i] == 0 || ids_[i] != 0) continue;
    ASSERT_EQ(forms_[i], 0U) << i;
    for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
      ASSERT_EQ(colour_.plane(0)[c], camera_.plane(0)[c]) << i;
    }
  }
  seeNothing(1);
  EXPECT_EQ(hiddenIn(disc(kMiddle, 200.0)), 0.0) << "it is back as soon as the hand has gone";
  EXPECT_EQ(drawsOfHidden(), 0U);
}

TEST_F(FrontMoversTest, WhatPassesBehindStaysBehind) {
  useBox(kRaised);
  seeNothing(6);
  for (int i = 0; i < 6; ++i) {
    const Place beside = disc(kMiddle + glm::dvec2(90.0, 4.0 * i - 12.0), 16.0);
    see(beside);
    EXPECT_EQ(hiddenIn(beside), 0.0) << i;
    EXPECT_EQ(moversOnModel(), 0) << "marks of the model are no mover's";
  }
}

TEST_F(FrontMoversTest, AnArmGoesWithItsHand) {
  useBox(kRaised);
  seeNothing(6);
  for (int i = 0; i < 4; ++i) see(box({kMiddle.x - 4.0 * i, 100.0}, {320.0, 130.0}));
  EXPECT_GT(hiddenIn(box({kMiddle.x, 104.0}, {270.0, 126.0})), 0.98);
  // The hand draws back from the footprint and stays before the model.
  const Place forearm = box({240.0, 100.0}, {320.0, 130.0});
  see(forearm);
  EXPECT_GT(hiddenIn(box({244.0, 104.0}, {270.0, 126.0})), 0.98);
  for (float t = 0.0F; t < FrontMovers::kStaysSeconds + 0.1F; t += 0.1F) {
    time_ += std::chrono::milliseconds(67);
    see(forearm);
  }
  EXPECT_EQ(hiddenIn(box({244.0, 104.0}, {270.0, 126.0})), 0.0)
      << "after a while it may be anywhere";
}

TEST_F(FrontMoversTest, AHandThatRestsStaysBeforeTheModel) {
  useBox(0.0);
  options_.restBeforeModels = std::chrono::seconds(6);
  seeNothing(6);
  const auto restFor = [&](double seconds) {
    for (double t = 0.0; t < seconds; t += 0.1) {
      time_ += std::chrono::milliseconds(67);
      see(disc(kMiddle, 22.0));
    }
    return hiddenIn(disc(kMiddle, 20.0));
  };
  for (int i = 0; i < 10; ++i) see(disc(kMiddle + glm::dvec2(10.0 - i, 0.0), 22.0));
  EXPECT_GT(restFor(5.0), 0.98) << "elsewhere it would have joined the background";
  EXPECT_EQ(restFor(2.0), 0.0);
}

TEST_F(FrontMoversTest, NoneAreFoundWhileTheCameraMoves) {
  useBox(0.0);
  seeNothing(6);
  for (int i = 0; i < 3; ++i) see(disc(kMiddle, 22.0), panning(0.01, 0.0));
  EXPECT_EQ(hiddenIn(disc(kMiddle, 20.0)), 0.0);
}

}  // namespace
}  // namespace pleinair::marks

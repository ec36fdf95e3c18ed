#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "tests/gpu/marks/marks_fixture.h"
#include "tests/gpu/scene/moving_models.h"

namespace pleinair::marks {

inline constexpr glm::ivec2 kGrid{40, 30};
inline constexpr int kCellPixels = 8;

inline tracking::ImageMotion following(const glm::dmat3& currentFromPrevious) {
  return {.picture = tracking::ImageHomography{.currentFromPrevious = currentFromPrevious,
                                               .errorPx = 0.01}};
}
inline tracking::ImageMotion panning(double x, double y) {
  return following({1, 0, 0, 0, 1, 0, x, y, 1});
}
inline tracking::ImageMotion zooming(double factor) {
  return following({factor, 0, 0, 0, factor, 0, 160.0 * (1.0 - factor), 120.0 * (1.0 - factor), 1});
}

class AnchorLife : public MarksTest {
 protected:
  static constexpr float kIn = 33.0F / 300.0F;
  static constexpr float kOut = 33.0F / 200.0F;
  static constexpr float kRounding = 1e-5F;

  void SetUp() override {
    MarksTest::SetUp();
    if (IsSkipped()) return;
    useScene({});
  }

  void useScene(const scene::Scene& scene) {
    renderer_.emplace(library_, scene);
    field_.emplace(library_, kSize);
    set_.emplace(library_, kSize, AnchorOptions{});
  }

  void advance(const tracking::ImageMotion& motion, const scene::PoseSet& poses = {}) {
    const scene::ArFrame frame = compose(*renderer_, poses, motion);
    field_->update(frame);
    set_->advance(frame, *field_, hold_);
  }
  std::vector<Anchor> next(const tracking::ImageMotion& motion, const scene::PoseSet& poses = {}) {
    advance(motion, poses);
    return set_->read();
  }

  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
  std::optional<AnchorSet> set_;
  AnchorHold hold_;
};

inline bool isWithin(glm::vec2 px, float border) {
  return px.x >= border && px.y >= border && px.x < 320.0F - border && px.y < 240.0F - border;
}

inline int births(const std::vector<Anchor>& anchors, float border = 0.0F) {
  return static_cast<int>(std::ranges::count_if(anchors, [&](const Anchor& each) {
    return each.isAlive() && each.isBorn() && isWithin(each.px, border);
  }));
}

/// The number of staying anchors in each cell, row by row; on `objects` or in the picture.
inline std::vector<int> cellCounts(const std::vector<Anchor>& anchors, bool objects = false) {
  std::vector<int> counts(static_cast<std::size_t>(kGrid.x * kGrid.y));
  for (const Anchor& each : anchors) {
    if (!each.isStaying() || !isWithin(each.px, 0.0F) || (each.surface != 0) != objects) continue;
    const glm::ivec2 cell(each.px / static_cast<float>(kCellPixels));
    ++counts.at(static_cast<std::size_t>(cell.y * kGrid.x + cell.x));
  }
  return counts;
}

/// Watches that no anchor's fade jumps, from its birth to its end.
class FadeWatch {
 public:
  FadeWatch(float in, float out) : in_(in), out_(out) {}
  void add(const std::vector<Anchor>& anchors) {
    if (before_.empty()) before_ = anchors;
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& was = before_[slot];
      const Anchor& is = anchors[slot];
      const bool isSame = was.isAlive() && is.isAlive() && was.seed == is.seed;
      if (isSame) {
        risen_ = std::max(risen_, is.fade - was.fade);
        fallen_ = std::max(fallen_, was.fade - is.fade);
        continue;
      }
      // Marks may enter and leave at the border without fading.
      if (is.isAlive() && isWithin(is.px, 4.0F)) risen_ = std::max(risen_, is.fade);
      if (was.isAlive() && isWithin(was.px, 4.0F)) fallen_ = std::max(fallen_, was.fade);
      if (was.isAlive()) ++ended_;
    }
    before_ = anchors;
  }
  void expectNoPop() const {
    EXPECT_LE(risen_, in_ + 1e-5F);
    EXPECT_LE(fallen_, out_ + 1e-5F);
  }
  int ended() const { return ended_; }

 private:
  float in_;
  float out_;
  std::vector<Anchor> before_;
  float risen_ = 0.0F;
  float fallen_ = 0.0F;
  int ended_ = 0;
};

inline scene::Scene boxScene() {
  scene::Scene scene;
  scene::SceneModel box;
  box.source = scene::BoxSource{{0.12, 0.12, 0.01}};
  box.model = std::make_shared<const scene::Model>(scene::modelOf(box.source).value());
  scene.models.push_back(std::move(box));
  return scene;
}

/// The box's front, some 72 px wide, with its middle at this px of the picture.
inline scene::PoseSet boxAt(double x) {
  return {.cameraFromWorld =
              glm::translate(glm::dmat4(1.0), {(x - 162.0) / 300.0 * 0.5, 0.0, 0.5})};
}

}  // namespace pleinair::marks

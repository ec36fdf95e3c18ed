#pragma once

#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/marks_fixture.h"
#include "tests/gpu/marks/motion_questions.h"
#include "tests/oracles/feature_motion_oracle.h"

namespace pleinair::marks {

/// Asks a field whose motion the test makes up about single points.
class ImageMotionTest : public MarksTest {
 protected:
  void SetUp() override {
    MarksTest::SetUp();
    if (IsSkipped()) return;
    library_.add(MotionQuestions::kShaders);
    questions_.emplace(library_);
    renderer_.emplace(library_, scene::Scene{});
    field_.emplace(library_, kSize);
    update({});
  }

  void update(const tracking::ImageMotion& motion, const scene::PoseSet& poses = {}) {
    field_->update(compose(*renderer_, poses, motion));
  }
  std::vector<MotionAnswer> ask(const std::vector<glm::dvec2>& points, float layer = 0.0F) {
    std::vector<MotionQuestion> questions;
    for (const glm::dvec2 px : points) questions.push_back({.px = glm::vec2(px), .layer = layer});
    return questions_->ask(*field_, questions);
  }
  MotionAnswer askOne(glm::dvec2 px, float layer = 0.0F) { return ask({px}, layer).front(); }

  void useScene(scene::Scene scene) {
    renderer_.emplace(library_, scene);
    field_->reset();
  }

  glm::dvec2 anywhere(double border = 0.0) {
    std::uniform_real_distribution<double> x(border, kSize.width - border);
    std::uniform_real_distribution<double> y(border, kSize.height - border);
    return {x(random_), y(random_)};
  }
  double within(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  std::mt19937 random_{7};
  std::optional<MotionQuestions> questions_;
  std::optional<scene::ArFrameRenderer> renderer_;
  std::optional<MotionField> field_;
};

inline std::vector<tracking::FeatureMotion> told(std::span<const oracles::FeatureStep> steps,
                                                 float errorPx = 0.05F) {
  std::vector<tracking::FeatureMotion> features;
  for (const oracles::FeatureStep& each : steps) {
    features.push_back({.id = static_cast<std::uint32_t>(features.size()),
                        .previous = glm::vec2(each.then),
                        .current = glm::vec2(each.now),
                        .errorPx = errorPx});
  }
  return features;
}

/// As the shader is given it: in single precision.
inline glm::dvec2 single(glm::dvec2 px) {
  return glm::dvec2(glm::vec2(px));
}
inline oracles::FeatureStep rounded(const oracles::FeatureStep& step) {
  return {single(step.then), single(step.now)};
}

inline void expectMotion(const MotionAnswer& answer, const oracles::PointMotion& expected,
                         double tolerancePx, double tolerance, const std::string& where) {
  EXPECT_LT(glm::distance(glm::dvec2(answer.displacement), expected.displacement), tolerancePx)
      << where;
  for (int column = 0; column < 2; ++column) {
    EXPECT_LT(glm::distance(glm::dvec2(answer.jacobian[column]), expected.jacobian[column]),
              tolerance)
        << where << ", column " << column;
  }
}

}  // namespace pleinair::marks

// How a stroke's directions hold on to their past: the mean in the doubled angle, against the CPU.
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <gmock/gmock.h>

#include "pipeline/marks/marks_shaders.h"
#include "tests/oracles/stroke_oracle.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

constexpr std::array<gpu::EmbeddedShader, 1> kShaders{
    {{"tests/held_directions.comp",
      "#include \"pipeline/marks/strokes/shaders/stroke_history.glsl\"\n"
      "layout(local_size_x = 64) in;\n"
      "struct Question { vec4 nowWas; vec4 jacobian; vec4 stays; };\n"
      "layout(std430, binding = 0) readonly buffer Questions { Question questions[]; };\n"
      "layout(std430, binding = 1) writeonly buffer Answers { vec2 answers[]; };\n"
      "void main() {\n"
      "  uint i = gl_GlobalInvocationID.x;\n"
      "  if (i >= uint(questions.length())) return;\n"
      "  Question asked = questions[i];\n"
      "  answers[i] = heldDirection(asked.nowWas.xy, asked.nowWas.zw, asked.jacobian, "
      "asked.stays.x);\n"
      "}\n"}}};

struct Question {
  glm::vec2 now{1.0F, 0.0F};
  glm::vec2 was{1.0F, 0.0F};
  glm::vec4 jacobian{1.0F, 0.0F, 0.0F, 1.0F};
  glm::vec4 stays{0.95F, 0.0F, 0.0F, 0.0F};
};

glm::vec2 directionOf(double degrees) {
  const double radians = degrees * std::numbers::pi / 180.0;
  return {std::cos(radians), std::sin(radians)};
}

/// Between lines, in degrees.
double apart(glm::dvec2 a, glm::dvec2 b) {
  const double across = std::abs(a.x * b.y - a.y * b.x);
  return std::atan2(across, std::abs(glm::dot(a, b))) * 180.0 / std::numbers::pi;
}

class StrokeHistory : public support::GlTest {
 protected:
  std::vector<glm::vec2> answersTo(const std::vector<Question>& questions) {
    gpu::ShaderLibrary library;
    library.add(gpu::marksShaders());
    library.add(kShaders);
    const gpu::Buffer asked = gpu::Buffer::of(std::span(questions));
    const gpu::Buffer answers(questions.size() * sizeof(glm::vec2), gpu::BufferUsage::kDynamic);
    gpu::Program program = library.compute("tests/held_directions.comp");
    program.use()
        .storage("Questions", asked)
        .storage("Answers", answers)
        .dispatch({static_cast<int>(questions.size()), 1}, GL_BUFFER_UPDATE_BARRIER_BIT);
    return support::readBuffer<glm::vec2>(answers);
  }
  glm::vec2 answerTo(const Question& question) { return answersTo({question}).front(); }
};

TEST_F(StrokeHistory, IsTheMeanInTheDoubledAngle) {
  std::vector<Question> questions;
  for (int now = 0; now < 360; now += 15) {
    for (const double was : {10.0, 57.0, 201.0}) {
      for (const float stays : {0.05F, 0.5F, 0.95F}) {
        questions.push_back(
            {.now = directionOf(now), .was = directionOf(was), .stays = glm::vec4(stays)});
      }
    }
  }
  const std::vector<glm::vec2> answers = answersTo(questions);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const Question& each = questions[i];
    const glm::dvec2 expected = oracles::averagedDirection(each.now, each.was, each.stays.x);
    EXPECT_LT(apart(answers[i], expected), 0.05) << each.now.x << "," << each.now.y;
    EXPECT_NEAR(glm::length(answers[i]), 1.0, 1e-5);
    EXPECT_GE(glm::dot(answers[i], each.was), 0.0F) << "it stays on the past's side";
  }
}

/// Averaging vectors with signs would leave nothing of these.
TEST_F(StrokeHistory, ADirectionThatFlipsItsSignHasNotTurned) {
  const glm::vec2 was = directionOf(33.0);
  for (const float stays : {0.0F, 0.5F, 0.95F}) {
    const glm::vec2 held = answerTo({.now = -was, .was = was, .stays = glm::vec4(stays)});
    EXPECT_LT(glm::distance(held, was), 1e-5F) << stays;
  }
}

/// tan δ(t) = tan 80° e^(−t/τ), at any frame rate, and never by more than 1/(2τ).
TEST_F(StrokeHistory, ATurnBy80DegreesFollowsTheClosedForm) {
  constexpr double kSeconds = 1.5;
  constexpr double kTau = 0.65;
  const glm::vec2 now = directionOf(80.0);
  for (const int frames : {5, 45, 180}) {
    const auto stays = static_cast<float>(std::exp(-kSeconds / frames / kTau));
    glm::vec2 held = directionOf(0.0);
    double quickest = 0.0;
    for (int i = 0; i < frames; ++i) {
      const glm::vec2 next = answerTo({.now = now, .was = held, .stays = glm::vec4(stays)});
      quickest = std::max(quickest, apart(held, next) * frames / kSeconds);
      held = next;
    }
    const double left =
        std::atan(std::tan(80.0 * std::numbers::pi / 180.0) * std::exp(-kSeconds / kTau)) * 180.0 /
        std::numbers::pi;
    EXPECT_NEAR(apart(held, now), left, 0.05) << frames;
    EXPECT_LT(quickest, 180.0 / std::numbers::pi / (2.0 * kTau) + 0.5) << frames;
  }
}

/// Told of a roll of 30° a second, it does not lag; untold, by sin 2δ = 2 ω τ.
TEST_F(StrokeHistory, ARollDoesNotLagWhereItIsTold) {
  constexpr double kTau = 0.65;
  constexpr double kStep = 1.0;  // degrees in 1/30 s
  const auto stays = static_cast<float>(std::exp(-1.0 / 30.0 / kTau));
  const glm::vec2 turn = directionOf(kStep);
  const auto lagOf = [&](const glm::vec4& jacobian) {
    glm::vec2 held = directionOf(0.0);
    int i = 0;
    while (i < 240) {
      held = answerTo({.now = directionOf(++i * kStep),
                       .was = held,
                       .jacobian = jacobian,
                       .stays = glm::vec4(stays)});
    }
    return apart(held, directionOf(i * kStep));
  };
  EXPECT_LT(lagOf({turn.x, turn.y, -turn.y, turn.x}), 0.01);
  const double omega = 30.0 * std::numbers::pi / 180.0;
  const double untold = 0.5 * std::asin(2.0 * omega * kTau) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(lagOf({1.0F, 0.0F, 0.0F, 1.0F}), untold, 1.0) << "the control";
}

/// A stroke seen edge-on has no direction left, so it takes the frame's.
TEST_F(StrokeHistory, WhereNothingIsLeftOfThePastTheFrameSays) {
  const glm::vec2 now = directionOf(40.0);
  const glm::vec2 held = answerTo({.now = now, .jacobian = glm::vec4(0.0F)});
  EXPECT_LT(glm::distance(held, now), 1e-5F);
}

}  // namespace
}  // namespace pleinair::marks

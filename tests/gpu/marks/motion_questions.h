#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>

#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/marks/motion_field.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {

/// A query to shaders/image_motion.glsl.
struct MotionQuestion {
  glm::vec2 px{0.0F};
  float layer = 0.0F;     ///< the real object that px is on, or 0
  float backward = 0.0F;  ///< 1: how what is at px came there; needs the backward flow
};

struct MotionAnswer {
  glm::vec2 displacement{0.0F};
  float errorPx = 0.0F;
  float source = 0.0F;
  glm::mat2 jacobian{1.0F};

  MotionSource from() const { return static_cast<MotionSource>(static_cast<unsigned>(source)); }
};

/// Asks single points on the GPU, as styles do.
class MotionQuestions {
 public:
  static constexpr std::array<gpu::EmbeddedShader, 1> kShaders{
      {{"tests/motion_questions.comp",
        "#include \"pipeline/marks/shaders/image_motion.glsl\"\n"
        "layout(local_size_x = 64) in;\n"
        "struct Answer { vec2 displacement; float error; float source; vec4 jacobian; };\n"
        "layout(std430, binding = 0) readonly buffer Questions { vec4 questions[]; };\n"
        "layout(std430, binding = 1) writeonly buffer Answers { Answer answers[]; };\n"
        "uniform int count;\n"
        "void main() {\n"
        "  int i = int(gl_GlobalInvocationID.x);\n"
        "  if (i >= count) return;\n"
        "  vec4 asked = questions[i];\n"
        "  Moved moved = imageMotionAt(asked.xy, asked.z, asked.w != 0.0);\n"
        "  answers[i] = Answer(moved.displacement, moved.error, "
        "float(moved.source & kSourceBits), turnOf(moved, asked.xy, asked.w != 0.0));\n"
        "}\n"}}};

  /// `library` has kShaders.
  explicit MotionQuestions(const gpu::ShaderLibrary& library)
      : program_(library.compute("tests/motion_questions.comp")) {}

  std::vector<MotionAnswer> ask(const MotionField& field,
                                const std::vector<MotionQuestion>& questions) {
    gpu::Buffer asked(questions.size() * sizeof(MotionQuestion), gpu::BufferUsage::kDynamic);
    const gpu::Buffer answers(questions.size() * sizeof(MotionAnswer), gpu::BufferUsage::kDynamic);
    asked.write(std::as_bytes(std::span(questions)));
    program_.use().storage("Questions", asked).storage("Answers", answers);
    field.bind(program_);
    program_.set("count", static_cast<int>(questions.size()))
        .dispatch({static_cast<int>(questions.size()), 1}, GL_BUFFER_UPDATE_BARRIER_BIT);
    return support::readBuffer<MotionAnswer>(answers);
  }

 private:
  gpu::Program program_;
};

}  // namespace pleinair::marks

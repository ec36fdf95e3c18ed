// Full-screen passes in their compute form paint what their fragment shaders do.
#include "pipeline/gpu/programs/pass_form.h"

#include <cstdlib>
#include <variant>

#include <gtest/gtest.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/gpu/context/egl_context.h"
#include "tests/gpu/painter/painter_fixture.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kPictureSize{318, 238};
constexpr int kFramesOfForm = 6;
constexpr int kRounding = 3;  // levels
// A stroke or cell whose rounded values differ is painted elsewhere.
constexpr double kMaxDifferingShare = 0.03;

class PassFormTest : public PainterTest, public testing::WithParamInterface<const char*> {
 protected:
  /// The last of some frames of the workbench.
  static std::vector<std::uint8_t> paintedAs(gpu::PassForm form) {
    hal::SteppedClock clock;
    hal::SyntheticCamera camera({.size = kPictureSize}, clock);
    hal::orThrow(camera.start({}));
    Painter painter({.pictureSize = kPictureSize, .style = GetParam(), .passForm = form});
    std::vector<std::uint8_t> last;
    for (int i = 0; i < kFramesOfForm; ++i) {
      hal::NextFrame next = camera.next(hal::kNoDeadline);
      last = painted(painter, std::get<hal::CapturedFrame>(std::move(next)));
    }
    return last;
  }
};

bool hasComputeForm() {
  const gpu::EglContext context;
  return gpu::hasComputeForm();
}

double shareOfDifferingBytes(const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.size(); ++i) others += std::abs(a[i] - b[i]) > kRounding ? 1 : 0;
  return static_cast<double>(others) / static_cast<double>(a.size());
}

TEST_P(PassFormTest, BothPaintTheSame) {
  if (!hasComputeForm()) GTEST_SKIP() << "this GPU's images have few formats (GL_NV_image_formats)";
  const std::vector<std::uint8_t> fragments = paintedAs(gpu::PassForm::kFragment);
  const std::vector<std::uint8_t> computed = paintedAs(gpu::PassForm::kCompute);
  ASSERT_EQ(fragments.size(), computed.size());
  EXPECT_LT(shareOfDifferingBytes(fragments, computed), kMaxDifferingShare);
}

INSTANTIATE_TEST_SUITE_P(Styles, PassFormTest,
                         testing::Values("painterly", "watercolor", "hatching"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
}  // namespace pleinair

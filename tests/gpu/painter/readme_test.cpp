// The program in README.md, run as it stands there.
#include <optional>

#include "tests/gpu/painter/painter_fixture.h"

namespace {

class ReadmeTest : public pleinair::PainterTest {
 protected:
  std::optional<pleinair::hal::CapturedFrame> nextFrameOfMyCamera() {
    if (number_ == 2) return std::nullopt;
    return pleinair::testFrame(number_++, {640, 360});
  }
  static void complain(const std::string& message) { FAIL() << message; }
  void show(const pleinair::hal::Image& image) {
    ++shown_;
    EXPECT_EQ(image.size(), (pleinair::hal::FrameSize{1280, 720}));
  }
  void run() {
#include "readme_program.inc"
    while (hal::orThrow(painter.wait(readback, picture))) show(picture.image);
  }

  int number_ = 0;
  int shown_ = 0;
};

TEST_F(ReadmeTest, ProgramPaints) {
  run();
  EXPECT_EQ(shown_, 2);
}

}  // namespace

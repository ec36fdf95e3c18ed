#include "pipeline/gpu/frame_upload.h"

#include <random>

#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using testing_support::GlTest;
using testing_support::readRgba8;

class FrameUploaderTest : public GlTest {};

TEST_F(FrameUploaderTest, PassesRgbThroughUnchanged) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {7, 5}});
  std::mt19937 random(1);
  for (auto& byte : image.plane(0)) byte = static_cast<std::uint8_t>(random());
  const ShaderLibrary library;
  FrameUploader uploader(library);
  hal::Image back = readRgba8(uploader.upload(image.view(), {7, 5}));
  for (int y = 0; y < 5; ++y) {
    for (std::size_t x = 0; x < 7; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(back.row(0, y)[x * 4 + c], image.row(0, y)[x * 3 + c]) << x << "," << y;
      }
    }
  }
}

}  // namespace
}  // namespace pleinair::gpu

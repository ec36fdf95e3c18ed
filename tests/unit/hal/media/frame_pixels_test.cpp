#include "hal/media/frame_pixels.h"

#include <algorithm>
#include <array>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/turned_pictures.h"

namespace pleinair::hal::libav {
namespace {

/// Grey columns from dark to light with neutral chroma, and the display matrix of `orientation`.
std::shared_ptr<const AVFrame> columnsYuyv(int width, int height, std::size_t orientation) {
  Frame frame = makeFrame();
  frame->format = AV_PIX_FMT_YUYV422;
  frame->width = width;
  frame->height = height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  for (int y = 0; y < height; ++y) {
    std::uint8_t* row = frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0];
    for (int x = 0; x < width; ++x) {
      row[2 * x] = static_cast<std::uint8_t>(40 + 20 * x);
      row[2 * x + 1] = 128;
    }
  }
  const auto matrix = support::displayMatrix(support::kOrientations.at(orientation - 1).matrix);
  AVFrameSideData* side =
      av_frame_new_side_data(frame.get(), AV_FRAME_DATA_DISPLAYMATRIX, sizeof(matrix));
  if (side == nullptr) throw std::bad_alloc();
  std::ranges::copy(std::as_bytes(std::span(matrix)), reinterpret_cast<std::byte*>(side->data));
  return frame;
}

TEST(FramePixels, TurnedYuyvComesAsRgb) {
  const Result<LentPicture> picture = lendPicture(columnsYuyv(8, 2, 6));
  ASSERT_TRUE(picture) << picture.error().message();
  const ImageView& view = picture->view;
  ASSERT_EQ(view.format.pixelFormat, PixelFormat::kRgb8);
  ASSERT_EQ(view.format.size, (FrameSize{2, 8}));
  for (int y = 0; y + 1 < 8; ++y) EXPECT_LT(view.row(0, y)[0], view.row(0, y + 1)[0]) << y;
}

TEST(FramePixels, UprightFramesAreLentWithoutACopy) {
  const std::shared_ptr<const AVFrame> frame = columnsYuyv(8, 2, 1);
  const Result<LentPicture> picture = lendPicture(frame);
  ASSERT_TRUE(picture) << picture.error().message();
  EXPECT_EQ(picture->view.format.pixelFormat, PixelFormat::kYuyv);
  EXPECT_EQ(picture->view.planes[0].bytes.data(), frame->data[0]);
}

}  // namespace
}  // namespace pleinair::hal::libav

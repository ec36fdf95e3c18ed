#include "pipeline/measure/input/moved_photograph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {
namespace {

/// Largest number of the photograph's pixels per pixel of a frame, along a side; more would alias.
constexpr double kMaxSamples = 2.0;

bool turnsOrZooms(const PhotographMotion& motion) {
  return motion.zoomPercent != 0 || motion.rollDegrees != 0;
}

std::string describe(const PhotographMotion& motion) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (motion.zoomPercent != 0) add(fmt::format("zoom by {:g} %", motion.zoomPercent));
  if (motion.rollDegrees != 0) add(fmt::format("roll by {:g}°", motion.rollDegrees));
  if (motion.pan != cv::Point2d()) {
    add(fmt::format("pan by ({:g}, {:g}) px", motion.pan.x, motion.pan.y));
  }
  return text + " a frame";
}

/// Size of an image that contains all frames, in px of frame 0, about its centre.
cv::Size2d extentOf(const PhotographMotion& motion, hal::FrameSize size, std::uint64_t frames) {
  cv::Size2d half;
  const cv::Point2d middle((size.width - 1) / 2.0, (size.height - 1) / 2.0);
  const std::array<cv::Vec3d, 4> corners{
      cv::Vec3d{-0.5, -0.5, 1}, cv::Vec3d{size.width - 0.5, -0.5, 1},
      cv::Vec3d{-0.5, size.height - 0.5, 1}, cv::Vec3d{size.width - 0.5, size.height - 0.5, 1}};
  for (std::uint64_t i = 0; i < frames; ++i) {
    const cv::Matx33d firstFromFrame = frameFromFirst(motion, size, i).inv();
    for (const cv::Vec3d& corner : corners) {
      const cv::Vec3d at = firstFromFrame * corner;
      half.width = std::max(half.width, std::abs(at[0] - middle.x));
      half.height = std::max(half.height, std::abs(at[1] - middle.y));
    }
  }
  return {2 * half.width, 2 * half.height};
}

/// Index into an image that continues mirrored without end and without repeating its edge.
int mirrored(int at, int count) {
  if (count == 1) return 0;
  const int period = 2 * (count - 1);
  at = ((at % period) + period) % period;
  return at < count ? at : period - at;
}

cv::Vec3f sampleMirrored(const cv::Mat3f& picture, cv::Point2d at) {
  const double floorX = std::floor(at.x);
  const double floorY = std::floor(at.y);
  const std::array<float, 4> wx = cubicWeights(static_cast<float>(at.x - floorX));
  const std::array<float, 4> wy = cubicWeights(static_cast<float>(at.y - floorY));
  std::array<int, 4> columns{};
  for (int i = 0; i < 4; ++i) {
    columns.at(static_cast<std::size_t>(i)) =
        mirrored(static_cast<int>(floorX) - 1 + i, picture.cols);
  }
  cv::Vec3f sum;
  for (int j = 0; j < 4; ++j) {
    const cv::Vec3f* row = picture[mirrored(static_cast<int>(floorY) - 1 + j, picture.rows)];
    const cv::Vec3f along = row[columns[0]] * wx[0] + row[columns[1]] * wx[1] +
                            row[columns[2]] * wx[2] + row[columns[3]] * wx[3];
    sum += along * wy[static_cast<std::size_t>(j)];
  }
  return sum;
}

}  // namespace

cv::Matx33d frameFromFirst(const PhotographMotion& motion, hal::FrameSize size,
                           std::uint64_t index) {
  const double middleX = (size.width - 1) / 2.0;
  const double middleY = (size.height - 1) / 2.0;
  const auto frames = static_cast<double>(index);
  const double scale = std::pow(1.0 + motion.zoomPercent / 100.0, frames);
  const double angle = motion.rollDegrees / 180.0 * std::numbers::pi * frames;
  const double c = scale * std::cos(angle);
  const double s = scale * std::sin(angle);
  const cv::Matx33d fromMiddle(1, 0, -middleX, 0, 1, -middleY, 0, 0, 1);
  const cv::Matx33d turned(c, -s, 0, s, c, 0, 0, 0, 1);
  const cv::Matx33d panned(1, 0, middleX + motion.pan.x * frames, 0, 1,
                           middleY + motion.pan.y * frames, 0, 0, 1);
  return panned * turned * fromMiddle;
}

MovedPhotograph::MovedPhotograph(const hal::Image& rgb8, hal::FrameSize size,
                                 PhotographMotion motion, std::uint64_t frames)
    : size_(size), motion_(motion) {
  const cv::Mat3f whole = toFloat(rgb8.view());
  const cv::Size2d extent = extentOf(motion, size, frames);
  // Photograph px per frame px.
  const double fits = std::min(whole.cols / extent.width, whole.rows / extent.height);
  const double finest = std::max(1.0, fits);
  isMirrored_ = fits < 1.0;
  samplesPerPixel_ = std::min(finest, kMaxSamples);
  if (finest > samplesPerPixel_) {
    const double shrink = samplesPerPixel_ / finest;
    cv::resize(whole, photograph_, {}, shrink, shrink, cv::INTER_AREA);
  } else {
    photograph_ = whole;
  }
  const double s = samplesPerPixel_;
  photographFromFirst_ = {s, 0, (photograph_.cols - 1) / 2.0 - s * (size.width - 1) / 2.0,
                          0, s, (photograph_.rows - 1) / 2.0 - s * (size.height - 1) / 2.0,
                          0, 0, 1};
}

cv::Mat3f MovedPhotograph::frame(std::uint64_t index) const {
  // Two samples per side integrate over a pixel that covers up to two of the photograph's.
  constexpr std::array kOffsets{-0.25, 0.25};
  const cv::Matx33d from = photographFromFirst_ * frameFromFirst(motion_, size_, index).inv();
  cv::Mat3f picture(size_.height, size_.width);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      cv::Vec3f sum;
      for (const double dy : kOffsets) {
        for (const double dx : kOffsets) {
          const cv::Vec3d at = from * cv::Vec3d(x + dx, y + dy, 1);
          sum += sampleMirrored(photograph_, {at[0], at[1]});
        }
      }
      picture(y, x) = sum * 0.25F;
    }
  }
  return picture;
}

std::unique_ptr<TrueMotion> MovedPhotograph::motion() const {
  const cv::Size frame(size_.width, size_.height);
  if (!turnsOrZooms(motion_)) return constantMotion(frame, motion_.pan);
  return homographyMotion(frame, describe(motion_),
                          [motion = motion_, size = size_](std::uint64_t index) {
                            return frameFromFirst(motion, size, index);
                          });
}

}  // namespace pleinair::measure

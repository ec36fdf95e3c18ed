#include "tests/reports/tracking/cut_films.h"

#include <algorithm>
#include <filesystem>
#include <random>
#include <variant>

#include <opencv2/imgproc.hpp>

#include "hal/camera.h"
#include "hal/cameras/recording/recording.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/tracking/image/luma.h"

namespace pleinair::tracking {
namespace {

namespace fs = std::filesystem;
const std::string kData = PLEINAIR_SHARED_DATA;
constexpr int kWidth = 640;
constexpr int kHeight = 480;

Film readFilm(hal::Camera& camera, std::size_t first, std::size_t count, std::size_t every) {
  Film out;
  if (!camera.start({})) return out;
  LumaConverter converter;
  for (std::size_t i = 0; out.size() < count; ++i) {
    const hal::NextFrame next = camera.next(hal::kNoDeadline);
    const auto* frame = std::get_if<hal::CapturedFrame>(&next);
    if (frame == nullptr) break;
    if (i < first || (i - first) % every != 0) continue;
    const hal::PlaneView luma = converter.convert(frame->image.map().view());
    const hal::FrameSize size = frame->image.format.size;
    const cv::Mat view(size.height, size.width, CV_8UC1,
                       const_cast<unsigned char*>(luma.bytes.data()), luma.strideBytes);
    cv::Mat sized;
    // Keeps the shape: cuts to 4:3.
    const double scale = std::max(double{kWidth} / size.width, double{kHeight} / size.height);
    cv::resize(view, sized, {}, scale, scale, scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
    out.push_back(
        sized(cv::Rect((sized.cols - kWidth) / 2, (sized.rows - kHeight) / 2, kWidth, kHeight))
            .clone());
  }
  camera.stop();
  return out;
}

}  // namespace

Film recording(const std::string& path, std::size_t first, std::size_t count, std::size_t every) {
  if (!fs::exists(path)) return {};
  hal::SteppedClock clock;
  return readFilm(*hal::openRecording(path, clock), first, count, every);
}

Film workbench(hal::SyntheticShot shot, std::size_t first, std::size_t count, std::size_t every) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = {kWidth, kHeight}, .shot = shot}, clock);
  return readFilm(camera, first, count, every);
}

cv::Mat crop(const cv::Mat& image, double x, double y, double part) {
  const cv::Rect area(static_cast<int>(x * image.cols), static_cast<int>(y * image.rows),
                      static_cast<int>(part * image.cols), static_cast<int>(part * image.rows));
  cv::Mat out;
  cv::resize(image(area), out, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_CUBIC);
  return out;
}

cv::Mat noisy(const cv::Mat& image, unsigned seed) {
  cv::Mat out = image.clone();
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 2.0);
  for (int y = 0; y < out.rows; ++y) {
    for (int x = 0; x < out.cols; ++x) {
      auto& px = out.at<unsigned char>(y, x);
      px = cv::saturate_cast<unsigned char>(px + noise(random));
    }
  }
  return out;
}

cv::Mat photo(const std::string& name) {
  const Film film = recording(kData + "/photos/cc0_pd_skimage/" + name, 0, 1);
  return film.empty() ? cv::Mat() : film[0];
}

Film panOver(const cv::Mat& image, int stepPx, bool blurs) {
  cv::Mat large;
  cv::resize(image, large, {2 * kWidth, 2 * kHeight}, 0.0, 0.0, cv::INTER_CUBIC);
  if (blurs) cv::blur(large.clone(), large, {stepPx, 1});
  Film film;
  for (int x = 0; x + kWidth < large.cols; x += stepPx) {
    film.push_back(
        noisy(large(cv::Rect(x, kHeight / 2, kWidth, kHeight)), static_cast<unsigned>(x)));
  }
  return film;
}

}  // namespace pleinair::tracking

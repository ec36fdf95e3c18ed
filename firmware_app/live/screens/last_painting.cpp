#include "firmware_app/live/screens/last_painting.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/media/png_file.h"

namespace pleinair::app {
namespace {

namespace fs = std::filesystem;

/// More than any picture of that size takes.
constexpr std::uintmax_t kMaxBytes = 8U << 20U;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : value;
}

hal::Error foreign(const fs::path& file, std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput,
          .subject = file.string(),
          .problem = std::move(problem),
          .remedy = "remove it"};
}

/// RGB8, no larger than kMaxSide.
hal::Image reduced(const hal::Image& painting) {
  const hal::FrameSize from = painting.size();
  const double scale = std::min(
      1.0, static_cast<double>(LastPainting::kMaxSide) / std::max(from.width, from.height));
  const auto sideOf = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(side * scale)));
  };
  hal::Image result({.pixelFormat = hal::PixelFormat::kRgb8,
                     .size = {sideOf(from.width), sideOf(from.height)},
                     .encoding = {}});
  const hal::ImageView view = painting.view();
  const cv::Mat whole(from.height, from.width, CV_8UC4,
                      const_cast<std::uint8_t*>(view.planes[0].bytes.data()),
                      view.planes[0].strideBytes);
  cv::Mat small;
  cv::resize(whole, small, {result.size().width, result.size().height}, 0, 0, cv::INTER_AREA);
  cv::Mat target(result.size().height, result.size().width, CV_8UC3, result.plane(0).data());
  cv::cvtColor(small, target, cv::COLOR_RGBA2RGB);
  return result;
}

hal::Result<void> write(const fs::path& file, const hal::Image& painting) {
  std::error_code failure;
  fs::create_directories(file.parent_path(), failure);
  if (failure) {
    return tl::unexpected(hal::errnoError(file.parent_path().string(), "cannot be made",
                                          failure.value(),
                                          "set output.keep_last_painting = false"));
  }
  return hal::writePng(file, reduced(painting).view());
}

}  // namespace

fs::path runtimeFolder() {
  const std::string folders = variable("RUNTIME_DIRECTORY");
  return folders.substr(0, folders.find(':'));
}

fs::path stateFolder() {
  if (const std::string folder = variable("STATE_DIRECTORY"); !folder.empty()) {
    return folder.substr(0, folder.find(':'));  // the first of several
  }
  if (const std::string folder = variable("XDG_STATE_HOME"); folder.starts_with('/')) {
    return fs::path(folder) / "pleinair";
  }
  const std::string home = variable("HOME");
  return home.starts_with('/') ? fs::path(home) / ".local/state/pleinair" : fs::path();
}

LastPainting::LastPainting(const fs::path& folder)
    : file_(folder.empty() ? fs::path() : folder / "last-painting.png") {}

hal::Result<std::optional<hal::Image>> LastPainting::read() const {
  std::error_code failure;
  if (file_.empty() || !fs::exists(file_, failure)) return std::nullopt;
  if (!fs::is_regular_file(file_, failure)) return tl::unexpected(foreign(file_, "is no file"));
  if (fs::file_size(file_, failure) > kMaxBytes || failure) {
    return tl::unexpected(foreign(file_, "is larger than any that is kept"));
  }
  hal::Result<hal::Image> painting = hal::readOwnPng(file_);
  if (!painting) return tl::unexpected(std::move(painting.error()));
  if (std::max(painting->size().width, painting->size().height) > kMaxSide) {
    return tl::unexpected(foreign(file_, "is larger than any that is kept"));
  }
  return *std::move(painting);
}

bool LastPainting::isDue(hal::TimePoint now) {
  if (!began_) began_ = now;
  return !file_.empty() && !saving_.valid() && now - saved_.value_or(*began_) >= kInterval;
}

bool LastPainting::isDueAtEnd(hal::TimePoint now) const {
  return !file_.empty() && !saving_.valid() && (!saved_ || now - *saved_ >= kInterval);
}

void LastPainting::save(hal::Image painting, hal::TimePoint now) {
  assert(!file_.empty() && !saving_.valid());
  saved_ = now;
  saving_ = std::async(std::launch::async,
                       [file = file_, image = std::move(painting)] { return write(file, image); });
}

std::optional<hal::Error> LastPainting::takeFailure(bool waits) {
  if (!saving_.valid()) return std::nullopt;
  const auto patience = std::chrono::seconds(0);
  if (!waits && saving_.wait_for(patience) != std::future_status::ready) return std::nullopt;
  hal::Result<void> saved = saving_.get();
  return saved ? std::nullopt : std::optional(std::move(saved.error()));
}

}  // namespace pleinair::app

#include "tests/golden/golden_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include <fmt/format.h>

#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"

namespace pleinair::golden {
namespace {

std::size_t channelsOf(const hal::ImageView& image) {
  return image.format.pixelFormat == hal::PixelFormat::kRgba8 ? 4 : 3;
}

int valueAt(const hal::ImageView& image, int x, int y, std::size_t channel) {
  return image.row(0, y)[static_cast<std::size_t>(x) * channelsOf(image) + channel];
}

double lumaAt(const hal::ImageView& image, int x, int y) {
  return 0.299 * valueAt(image, x, y, 0) + 0.587 * valueAt(image, x, y, 1) +
         0.114 * valueAt(image, x, y, 2);
}

double ssimOfWindow(const hal::ImageView& a, const hal::ImageView& b, int left, int top) {
  constexpr int kSide = 8;
  constexpr double kC1 = 6.5025;   // (0.01 · 255)²
  constexpr double kC2 = 58.5225;  // (0.03 · 255)²
  double sumA = 0.0;
  double sumB = 0.0;
  double sumAa = 0.0;
  double sumBb = 0.0;
  double sumAb = 0.0;
  double count = 0.0;
  for (int y = top; y < std::min(top + kSide, a.format.size.height); ++y) {
    for (int x = left; x < std::min(left + kSide, a.format.size.width); ++x) {
      const double va = lumaAt(a, x, y);
      const double vb = lumaAt(b, x, y);
      sumA += va;
      sumB += vb;
      sumAa += va * va;
      sumBb += vb * vb;
      sumAb += va * vb;
      count += 1.0;
    }
  }
  const double meanA = sumA / count;
  const double meanB = sumB / count;
  const double varianceA = sumAa / count - meanA * meanA;
  const double varianceB = sumBb / count - meanB * meanB;
  const double covariance = sumAb / count - meanA * meanB;
  return (2.0 * meanA * meanB + kC1) * (2.0 * covariance + kC2) /
         ((meanA * meanA + meanB * meanB + kC1) * (varianceA + varianceB + kC2));
}

hal::Image differenceOf(const hal::ImageView& a, const hal::ImageView& b) {
  hal::Image difference({.pixelFormat = hal::PixelFormat::kRgb8, .size = a.format.size});
  for (int y = 0; y < a.format.size.height; ++y) {
    const auto row = difference.row(0, y);
    for (int x = 0; x < a.format.size.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int value = 128 + 4 * (valueAt(a, x, y, c) - valueAt(b, x, y, c));
        row[static_cast<std::size_t>(x) * 3 + c] =
            static_cast<std::uint8_t>(std::clamp(value, 0, 255));
      }
    }
  }
  return difference;
}

/// Where a test may write: beside nothing that is kept.
std::filesystem::path outputOf(const std::filesystem::path& golden, std::string_view what) {
  return std::filesystem::temp_directory_path() /
         fmt::format("pleinair-{}-{}.png", golden.stem().string(), what);
}

std::string update(const std::filesystem::path& golden, const hal::ImageView& picture) {
  if (const auto old = hal::readPictureRgb(golden); old && old->size() == picture.format.size) {
    const auto at = outputOf(golden, "difference");
    if (const auto written = hal::writePng(at, differenceOf(picture, old->view()).view());
        !written) {
      return written.error().message();
    }
    std::cerr << "difference from the old golden: " << at.string() << "\n";
  }
  const auto written = hal::writePng(golden, picture);
  if (!written) return written.error().message();
  std::cerr << "kept as golden: " << golden.string() << "\n";
  return {};
}

}  // namespace

Likeness likeness(const hal::ImageView& a, const hal::ImageView& b) {
  const hal::FrameSize size = a.format.size;
  double squared = 0.0;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        squared += std::pow(valueAt(a, x, y, c) - valueAt(b, x, y, c), 2);
      }
    }
  }
  double ssim = 0.0;
  int windows = 0;
  for (int y = 0; y < size.height; y += 8) {
    for (int x = 0; x < size.width; x += 8) {
      ssim += ssimOfWindow(a, b, x, y);
      ++windows;
    }
  }
  const double mean = squared / (3.0 * static_cast<double>(size.pixels()));
  return {.psnrDecibels = mean > 0.0 ? 10.0 * std::log10(255.0 * 255.0 / mean) : 99.0,
          .ssim = ssim / windows};
}

std::string compareWithGolden(const std::filesystem::path& golden, const hal::ImageView& picture,
                              Likeness least) {
  // Tests read the environment before they start threads. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* const wanted = std::getenv("PLEINAIR_UPDATE_GOLDENS");
  if (wanted != nullptr && std::string_view(wanted) == "1") return update(golden, picture);

  const auto kept = hal::readPictureRgb(golden);
  if (!kept) return kept.error().message() + "; PLEINAIR_UPDATE_GOLDENS=1 makes it";
  if (kept->size() != picture.format.size) return golden.string() + ": has another size";
  const Likeness found = likeness(picture, kept->view());
  if (found.psnrDecibels >= least.psnrDecibels && found.ssim >= least.ssim) return {};

  const auto pictureAt = outputOf(golden, "found");
  const auto differenceAt = outputOf(golden, "difference");
  std::string text =
      fmt::format("{}: PSNR {:.1f} dB (at least {:.1f}), SSIM {:.4f} (at least {:.4f})",
                  golden.string(), found.psnrDecibels, least.psnrDecibels, found.ssim, least.ssim);
  for (const auto& [path, image] : {std::pair(pictureAt, hal::Image(picture)),
                                    std::pair(differenceAt, differenceOf(picture, kept->view()))}) {
    const auto written = hal::writePng(path, image.view());
    text += written ? "; see " + path.string() : "; " + written.error().message();
  }
  return text;
}

}  // namespace pleinair::golden

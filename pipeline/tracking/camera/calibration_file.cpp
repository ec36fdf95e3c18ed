#include "pipeline/tracking/camera/calibration_file.h"

#include <array>
#include <vector>

namespace pleinair::tracking {
namespace {

enum class PixelCentres { kHalf, kInteger };

constexpr std::array<config::Choice<PixelCentres>, 2> kPixelCentres{
    {{"half", PixelCentres::kHalf}, {"integer", PixelCentres::kInteger}}};

constexpr config::NumberRange kFocalRange{.min = 0.0, .max = 1e6, .minOpen = true, .unit = "px"};
constexpr config::NumberRange kCentreRange{.min = -1e6, .max = 1e6, .unit = "px"};
constexpr config::NumberRange kSideRange{.min = 1, .max = hal::kMaxSidePixels, .unit = "px"};

hal::FrameSize readSize(const config::TomlTable& table) {
  const std::array<double, 2> sides = table.vector<2>("image_size", kSideRange);
  const hal::FrameSize size{static_cast<int>(sides[0]), static_cast<int>(sides[1])};
  if (size.width != sides[0] || size.height != sides[1] || !hal::isAcceptedSize(size)) {
    throw table.error("image_size", "no size of a picture", "width and height in whole px");
  }
  return size;
}

Distortion readDistortion(const config::TomlTable& table) {
  const auto terms = table.optionalNumbers("distortion", {.min = 0, .max = 8});
  if (!terms) return {};
  std::array<double, 8> all{};
  for (std::size_t i = 0; i < terms->size(); ++i) all[i] = (*terms)[i];
  return {.k1 = all[0],
          .k2 = all[1],
          .p1 = all[2],
          .p2 = all[3],
          .k3 = all[4],
          .k4 = all[5],
          .k5 = all[6],
          .k6 = all[7]};
}

}  // namespace

CameraModel readCalibration(const config::TomlTable& table) {
  const hal::FrameSize size = readSize(table);
  Intrinsics intrinsics{.fx = table.number("fx", kFocalRange),
                        .fy = table.number("fy", kFocalRange),
                        .cx = table.number("cx", kCentreRange),
                        .cy = table.number("cy", kCentreRange)};
  const PixelCentres centres =
      table.optionalChoice("pixel_centres", kPixelCentres).value_or(PixelCentres::kHalf);
  if (centres == PixelCentres::kInteger) {
    intrinsics.cx += 0.5;
    intrinsics.cy += 0.5;
  }
  return {intrinsics, readDistortion(table), size};
}

CameraModel loadCalibration(const std::filesystem::path& path) {
  const config::TomlDocument document = config::TomlDocument::parseFile(path);
  const CameraModel camera = readCalibration(document.root());
  document.root().finish();
  return camera;
}

}  // namespace pleinair::tracking

#include "pipeline/inspection/template_file.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "config/toml_reader.h"
#include "pipeline/tracking/camera/calibration_file.h"

namespace pleinair::inspection {
namespace {

constexpr const char* kPoseKey = "camera_from_model";

/// A rotation, a translation and a scale that is the same along all axes.
bool isSimilarity(const glm::dmat4& matrix) {
  constexpr double kTolerance = 1e-4;
  const double scale = glm::length(glm::dvec3(matrix[0]));
  if (!(scale > 0.0)) return false;
  const glm::dmat3 rotation = glm::dmat3(matrix) / scale;
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      const double expected = column == row ? 1.0 : 0.0;
      if (std::abs(product[column][row] - expected) > kTolerance) return false;
    }
    if (std::abs(matrix[column][3]) > kTolerance) return false;
  }
  return std::abs(matrix[3][3] - 1.0) < kTolerance && glm::determinant(rotation) > 0.0;
}

}  // namespace

std::filesystem::path templatePosePath(const std::filesystem::path& picture) {
  return std::filesystem::path(picture).replace_extension(".toml");
}

TemplatePose readTemplatePose(const std::filesystem::path& file) {
  const config::TomlDocument document = config::TomlDocument::parseFile(file);
  TemplatePose pose{.camera = tracking::readCalibration(document.root())};
  const auto numbers = document.root().vector<16>(kPoseKey, {.min = -1e3, .max = 1e3});
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.cameraFromModel[column][row] = numbers.at(static_cast<std::size_t>(4 * row + column));
    }
  }
  if (!isSimilarity(pose.cameraFromModel)) {
    throw document.root().error(kPoseKey, "is no place of a machine",
                                "16 numbers by rows, as `pleinair procedure template` writes them");
  }
  document.root().finish();
  return pose;
}

std::string templatePoseText(const TemplatePose& pose) {
  const tracking::Intrinsics& lens = pose.camera.intrinsics();
  const tracking::Distortion& d = pose.camera.distortion();
  const hal::FrameSize size = pose.camera.imageSize();
  std::array<double, 16> numbers{};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      numbers.at(static_cast<std::size_t>(4 * row + column)) = pose.cameraFromModel[column][row];
    }
  }
  return fmt::format(
      "# Where the picture beside it was taken, by `pleinair procedure template`.\n"
      "image_size = [{}, {}]\nfx = {:.17g}\nfy = {:.17g}\ncx = {:.17g}\ncy = {:.17g}\n"
      "distortion = [{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}]\n"
      "{} = [{:.17g}]\n",
      size.width, size.height, lens.fx, lens.fy, lens.cx, lens.cy, d.k1, d.k2, d.p1, d.p2, d.k3,
      d.k4, d.k5, d.k6, kPoseKey, fmt::join(numbers, ", "));
}

}  // namespace pleinair::inspection

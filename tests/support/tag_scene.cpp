#include "tests/support/tag_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace pleinair::support {
namespace {

constexpr double kPaperMarginCells = 2.0;

/// The library's bitmap of one tag, and the number of cells along its black square.
class TagBitmap {
 public:
  explicit TagBitmap(int id) {
    const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                  tag36h11_destroy);
    if (id < 0 || static_cast<std::uint32_t>(id) >= family->ncodes) {
      throw std::out_of_range("no such tag36h11");
    }
    const std::unique_ptr<image_u8_t, decltype(&image_u8_destroy)> picture(
        apriltag_to_image(family.get(), id), image_u8_destroy);
    cellsAtBorder_ = family->width_at_border;
    side_ = picture->width;
    for (int y = 0; y < side_; ++y) {
      for (int x = 0; x < side_; ++x)
        isWhite_.push_back(picture->buf[y * picture->stride + x] > 127);
    }
  }

  double cellsAtBorder() const { return cellsAtBorder_; }

  /// Whether the tag is white at a place on the paper, in cells from its centre, x right, y down.
  bool isWhiteAt(const glm::dvec2& cells) const {
    const int x = static_cast<int>(std::floor(cells.x + side_ / 2.0));
    const int y = static_cast<int>(std::floor(cells.y + side_ / 2.0));
    if (x < 0 || y < 0 || x >= side_ || y >= side_) return true;
    return isWhite_[static_cast<std::size_t>(std::int64_t{y} * side_ + x)];
  }

 private:
  int cellsAtBorder_ = 0;
  int side_ = 0;
  std::vector<bool> isWhite_;
};

class TagPainter {
 public:
  TagPainter(const tracking::CameraModel& camera, const glm::dmat4& cameraFromWorld,
             const SceneTag& tag, const TagPictureOptions& options)
      : camera_(camera),
        options_(options),
        bitmap_(tag.id),
        cameraFromTag_(cameraFromWorld * tag.worldFromTag),
        tagFromCamera_(glm::inverse(cameraFromTag_)),
        metresPerCell_(tag.edgeMetres / bitmap_.cellsAtBorder()),
        paperHalfCells_(bitmap_.cellsAtBorder() / 2.0 + kPaperMarginCells) {}

  void paint(std::span<float> grey) const {
    const hal::FrameSize size = camera_.imageSize();
    const tracking::TagCornersPx paper =
        trueCorners(camera_, cameraFromTag_, 2.0 * paperHalfCells_ * metresPerCell_);
    glm::dvec2 least = paper[0];
    glm::dvec2 most = paper[0];
    for (const glm::dvec2& corner : paper) {
      least = glm::min(least, corner);
      most = glm::max(most, corner);
    }
    // how far lens distortion bends the paper's edges beyond its corners
    constexpr double kBulgePx = 8.0;
    const auto clampTo = [](double value, int end) {
      return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(end)));
    };
    const int left = clampTo(least.x - kBulgePx, size.width);
    const int right = clampTo(most.x + kBulgePx, size.width);
    const int bottom = clampTo(most.y + kBulgePx, size.height);
    std::vector<glm::dvec2> above;  // places on the paper at the pixel corners, row by row
    std::vector<glm::dvec2> below;
    for (int y = clampTo(least.y - kBulgePx, size.height); y < bottom; ++y) {
      if (above.empty()) above = cellsAlong(left, right, y);
      below = cellsAlong(left, right, y + 1);
      for (int x = left; x < right; ++x) {
        const auto i = static_cast<std::size_t>(x - left);
        float& pixel = grey[static_cast<std::size_t>(std::int64_t{y} * size.width + x)];
        pixel =
            static_cast<float>(pixelValue({above[i], above[i + 1], below[i], below[i + 1]}, pixel));
      }
      above.swap(below);
    }
  }

 private:
  using PixelCorners = std::array<glm::dvec2, 4>;  // top left, top right, bottom left, bottom right

  /// The places on the paper (cells) at the pixel corners from (left, y) to (right, y).
  std::vector<glm::dvec2> cellsAlong(int left, int right, int y) const {
    std::vector<glm::dvec2> cells;
    const glm::dvec3 origin(tagFromCamera_[3]);
    for (int x = left; x <= right; ++x) {
      const auto ray = camera_.unproject({x, y});
      const glm::dvec3 direction = ray ? glm::dmat3(tagFromCamera_) * *ray : glm::dvec3(0.0);
      const double distance = -origin.z / direction.z;
      cells.push_back(ray && distance > 0.0
                          ? glm::dvec2(origin + distance * direction) / metresPerCell_
                          : glm::dvec2(1e9));
    }
    return cells;
  }

  /// Within a pixel, the lens counts as linear: its error is far below a sample's distance.
  double pixelValue(const PixelCorners& at, double behind) const {
    const auto isSameCell = [&](const glm::dvec2& cells) {
      return glm::floor(cells) == glm::floor(at[0]);
    };
    if (std::ranges::all_of(at, isSameCell)) return sample(at[0], behind);
    const int count = options_.samplesPerSide;
    double sum = 0.0;
    for (int sy = 0; sy < count; ++sy) {
      const double down = (sy + 0.5) / count;
      const glm::dvec2 first = glm::mix(at[0], at[2], down);
      const glm::dvec2 last = glm::mix(at[1], at[3], down);
      for (int sx = 0; sx < count; ++sx) {
        sum += sample(glm::mix(first, last, (sx + 0.5) / count), behind);
      }
    }
    return sum / (count * count);
  }

  double sample(const glm::dvec2& cells, double behind) const {
    if (std::max(std::abs(cells.x), std::abs(cells.y)) > paperHalfCells_) return behind;
    return bitmap_.isWhiteAt(cells) ? options_.white : options_.black;
  }

  const tracking::CameraModel& camera_;
  const TagPictureOptions& options_;
  TagBitmap bitmap_;
  glm::dmat4 cameraFromTag_;
  glm::dmat4 tagFromCamera_;
  double metresPerCell_;
  double paperHalfCells_;
};

}  // namespace

glm::dmat4 poseOf(const glm::dvec3& rotationVector, const glm::dvec3& translation) {
  const double angle = glm::length(rotationVector);
  const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), translation);
  return angle > 0.0 ? glm::rotate(shifted, angle, rotationVector / angle) : shifted;
}

hal::Image renderTags(const tracking::CameraModel& camera, const glm::dmat4& cameraFromWorld,
                      std::span<const SceneTag> tags, const TagPictureOptions& options) {
  const hal::FrameSize size = camera.imageSize();
  std::vector<float> grey(static_cast<std::size_t>(size.pixels()),
                          static_cast<float>(options.background));
  for (const SceneTag& tag : tags) TagPainter(camera, cameraFromWorld, tag, options).paint(grey);

  std::mt19937 random(options.noiseSeed);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  hal::Image image({.pixelFormat = hal::PixelFormat::kGrey8, .size = size});
  const std::span<std::uint8_t> bytes = image.plane(0);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const float noisy = options.noiseSigma > 0.0
                            ? grey[i] + static_cast<float>(options.noiseSigma) * noise(random)
                            : grey[i];
    bytes[i] = static_cast<std::uint8_t>(std::lround(std::clamp(noisy, 0.0F, 255.0F)));
  }
  return image;
}

tracking::TagCornersPx trueCorners(const tracking::CameraModel& camera,
                                   const glm::dmat4& cameraFromTag, double edgeMetres) {
  tracking::TagCornersPx corners{};
  std::ranges::transform(tracking::tagCorners(edgeMetres), corners.begin(),
                         [&](const glm::dvec3& p) {
                           return camera.project(glm::dvec3(cameraFromTag * glm::dvec4(p, 1.0)));
                         });
  return corners;
}

hal::Image neutralPicture(const hal::Image& grey, hal::PixelFormat format) {
  constexpr std::uint8_t kNeutral = 128;
  hal::Image image({.pixelFormat = format, .size = grey.size()});
  for (int plane = 1; plane < hal::planeCount(format); ++plane) {
    std::ranges::fill(image.plane(plane), kNeutral);
  }
  const std::size_t pixelBytes = hal::rowBytes(format, 0, 2) / 2;
  for (int y = 0; y < grey.size().height; ++y) {
    const std::span<const std::uint8_t> from = grey.view().row(0, y);
    const std::span<std::uint8_t> to = image.row(0, y);
    for (std::size_t i = 0; i < to.size(); ++i) {
      const std::size_t x = std::min(i / pixelBytes, from.size() - 1);
      const bool isOther = (format == hal::PixelFormat::kYuyv && i % 2 == 1) ||
                           (format == hal::PixelFormat::kRgba8 && i % 4 == 3);
      to[i] = isOther ? kNeutral : from[x];
    }
  }
  return image;
}

}  // namespace pleinair::support

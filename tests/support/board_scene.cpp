#include "tests/support/board_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <variant>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/random_vectors.h"

namespace pleinair::support {
namespace {

using calibration::AprilGrid;
using calibration::Checkerboard;

constexpr double kFar = 1e9;
constexpr int kTagCells = 8;  // cells along the outer edge of the black border

std::vector<std::vector<bool>> tagCells(int id) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const std::unique_ptr<image_u8_t, decltype(&image_u8_destroy)> picture(
      apriltag_to_image(family.get(), id), image_u8_destroy);
  const int margin = (picture->width - kTagCells) / 2;
  std::vector<std::vector<bool>> isWhite(kTagCells, std::vector<bool>(kTagCells));
  for (int y = 0; y < kTagCells; ++y) {
    for (int x = 0; x < kTagCells; ++x) {
      isWhite[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] =
          picture->buf[(y + margin) * picture->stride + x + margin] > 127;
    }
  }
  return isWhite;
}

void blur(std::vector<float>& grey, hal::FrameSize size, double sigma) {
  const int reach = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<float> kernel;
  float sum = 0.0F;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  const auto pass = [&](int dx, int dy) {
    const std::vector<float> from = grey;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        float value = 0.0F;
        for (int i = -reach; i <= reach; ++i) {
          const int sx = std::clamp(x + i * dx, 0, size.width - 1);
          const int sy = std::clamp(y + i * dy, 0, size.height - 1);
          value += kernel[static_cast<std::size_t>(i + reach)] *
                   from[static_cast<std::size_t>(sy * size.width + sx)];
        }
        grey[static_cast<std::size_t>(y * size.width + x)] = value;
      }
    }
  };
  pass(1, 0);
  pass(0, 1);
}

}  // namespace

/// The printed board: its ink at a place, in metres from the board's centre.
class BoardRenderer::Print {
 public:
  explicit Print(const calibration::Board& board) : kind_(board.kind()) {
    if (const auto* grid = std::get_if<AprilGrid>(&kind_)) {
      for (int i = 0; i < grid->columns * grid->rows; ++i) {
        tags_.push_back(tagCells(grid->firstId + i));
      }
    }
  }

  enum class Ink { kNone, kWhite, kBlack };

  Ink at(const glm::dvec2& place) const {
    const auto* grid = std::get_if<AprilGrid>(&kind_);
    return grid != nullptr ? at(*grid, place) : at(std::get<Checkerboard>(kind_), place);
  }

 private:
  static Ink at(const Checkerboard& board, const glm::dvec2& place) {
    const double column = place.x / board.squareMetres + (board.columns + 1) / 2.0;
    const double row = place.y / board.squareMetres + (board.rows + 1) / 2.0;
    if (column < -1.0 || row < -1.0 || column > board.columns + 2 || row > board.rows + 2) {
      return Ink::kNone;
    }
    if (column < 0.0 || row < 0.0 || column > board.columns + 1 || row > board.rows + 1) {
      return Ink::kWhite;
    }
    const int parity = static_cast<int>(std::floor(column)) + static_cast<int>(std::floor(row));
    return parity % 2 == 0 ? Ink::kBlack : Ink::kWhite;
  }

  Ink at(const AprilGrid& grid, const glm::dvec2& place) const {
    // From the lower left corner of the lower left tag, in tag edges, y up.
    const double pitch = 1.0 + grid.spacing;
    const double x = place.x / grid.tagEdgeMetres + (grid.columns * pitch - grid.spacing) / 2.0;
    const double y = -place.y / grid.tagEdgeMetres + (grid.rows * pitch - grid.spacing) / 2.0;
    const double margin = 2.0 * grid.spacing;
    if (x < -margin || y < -margin || x > grid.columns * pitch - grid.spacing + margin ||
        y > grid.rows * pitch - grid.spacing + margin) {
      return Ink::kNone;
    }
    const double column = std::floor((x + grid.spacing) / pitch);
    const double row = std::floor((y + grid.spacing) / pitch);
    const double inX = x - column * pitch;  // negative: in the gap before the tag
    const double inY = y - row * pitch;
    if (inX < 0.0 && inY < 0.0) return Ink::kBlack;  // the square between the corners of four tags
    if (inX < 0.0 || inY < 0.0) return Ink::kWhite;
    if (column >= grid.columns || row >= grid.rows || column < 0.0 || row < 0.0) return Ink::kWhite;
    const auto tag = static_cast<std::size_t>(row * grid.columns + column);
    const auto cell = [](double in) {
      return std::min<std::size_t>(7, static_cast<std::size_t>(in * kTagCells));
    };
    return tags_[tag][7 - cell(inY)][cell(inX)] ? Ink::kWhite : Ink::kBlack;
  }

  calibration::Board::Kind kind_;
  std::vector<std::vector<std::vector<bool>>> tags_;
};

BoardRenderer::BoardRenderer(const calibration::Board& board, const tracking::CameraModel& camera)
    : camera_(camera), print_(std::make_unique<Print>(board)) {
  const hal::FrameSize size = camera.imageSize();
  rays_.reserve(static_cast<std::size_t>((size.width + 1) * (size.height + 1)));
  for (int y = 0; y <= size.height; ++y) {
    for (int x = 0; x <= size.width; ++x) {
      const auto ray = camera.unproject({x, y});
      rays_.push_back(ray ? glm::dvec2(*ray) : glm::dvec2(kFar));
    }
  }
}

BoardRenderer::~BoardRenderer() = default;

hal::Image BoardRenderer::render(const glm::dmat4& cameraFromBoard,
                                 const BoardPictureOptions& options) const {
  const hal::FrameSize size = camera_.imageSize();
  const glm::dmat4 boardFromCamera = glm::inverse(cameraFromBoard);
  const glm::dvec3 origin(boardFromCamera[3]);
  const glm::dmat3 turn(boardFromCamera);
  const auto placeOf = [&](const glm::dvec2& ray) {
    if (ray.x == kFar) return glm::dvec2(kFar);
    const glm::dvec3 direction = turn * glm::dvec3(ray, 1.0);
    const double distance = -origin.z / direction.z;
    if (!(distance > 0.0)) return glm::dvec2(kFar);
    const glm::dvec2 place(origin + distance * direction);
    return glm::dvec2(place.x / options.stretchX, place.y);
  };
  const auto greyOf = [&](const glm::dvec2& place) {
    const Print::Ink ink = print_->at(place);
    if (ink == Print::Ink::kNone) return options.background;
    return ink == Print::Ink::kWhite ? options.white : options.black;
  };
  std::vector<glm::dvec2> places;
  places.reserve(rays_.size());
  for (const glm::dvec2& ray : rays_) places.push_back(placeOf(ray));

  std::vector<float> grey(static_cast<std::size_t>(size.pixels()));
  const int count = options.samplesPerSide;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto at = static_cast<std::size_t>(y * (size.width + 1) + x);
      const auto below = at + static_cast<std::size_t>(size.width) + 1;
      double sum = 0.0;
      for (int sy = 0; sy < count; ++sy) {
        const double down = (sy + 0.5) / count;
        const glm::dvec2 left = glm::mix(places[at], places[below], down);
        const glm::dvec2 right = glm::mix(places[at + 1], places[below + 1], down);
        for (int sx = 0; sx < count; ++sx) {
          sum += greyOf(glm::mix(left, right, (sx + 0.5) / count));
        }
      }
      grey[static_cast<std::size_t>(y * size.width + x)] =
          static_cast<float>(sum / (count * count));
    }
  }
  if (options.blurSigmaPx > 0.0) blur(grey, size, options.blurSigmaPx);

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

glm::dmat4 cameraFromBoard(const calibration::Board& board, const tracking::CameraModel& camera,
                           const BoardHold& hold) {
  const hal::FrameSize size = camera.imageSize();
  glm::dvec3 least(0.0);
  glm::dvec3 most(0.0);
  for (const glm::dvec3& corner : board.corners()) {
    least = glm::min(least, corner);
    most = glm::max(most, corner);
  }
  const double width = most.x - least.x;
  const double distance = width * camera.intrinsics().fx / (hold.span * size.width);
  const auto ray = camera.unproject(hold.at * glm::dvec2(size.width, size.height));
  const glm::dvec3 centre = ray.value_or(glm::dvec3(0.0, 0.0, 1.0)) * distance;
  glm::dmat4 pose = glm::translate(glm::dmat4(1.0), centre);
  // The camera's y points down, so that a positive yaw, left side nearer, is a negative rotation.
  pose = glm::rotate(pose, -hold.yaw, glm::dvec3(0.0, 1.0, 0.0));
  pose = glm::rotate(pose, hold.pitch, glm::dvec3(1.0, 0.0, 0.0));
  return glm::rotate(pose, hold.roll, glm::dvec3(0.0, 0.0, 1.0));
}

namespace {

/// Moves a hold towards the middle until the whole board is in the image.
BoardHold pulledIn(const calibration::Board& board, const tracking::CameraModel& camera,
                   BoardHold hold) {
  const glm::dvec2 size(camera.imageSize().width, camera.imageSize().height);
  constexpr double kMarginPx = 6.0;
  const double paper = std::visit(
      [](const auto& kind) {
        if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, Checkerboard>) {
          return kind.squareMetres;
        } else {
          return kind.spacing * kind.tagEdgeMetres;
        }
      },
      board.kind());
  for (int step = 0; step < 60; ++step) {
    const glm::dmat4 pose = cameraFromBoard(board, camera, hold);
    const bool isInside = std::ranges::all_of(board.corners(), [&](const glm::dvec3& corner) {
      const glm::dvec3 outer = corner + glm::sign(corner) * paper;
      const glm::dvec3 seen(pose * glm::dvec4(outer, 1.0));
      if (!(seen.z > 0.0)) return false;
      const glm::dvec2 px = camera.project(seen);
      return px.x > kMarginPx && px.y > kMarginPx && px.x < size.x - kMarginPx &&
             px.y < size.y - kMarginPx;
    });
    if (isInside) return hold;
    const glm::dvec2 inward = glm::dvec2(0.5) - hold.at;
    if (glm::length(inward) > 0.02) {
      hold.at += inward * 0.06;
    } else {
      hold.span *= 0.95;
    }
  }
  return hold;
}

}  // namespace

std::vector<BoardHold> calibrationPoses(const calibration::Board& board,
                                        const tracking::CameraModel& camera) {
  constexpr double kTilt = 0.55;
  std::vector<BoardHold> tour{
      {.span = 0.8},
      {.span = 0.6, .yaw = kTilt},
      {.span = 0.6, .yaw = -kTilt},
      {.span = 0.6, .pitch = kTilt},
      {.span = 0.6, .pitch = -kTilt},
      {.span = 0.7, .yaw = 0.4, .pitch = 0.4, .roll = 0.5},
      {.span = 0.7, .yaw = -0.4, .pitch = -0.4, .roll = -0.5},
      {.span = 0.5, .yaw = 0.4, .pitch = -0.4, .roll = 1.4},
  };
  for (const double span : {0.32, 0.45}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      for (const double x : {0.0, 0.5, 1.0}) {
        if (x == 0.5 && y == 0.5) continue;
        // Tilted away from the middle in one round, towards it in the other.
        const double sign = span < 0.4 ? 1.0 : -1.0;
        tour.push_back({.at = {x, y},
                        .span = span,
                        .yaw = sign * 0.8 * (x - 0.5),
                        .pitch = sign * 0.8 * (y - 0.5),
                        .roll = 0.2 * (x - y)});
      }
    }
  }
  for (BoardHold& hold : tour) hold = pulledIn(board, camera, hold);
  return tour;
}

calibration::BoardSighting idealSighting(const calibration::Board& board,
                                         const tracking::CameraModel& camera,
                                         const glm::dmat4& cameraFromBoard, double noisePx,
                                         std::uint32_t seed) {
  const hal::FrameSize size = camera.imageSize();
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  calibration::BoardSighting sighting{.edgeWidthPx = 1.5};
  for (std::size_t i = 0; i < board.corners().size(); ++i) {
    const glm::dvec2 error = support::randomVec2(noise, random);
    const glm::dvec3 seen(cameraFromBoard * glm::dvec4(board.corners()[i], 1.0));
    if (!(seen.z > 0.0)) continue;
    const glm::dvec2 px = camera.project(seen) + noisePx * error;
    if (px.x < 0.0 || px.y < 0.0 || px.x > size.width || px.y > size.height) continue;
    sighting.corners.push_back({static_cast<int>(i), px});
  }
  return sighting;
}

double rayErrorPx(const tracking::CameraModel& truth, const tracking::CameraModel& estimate) {
  const hal::FrameSize size = truth.imageSize();
  std::vector<glm::dvec2> places;
  std::vector<glm::dvec3> rays;
  for (int y = 0; y <= 12; ++y) {
    for (int x = 0; x <= 16; ++x) {
      places.emplace_back(size.width * x / 16.0, size.height * y / 12.0);
      const auto ray = truth.unproject(places.back());
      if (!ray) return std::numeric_limits<double>::infinity();
      rays.push_back(*ray);
    }
  }
  for (int step = 0; step < 3; ++step) {  // Gauss–Newton
    glm::dmat3 squares(0.0);
    glm::dvec3 score(0.0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const tracking::Projection seen = estimate.projectWithJacobian(rays[i]);
      const glm::dvec2 error = places[i] - seen.px;
      std::array<glm::dvec2, 3> byTurn{};
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = 1.0;
        byTurn.at(static_cast<std::size_t>(axis)) =
            seen.pxByCameraPoint * glm::cross(unit, rays[i]);
      }
      for (int a = 0; a < 3; ++a) {
        const glm::dvec2& one = byTurn.at(static_cast<std::size_t>(a));
        score[a] += glm::dot(one, error);
        for (int b = 0; b < 3; ++b) {
          squares[b][a] += glm::dot(one, byTurn.at(static_cast<std::size_t>(b)));
        }
      }
    }
    const glm::dvec3 turn = glm::inverse(squares) * score;
    for (glm::dvec3& ray : rays) {
      ray += glm::cross(turn, ray);
      ray /= ray.z;
    }
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    worst = std::max(worst, glm::distance(estimate.project(rays[i]), places[i]));
  }
  return worst;
}

}  // namespace pleinair::support

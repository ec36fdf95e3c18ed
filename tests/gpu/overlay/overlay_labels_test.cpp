// Labels on a walkaround: they go with the machine, and lie over nothing that they point at.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "pipeline/scene/models/limits.h"
#include "tests/gpu/overlay/bench_machine.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{640, 480};
constexpr hal::Duration kPeriod = std::chrono::milliseconds(50);
constexpr glm::ivec2 kLabelPx{64, 24};

struct LabelBox {
  glm::ivec2 low, high;
  bool holds(int x, int y) const { return x >= low.x && y >= low.y && x < high.x && y < high.y; }
  int shared(const LabelBox& other) const {
    const glm::ivec2 size = glm::min(high, other.high) - glm::max(low, other.low);
    return std::max(0, size.x) * std::max(0, size.y);
  }
};

/// Slope of a line through equally spaced values, per second.
double slopeOf(const std::vector<double>& values) {
  const double middle = 0.5 * static_cast<double>(values.size() - 1);
  double product = 0.0;
  double square = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = (static_cast<double>(i) - middle) * hal::toSeconds(kPeriod);
    product += t * values[i];
    square += t * t;
  }
  return product / square;
}

/// Where a label lies relative to a point of the machine, from frame to frame.
struct Track {
  glm::dvec3 point{0.0};         ///< of its centre when it was laid out, in the model's frame
  std::vector<double> x, y;      ///< px from where the point truly is
  std::vector<Track> completed;  ///< before it was laid out again
};

/// The label of a step about four bolts, or one on each of them.
struct Walkaround {
  explicit Walkaround(bool onEach)
      : bench({.size = kSize, .framePeriod = kPeriod, .shot = hal::SyntheticShot::kWalkaround},
              {0, 1, 2, 3, 4}),
        film({.folder = kGearboxProcedure, .step = "end_bolts_off"}, bench.scene),
        painter({.pictureSize = kSize,
                 .scene = bench.scene,
                 .style = "none",
                 .readsSurfaces = onEach,
                 .overlay = true,
                 .machine = film.machine()}),
        parameters(painter.defaultParameters()) {
    overlay::OverlayContent content = *film.at(hal::Duration{0}, kSize);
    const hal::Image picture(
        {.pixelFormat = hal::PixelFormat::kRgba8, .size = {kLabelPx.x, kLabelPx.y}});
    content.labels.front().picture = picture;
    if (onEach) {
      const std::vector<std::size_t> parts = content.labels.front().parts;
      content.labels.clear();
      for (const std::size_t part : parts) {
        content.labels.push_back({.picture = picture, .parts = {part}});
      }
    }
    parameters.overlay = std::make_shared<const overlay::OverlayContent>(std::move(content));
    tracks.resize(parameters.overlay->labels.size());
  }

  const scene::Model& model() const { return *bench.scene.models[film.machine()].model; }

  void play(int frames) {
    for (int i = 0; i < frames; ++i) {
      const auto frame = bench.next().first;
      const Picture picture = hal::orThrow(painter.paint(frame, parameters));
      if (picture.overlay->trust.opacity < 1.0F) continue;
      ++shown;
      const auto labels = painter.overlayLabels();
      std::vector<LabelBox> boxes;
      for (const overlay::PlacedLabel& each : labels) {
        if (each.isShown) boxes.push_back({each.topLeft, each.topLeft + kLabelPx});
      }
      placed += static_cast<int>(boxes.size());
      countOverlaps(boxes);
      for (std::size_t k = 0; k < labels.size(); ++k) {
        if (labels[k].isShown) follow(k, labels[k], bench.trueCameraFromModel(frame.sequence));
      }
    }
  }

  void countOverlaps(const std::vector<LabelBox>& boxes) {
    if (boxes.size() < 2) return;
    for (std::size_t a = 0; a < boxes.size(); ++a) {
      for (std::size_t b = a + 1; b < boxes.size(); ++b) overlapPx += boxes[a].shared(boxes[b]);
    }
    const scene::SurfaceSnapshot surfaces = hal::orThrow(painter.surfaces());
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const std::uint32_t id = surfaces.id(x, y);
        if (id >> scene::kTriangleBits != 1) continue;
        const auto* part = scene::partOfTriangle(model(), id & (scene::kMaxTriangles - 1));
        const auto index = static_cast<std::size_t>(part - model().parts.data());
        if (parameters.overlay->looks[index] != overlay::PartLook::kFocus) continue;
        ++partPx;
        coveredPx += std::ranges::any_of(boxes, [&](const auto& box) { return box.holds(x, y); });
      }
    }
  }

  void follow(std::size_t index, const overlay::PlacedLabel& label,
              const glm::dmat4& cameraFromModel) {
    // It leaves its pixel after one, and the pose is off by a little.
    constexpr double kLaidOutAgainPx = 2.0;
    Track& track = tracks[index];
    const glm::dvec2 centre = glm::dvec2(label.topLeft) + 0.5 * glm::dvec2(kLabelPx);
    const auto& camera = *bench.scene.camera;
    const auto awayFrom = [&](const glm::dvec3& point) {
      return centre - camera.project(glm::dvec3(cameraFromModel * glm::dvec4(point, 1.0)));
    };
    const bool isNew = track.x.empty();
    const glm::dvec2 away = isNew ? glm::dvec2(0.0) : awayFrom(track.point);
    const bool jumps = glm::length(away) > kLaidOutAgainPx;
    if (isNew || jumps) {
      Track next;
      next.completed = std::move(track.completed);
      track.completed.clear();
      if (jumps) next.completed.push_back(std::move(track));
      track = std::move(next);
      double depth = HUGE_VAL;  // of the nearest part
      for (const std::size_t part : parameters.overlay->labels[index].parts) {
        const glm::dvec4 ofPart(overlay::shapeOf(model(), part).centre, 1.0);
        depth = std::min(depth, (cameraFromModel * ofPart).z);
      }
      const glm::dvec3 at = depth * camera.unproject(centre).value();
      track.point = glm::dvec3(glm::inverse(cameraFromModel) * glm::dvec4(at, 1.0));
    }
    const glm::dvec2 now = awayFrom(track.point);
    track.x.push_back(now.x);
    track.y.push_back(now.y);
  }

  BenchMachine bench;
  app::ProcedureFilm film;
  Painter painter;
  PaintParameters parameters;
  std::vector<Track> tracks;
  int shown = 0;
  int placed = 0;
  int overlapPx = 0;
  std::int64_t partPx = 0;
  std::int64_t coveredPx = 0;
};

TEST_F(OverlayTest, LabelsLieOverNothingThatTheyPointAtOnAWalkaround) {
  constexpr int kFrames = 40;
  Walkaround walk(true);
  walk.play(kFrames);
  ASSERT_EQ(walk.tracks.size(), 4U);
  EXPECT_GE(walk.shown, kFrames * 9 / 10);
  EXPECT_GE(walk.placed, 4 * walk.shown * 9 / 10);
  EXPECT_EQ(walk.overlapPx, 0);
  EXPECT_GT(walk.partPx, 1000);
  EXPECT_EQ(walk.coveredPx, 0);
}

TEST_F(OverlayTest, ALabelGoesWithTheMachineOnAWalkaround) {
  constexpr std::size_t kTwoSeconds = 40;
  Walkaround walk(false);
  walk.play(60);
  ASSERT_EQ(walk.tracks.size(), 1U);
  std::vector<Track> tracks = std::move(walk.tracks.front().completed);
  tracks.push_back(std::move(walk.tracks.front()));
  const auto lengthOf = [](const Track& each) { return each.x.size(); };
  const Track& longest = *std::ranges::max_element(tracks, {}, lengthOf);
  ASSERT_GE(longest.x.size(), kTwoSeconds) << "it is laid out again for a reason only";
  const double drift = std::hypot(slopeOf(longest.x), slopeOf(longest.y));
  std::printf("a label: %.2f px/s against the machine, for %zu frames\n", drift, longest.x.size());
  RecordProperty("label_px_per_s", std::to_string(drift));
  EXPECT_LE(drift, 0.5);
}

}  // namespace
}  // namespace pleinair

// Prints the anchors' tables of docs/measured.md as Markdown, and draws the thesis's figure 28:
// `anchors_report [PART ...]`, where a part is cells, turnover or drifts; all by default. Writes a
// PNG for each model into the current folder. Left, in red: the points of area-weighted sampling of
// the surface (thesis §5.3.1), as many as anchors in the near view. Right, in blue: the anchors.
// Top: the near view; bottom: the far one.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "hal/error.h"
#include "hal/media/png_file.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/scene/description/model_source.h"
#include "tests/reports/anchors/anchor_stage.h"
#include "tests/reports/anchors/drift_report.h"

namespace pleinair::marks {
namespace {

constexpr double kNearShare = 1.2;  // of the image's height that the model's sphere covers
constexpr double kFarShare = 0.4;
constexpr int kStandingFrames = 30;
constexpr int kTravelFrames = 90;
constexpr std::size_t kSamples = 400'000;

struct Subject {
  std::string name;
  scene::ModelSource source;
};

std::vector<Subject> subjects() {
  std::vector<Subject> all{{"gearbox", scene::GearboxSource{}}};
  for (const char* name : {"robot", "2CylinderEngine"}) {
    const std::filesystem::path path =
        std::filesystem::path(PLEINAIR_SHARED_DATA) / "models" / (std::string(name) + ".glb");
    if (std::filesystem::exists(path)) all.push_back({name, scene::FileSource{path}});
  }
  return all;
}

/// A model and its views.
class View {
 public:
  View(const scene::Model& model, const tracking::CameraModel& camera) : camera_(camera) {
    scene::ModelPose pose;
    scene::poseModel(model, std::nullopt, {}, pose);
    glm::dvec3 low(std::numeric_limits<double>::max());
    glm::dvec3 high(std::numeric_limits<double>::lowest());
    for (const Triangle& triangle : trianglesOf(model, pose, glm::dmat4(1.0))) {
      for (const glm::dvec3 corner : triangle) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
      }
    }
    middle_ = 0.5 * (low + high);
    radius_ = 0.5 * glm::distance(low, high);
  }

  /// From above at an angle; the sphere covers `share` of the image's height; turned by `yaw`.
  glm::dmat4 cameraFromModel(double share, double yaw) const {
    const double distance = 2.0 * radius_ * camera_.intrinsics().fy /
                            (share * static_cast<double>(camera_.imageSize().height));
    const glm::dmat4 placed = glm::translate(glm::dmat4(1.0), {0.0, 0.0, distance});
    const glm::dmat4 tilted = glm::rotate(placed, 1.95, {1.0, 0.0, 0.0});
    return glm::translate(glm::rotate(tilted, yaw + std::numbers::pi, {0.0, 0.0, 1.0}), -middle_);
  }

 private:
  tracking::CameraModel camera_;
  glm::dvec3 middle_{0.0};
  double radius_ = 1.0;
};

/// The first samples, as many as give the cells a mean of `mean`.
std::span<const SurfaceSample> asMany(const AnchorStage& stage, const CellGrid& grid, double mean,
                                      std::span<const SurfaceSample> samples) {
  std::size_t low = 1;
  std::size_t high = samples.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (grid.count(stage.seen(samples.first(middle))).mean < mean) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return samples.first(low);
}

void draw(hal::Image& sheet, hal::Image& picture, std::span<const glm::dvec2> points,
          std::array<std::uint8_t, 3> colour, glm::ivec2 origin) {
  const hal::FrameSize size = AnchorStage::kSize;
  const auto put = [&](int x, int y, std::array<std::uint8_t, 3> rgb) {
    std::ranges::copy(rgb, sheet.row(0, origin.y + y).begin() + 3 * std::ptrdiff_t{origin.x + x});
  };
  for (int y = 0; y < size.height; ++y) {
    const auto row = picture.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      std::array<std::uint8_t, 3> rgb{};
      for (std::size_t c = 0; c < 3; ++c) {  // lighter, so that dots stand out
        const int value = row[static_cast<std::size_t>(4 * x) + c];
        rgb.at(c) = static_cast<std::uint8_t>(150 + value * 105 / 255);
      }
      put(x, y, rgb);
    }
  }
  for (const glm::dvec2 px : points) {
    for (int k = -1; k <= 1; ++k) {
      const glm::ivec2 at(glm::floor(px));
      if (at.y < 0 || at.y >= size.height) continue;
      if (at.x + k >= 0 && at.x + k < size.width) put(at.x + k, at.y, colour);
      if (at.x >= 0 && at.x < size.width && at.y + k >= 0 && at.y + k < size.height) {
        put(at.x, at.y + k, colour);
      }
    }
  }
}

/// The number of spawned anchors that stay, per frame.
struct Turnover {
  double born = 0.0;
  double staying = 0.0;
  void add(const std::vector<Anchor>& anchors, bool onModel, double border = 0.0) {
    for (const Anchor& each : anchors) {
      const glm::vec2 size(AnchorStage::kSize.width, AnchorStage::kSize.height);
      const auto edge = static_cast<float>(border);
      const bool isInside = each.px.x >= edge && each.px.y >= edge && each.px.x < size.x - edge &&
                            each.px.y < size.y - edge;
      if (!each.isStaying() || (each.surface != 0) != onModel || !isInside) continue;
      staying += 1.0;
      if (each.isBorn()) born += 1.0;
    }
  }
  double percent() const { return staying > 0.0 ? 100.0 * born / staying : 0.0; }
};

void printRow(const std::string& name, const AnchorStage& stage,
              std::span<const SurfaceSample> samples, std::span<const SurfaceSample> kept) {
  const CellGrid grid = stage.grid();
  const CellCounts ours = grid.count(stage.places());
  const CellCounts asManyHere = grid.count(stage.seen(asMany(stage, grid, ours.mean, samples)));
  const CellCounts fixed = grid.count(stage.seen(kept));
  std::printf("| %s | %zu | %s | %s | %s |\n", name.c_str(), ours.cells, ours.text().c_str(),
              asManyHere.text().c_str(), fixed.text().c_str());
}

void report(const Subject& subject) {
  const auto model =
      std::make_shared<const scene::Model>(hal::orThrow(scene::modelOf(subject.source)));
  AnchorStage stage(model);
  const View view(*model, stage.camera());
  constexpr double kTurn = 0.5;  // rad, while it goes away
  const auto stand = [&](double share, double yaw) {
    for (int i = 0; i < kStandingFrames; ++i) stage.advance(view.cameraFromModel(share, yaw));
  };
  Turnover turnover;
  const auto travel = [&](double from, double to, double yawFrom, double yawTo) {
    for (int i = 1; i <= kTravelFrames; ++i) {
      const double t = static_cast<double>(i) / kTravelFrames;
      stage.advance(
          view.cameraFromModel(from * std::pow(to / from, t), glm::mix(yawFrom, yawTo, t)));
      turnover.add(stage.anchors(), true);
    }
  };
  hal::Image sheet({.pixelFormat = hal::PixelFormat::kRgb8,
                    .size = {2 * AnchorStage::kSize.width, 2 * AnchorStage::kSize.height}});
  const auto drawRow = [&](std::span<const SurfaceSample> samples, int row) {
    constexpr std::array<std::uint8_t, 3> kRed{200, 20, 20};
    constexpr std::array<std::uint8_t, 3> kBlue{20, 40, 200};
    hal::Image picture = stage.picture();
    const int top = row * AnchorStage::kSize.height;
    draw(sheet, picture, stage.seen(samples), kRed, {0, top});
    draw(sheet, picture, stage.places(), kBlue, {AnchorStage::kSize.width, top});
  };

  stand(kNearShare, 0.0);
  const std::vector<SurfaceSample> samples = sampleByArea(stage.triangles(), kSamples, 1);
  const CellGrid nearGrid = stage.grid();
  const auto kept = asMany(stage, nearGrid, nearGrid.count(stage.places()).mean, samples);
  printRow(subject.name + ", near", stage, samples, kept);
  drawRow(kept, 0);
  travel(kNearShare, kFarShare, 0.0, kTurn);
  stand(kFarShare, kTurn);
  printRow("– far, after going away", stage, samples, kept);
  drawRow(kept, 1);
  travel(kFarShare, kNearShare, kTurn, 0.0);
  stand(kNearShare, 0.0);
  printRow("– near again", stage, samples, kept);
  std::printf("| – born a frame while it goes and comes, of those that stay | | %.2f %% | | |\n",
              turnover.percent());
  hal::orThrow(hal::writePng(("anchors-" + subject.name + ".png"), sheet.view()));
}

void reportTurnover() {
  std::printf(
      "\n### Turnover under a pan: born a frame, of the anchors 48 px and more from the border\n\n"
      "| birth below, death above | 1.3, 0.4 px a frame | 5, 0 px a frame | anchors a cell |\n"
      "|---|---|---|---|\n");
  for (const auto& [birthBelow, deathAbove] :
       {std::pair{1, 4}, std::pair{1, 3}, std::pair{1, 2}, std::pair{2, 2}}) {
    std::string cells;
    double mean = 0.0;
    for (const glm::dvec2 speed : {glm::dvec2(-1.3, 0.4), glm::dvec2(-5.0, 0.0)}) {
      AnchorStage stage(nullptr, {.birthBelow = birthBelow, .deathAbove = deathAbove});
      Turnover turnover;
      for (int i = 0; i < 180; ++i) {
        stage.advance(glm::dmat4(1.0), {1, 0, 0, 0, 1, 0, speed.x, speed.y, 1});
        if (i >= 60) turnover.add(stage.anchors(), false, 48.0);
      }
      cells += fmt::format(" {:.2f} % |", turnover.percent());
      mean = stage.grid().count(stage.places()).mean;
    }
    std::printf("| %d, %d |%s %.2f |\n", birthBelow, deathAbove, cells.c_str(), mean);
  }
}

void reportCells() {
  std::printf(
      "### Anchors a cell of 8 × 8 px, mean ± spread, and empty cells\n\n"
      "| view | cells | ours | area-weighted, as many here | area-weighted, the near view's |\n"
      "|---|---|---|---|---|\n");
  for (const Subject& subject : subjects()) report(subject);
}

int report(const std::set<std::string>& parts) {
  const gpu::EglContext context;
  const auto wants = [&](const char* part) { return parts.empty() || parts.contains(part); };
  if (wants("cells")) reportCells();
  if (wants("turnover")) reportTurnover();
  const auto isPart = [](const std::string& part) { return part == "cells" || part == "turnover"; };
  if (!std::ranges::all_of(parts, isPart) || parts.empty()) reportDrifts(parts);
  return 0;
}

}  // namespace
}  // namespace pleinair::marks

// NOLINTNEXTLINE(bugprone-exception-escape): a report that cannot be made may end like that
int main(int argc, char** argv) {
  return pleinair::marks::report({argv + 1, argv + argc});
}

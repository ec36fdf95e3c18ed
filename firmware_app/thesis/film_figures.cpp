// Figures 26 to 28, table 1 and §6.1.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "firmware_app/thesis/field_comparison.h"
#include "firmware_app/thesis/stage_times.h"
#include "firmware_app/thesis/thesis_drawing.h"
#include "firmware_app/thesis/thesis_figures.h"
#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/measure/baselines/area_sampling.h"
#include "pipeline/measure/baselines/cell_counts.h"
#include "pipeline/measure/baselines/work_divisions.h"
#include "pipeline/measure/baselines_shaders.h"
#include "pipeline/scene/description/model_source.h"
#include "pipeline/scene/models/limits.h"
#include "pipeline/scene/scene_shaders.h"

namespace pleinair::app {
namespace {

// Figure 26.

struct Lives {
  std::vector<cv::Mat3b> shown;  // three frames, with circles
  double oldPercent = 0.0;       // of the anchors at the end
};

std::map<std::uint32_t, cv::Point2f> seenAnchors(const Painter& painter) {
  std::map<std::uint32_t, cv::Point2f> seen;
  for (const marks::Anchor& each : hal::orThrow(painter.anchors())) {
    if (each.isStaying() && each.fade > 0.9F)
      seen.emplace(each.seed, cv::Point2f(each.px.x, each.px.y));
  }
  return seen;
}

/// Anchors far from each other, within the part that all frames show.
std::map<std::uint32_t, cv::Point2f> chosenFrom(const std::map<std::uint32_t, cv::Point2f>& anchors,
                                                cv::Size size) {
  constexpr std::size_t kCircles = 14;
  const cv::Rect2f inner(
      0.2F * static_cast<float>(size.width), 0.2F * static_cast<float>(size.height),
      0.6F * static_cast<float>(size.width), 0.6F * static_cast<float>(size.height));
  std::map<std::uint32_t, cv::Point2f> chosen;
  while (chosen.size() < kCircles) {
    double farthest = 0.0;
    std::pair<std::uint32_t, cv::Point2f> next;
    for (const auto& [seed, px] : anchors) {
      if (!inner.contains(px)) continue;
      double nearest = 1e6;
      for (const auto& [other, at] : chosen) nearest = std::min(nearest, cv::norm(at - px));
      if (nearest <= farthest) continue;
      farthest = nearest;
      next = {seed, px};
    }
    if (farthest == 0.0) break;
    chosen.insert(next);
  }
  return chosen;
}

Lives livesOf(ThesisBench& bench, const char* coherence) {
  const std::uint64_t first = bench.size().settle;
  const std::uint64_t apart = (bench.size().frames - 1) / 2;
  Lives lives;
  std::map<std::uint32_t, cv::Point2f> chosen;
  double lastSeconds = 0.0;
  bench.paint(
      {.model = FilmModel::kTube, .parameters = {{"coherence", coherence}}},
      [](std::uint64_t) { return ""; },
      [&](std::uint64_t frame, Painter& painter) {
        if (frame < first || (frame - first) % apart != 0 || lives.shown.size() == 3) return;
        const auto seen = seenAnchors(painter);
        cv::Mat3b picture = matrixOf(hal::orThrow(painter.snapshot()));
        if (lives.shown.empty()) chosen = chosenFrom(seen, picture.size());
        for (const auto& [seed, px] : chosen) {
          const auto now = seen.find(seed);
          const cv::Point2f at = now != seen.end() ? now->second : px;
          for (const auto& [colour, thickness] :
               {std::pair(cv::Scalar(255, 255, 255), 4), {cv::Scalar(200, 0, 40), 2}}) {
            if (now != seen.end()) {
              cv::circle(picture, at, 10, colour, thickness, cv::LINE_AA);
            } else {
              cv::drawMarker(picture, at, colour, cv::MARKER_TILTED_CROSS, 14, thickness,
                             cv::LINE_AA);
            }
          }
        }
        lives.shown.push_back(std::move(picture));
        lastSeconds = static_cast<double>(2 * apart) / 30.0;
        double old = 0.0;
        double all = 0.0;
        for (const marks::Anchor& each : hal::orThrow(painter.anchors())) {
          if (!each.isStaying()) continue;
          all += 1.0;
          if (double{each.ageSeconds()} >= lastSeconds - 1e-3) old += 1.0;
        }
        lives.oldPercent = 100.0 * old / std::max(all, 1.0);
      });
  return lives;
}

// Figure 28.

/// The cells of 8×8 px that show the model, and counts of what lies in them.
struct DensityView {
  cv::Mat3b picture;
  std::vector<glm::dvec2> anchors;
  std::vector<glm::dvec2> samples;  // visible, of all that were drawn; in their order
  std::vector<std::size_t> sampleOf;
  measure::CellGrid grid;
};

constexpr std::uint32_t kModelObject = 1;

DensityView densityView(Painter& painter, std::span<const measure::SurfaceSample> samples) {
  const scene::SurfaceSnapshot surfaces = hal::orThrow(painter.surfaces());
  const hal::FrameSize size = surfaces.size();
  const auto isModel = [&](int x, int y) {
    return surfaces.id(x, y) >> scene::kTriangleBits == kModelObject;
  };
  std::vector<bool> covered;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) covered.push_back(isModel(x, y));
  }
  DensityView view{.picture = matrixOf(hal::orThrow(painter.composedSnapshot())),
                   .anchors = {},
                   .samples = {},
                   .sampleOf = {},
                   .grid = {size, 8, covered}};
  for (const marks::Anchor& each : hal::orThrow(painter.anchors())) {
    if (each.isStaying() && each.surface >> scene::kTriangleBits == kModelObject) {
      view.anchors.emplace_back(each.px);
    }
  }
  constexpr double kTolerance = 0.006;  // of the distance
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::uint32_t id = kModelObject << scene::kTriangleBits | samples[i].triangle;
    const glm::vec2 at(samples[i].barycentrics);
    const auto px = surfaces.place(id, at);
    const auto point = surfaces.inCamera(id, at);
    if (!px || !point) continue;
    const int x = static_cast<int>(std::floor(px->x));
    const int y = static_cast<int>(std::floor(px->y));
    if (x < 0 || y < 0 || x >= size.width || y >= size.height || !isModel(x, y)) continue;
    // Seen where the surface that the pixel shows is as far away.
    const auto shown = surfaces.inCamera(surfaces.id(x, y), surfaces.barycentrics(x, y));
    if (!shown || std::abs(shown->z - point->z) > kTolerance * point->z) continue;
    view.samples.push_back(*px);
    view.sampleOf.push_back(i);
  }
  return view;
}

/// The visible ones of the first `count` samples.
std::vector<glm::dvec2> firstOf(const DensityView& view, std::size_t count) {
  const auto end = std::ranges::lower_bound(view.sampleOf, count);
  return {view.samples.begin(), view.samples.begin() + (end - view.sampleOf.begin())};
}

/// How many samples give the cells a mean of `mean`.
std::size_t countFor(const DensityView& view, double mean, std::size_t most) {
  std::size_t low = 1;
  std::size_t high = most;
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (view.grid.count(firstOf(view, middle)).mean < mean) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

cv::Mat3b dotted(const cv::Mat3b& picture, const std::vector<glm::dvec2>& points,
                 const cv::Scalar& colour) {
  cv::Mat3b marked = pale(picture);
  for (const glm::dvec2& px : points) addDot(marked, {px.x, px.y}, colour);
  return marked;
}

gpu::ShaderLibrary fieldShaders() {
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  library.add(gpu::baselinesShaders());
  return library;
}

}  // namespace

ThesisFigure livesFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const Lives held = livesOf(bench, "0.5");
  const Lives anew = livesOf(bench, "0");
  const std::uint64_t apart = (bench.size().frames - 1) / 2;
  figure.pictures = {
      {fmt::format("Frames {} apart", apart), inColumn({inRow(held.shown), inRow(anew.shown)})}};
  figure.readings = {
      {"old_held", fmt::format("coherence 0.5: strokes older than {} frames", 2 * apart),
       held.oldPercent, "%"},
      {"old_anew", fmt::format("coherence 0: strokes older than {} frames", 2 * apart),
       anew.oldPercent, "%"}};
  figure.measured = fmt::format(
      "Of all anchors of all layers in the last frame, on the model and on what the camera sees, "
      "those that were there {} frames ({:.1f} s) before. What has come into sight since cannot "
      "be older.",
      2 * apart, static_cast<double>(2 * apart) / 30.0);
  return figure;
}

ThesisFigure densityFigure(ThesisBench& bench) {
  ThesisFigure figure;
  constexpr std::size_t kSamples = 60'000;
  const scene::Model model = hal::orThrow(
      scene::modelOf(scene::GearboxSource{.lengthMetres = 0.5, .inputRevolutions = 0}));
  scene::ModelPose pose;
  scene::poseModel(model, std::nullopt, {}, pose);
  const std::vector<measure::SurfaceSample> samples =
      measure::sampleByArea(measure::trianglesOf(model, pose, glm::dmat4(1.0)), kSamples, 1);
  // The width of strokes whose cells are 8 px wide.
  const double strokes = 8.0 / std::sqrt(2.0 * 8.0 / 3.5) *
                         std::sqrt(307200.0 / static_cast<double>(bench.size().picture.pixels()));
  std::vector<DensityView> views;
  const std::uint64_t first = bench.size().settle;
  const std::uint64_t last = first + bench.size().frames - 1;
  bench.paint(
      {.model = FilmModel::kGearbox,
       .shot = hal::SyntheticShot::kDolly,
       .parameters = {{"layers", "1"}, {"stroke_size", fmt::format("{:.4f}", strokes)}}},
      [](std::uint64_t) { return ""; },
      [&](std::uint64_t frame, Painter& painter) {
        if (frame == first || frame == last) views.push_back(densityView(painter, samples));
      });
  const cv::Scalar red(200, 20, 20);
  const cv::Scalar blue(20, 40, 200);
  const double mean = views.front().grid.count(views.front().anchors).mean;
  const std::size_t count = countFor(views.front(), mean, samples.size());
  std::vector<cv::Mat3b> rows;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const DensityView& view = views[i];
    const std::vector<glm::dvec2> drawn = firstOf(view, count);
    rows.push_back(
        inRow({dotted(view.picture, drawn, red), dotted(view.picture, view.anchors, blue)}));
    const measure::CellCounts theirs = view.grid.count(drawn);
    const measure::CellCounts ours = view.grid.count(view.anchors);
    const std::string key = i == 0 ? "first" : "last";
    const std::string text = i == 0 ? "first frame" : "last frame";
    figure.readings.push_back(
        {key + "_samples_mean", text + ", area-weighted: a cell, mean", theirs.mean, ""});
    figure.readings.push_back(
        {key + "_samples_spread", text + ", area-weighted: spread", theirs.spread, "±"});
    figure.readings.push_back(
        {key + "_samples_empty", text + ", area-weighted: empty cells", 100.0 * theirs.empty, "%"});
    figure.readings.push_back(
        {key + "_anchors_mean", text + ", anchors: a cell, mean", ours.mean, ""});
    figure.readings.push_back(
        {key + "_anchors_spread", text + ", anchors: spread", ours.spread, "±"});
    figure.readings.push_back(
        {key + "_anchors_empty", text + ", anchors: empty cells", 100.0 * ours.empty, "%"});
  }
  figure.pictures = {{"Left: area-weighted. Right: anchors. Above the first frame, below the last",
                      inColumn(rows)}};
  figure.measured = fmt::format(
      "Points in the {} cells of which nine tenths show the model; the spread is the standard "
      "deviation. Samples count where they are seen. Points drawn at random on a surface that "
      "faces the camera would read a spread of the mean's root; a gearbox with 60 parts is worse, "
      "because seen sides are slanted differently.",
      views.front().grid.cells());
  return figure;
}

ThesisFigure stagesFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const bool isQuick = bench.size().isQuick;
  struct Row {
    hal::FrameSize size;
    std::array<double, kThesisStages> thesis{};
    double total = 0.0;
  };
  std::vector<Row> rows{{{1024, 768}, {50, 173, 125, 27}, 375},
                        {{1440, 1050}, {75, 420, 215, 30}, 740}};
  if (isQuick) rows = {{bench.size().picture, {}, 0.0}};
  static constexpr std::array<const char*, kThesisStages> kNames{"tensor field", "features",
                                                                 "warping", "painting"};
  std::vector<std::pair<std::string, double>> chart;
  for (const Row& row : rows) {
    const StageTimes times = measureStages(row.size, isQuick ? 2 : 6, isQuick ? 1 : 3);
    const std::string size = fmt::format("{}x{}", row.size.width, row.size.height);
    for (std::size_t i = 0; i < kThesisStages; ++i) {
      const std::string text = fmt::format("{}: {}", size, kNames.at(i));
      if (row.total > 0.0) chart.emplace_back(text + ", thesis", row.thesis.at(i));
      chart.emplace_back(text + ", ours", times.stages.at(i));
      figure.readings.push_back(
          {fmt::format("{}_{}", row.size.width, i), text, times.stages.at(i), "ms"});
    }
    if (row.total > 0.0) chart.emplace_back(size + ": whole, thesis", row.total);
    chart.emplace_back(size + ": whole, ours", times.whole);
    figure.readings.push_back(
        {fmt::format("{}_whole", row.size.width), size + ": whole", times.whole, "ms"});
  }
  figure.pictures = {{"ms a frame", bars(chart, "ms")}};
  figure.measured =
      "Medians over rounds of the workbench's frames, without models. Stages wait for the GPU at "
      "each pass, the whole does not. On a software renderer, all of it runs on the processor: "
      "then the thesis's GPU is compared with no GPU. Run nothing else meanwhile.";
  return figure;
}

ThesisFigure divisionsFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const gpu::EglContext context;
  const gpu::ShaderLibrary library = fieldShaders();
  const hal::CapturedFrame frame = bench.cameraFrames(1).front();
  const hal::Image image(frame.image);
  const std::vector<measure::WorkDivision> ways =
      measure::timeWorkDivisions(library, image, bench.size().runs);
  std::vector<std::pair<std::string, double>> chart;
  double apart = 0.0;
  for (const measure::WorkDivision& each : ways) {
    chart.emplace_back(each.name + ": tensors", each.gradientMs);
    std::string key = each.name;
    std::ranges::replace(key, ',', '_');
    std::erase(key, ' ');
    figure.readings.push_back({key, each.name + ": initial tensors", each.gradientMs, "ms"});
    apart = std::max(apart, each.apart);
  }
  for (const measure::WorkDivision& each : ways) {
    chart.emplace_back(each.name + ": 2x2 means", each.levelMs);
    std::string key = each.name + "_level";
    std::ranges::replace(key, ',', '_');
    std::erase(key, ' ');
    figure.readings.push_back({key, each.name + ": first level of 2×2 means", each.levelMs, "ms"});
  }
  const FieldComparison found = compareField(library, image, 8.0, bench.size().runs);
  const auto angle = [&](const std::vector<double>& of, bool own) {
    return degreesAt(found, of, own, 0.5);
  };
  figure.pictures = {{fmt::format("On {}", context.info().renderer), bars(chart, "ms")}};
  figure.readings.push_back(
      {"largest_difference", "largest difference of any of them from the processor's", apart, ""});
  figure.readings.push_back(
      {"painter_ms", "the painter's field: gradients and all levels", found.pyramidMs, "ms"});
  figure.readings.push_back({"means_edges", "2×2 means, from eq. 12, regions with edges: median",
                             angle(found.meansApartRad, true), "°"});
  figure.readings.push_back({"means_filled", "2×2 means, from eq. 12, regions without: median",
                             angle(found.meansApartRad, false), "°"});
  figure.readings.push_back({"painter_edges",
                             "the painter's, from eq. 12, regions with edges: "
                             "median",
                             angle(found.apartRad, true), "°"});
  figure.readings.push_back({"painter_filled",
                             "the painter's, from eq. 12, regions without: "
                             "median",
                             angle(found.apartRad, false), "°"});
  figure.measured = fmt::format(
      "A frame of {}x{}; medians of {} runs, waiting for the GPU, on the GPU that the program "
      "uses ({}). A row or a column a thread leaves most of a real GPU idle: there are only as "
      "many threads as rows. A software renderer, which has few threads anyway, does not show "
      "that: read these times on the device in question.",
      image.size().width, image.size().height, bench.size().runs, context.info().renderer);
  return figure;
}

}  // namespace pleinair::app

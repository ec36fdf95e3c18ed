// Figures 15 to 25, 31: tensor fields, features, strokes, still pictures.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "firmware_app/thesis/field_comparison.h"
#include "firmware_app/thesis/thesis_drawing.h"
#include "firmware_app/thesis/thesis_figures.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"
#include "pipeline/gpu/context/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/measure/baselines/straight_strokes.h"
#include "pipeline/measure/image_measures.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/tracking/motion/image_motion_estimator.h"

namespace pleinair::app {
namespace {

constexpr double kSigmaPx = 8.0;  // of eq. 12: the width of the pyramid's finest regions

using Clock = std::chrono::steady_clock;
double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double quantileOf(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

// Features and how anchors are warped by them.

struct Match {
  glm::dvec2 previous, current;
};

struct Matched {
  std::vector<Match> matches;
  std::vector<double> errors;  // px, from the true motion, where that is known
  double ms = 0.0;
};

hal::Image lumaOf(const hal::ImageView& rgb) {
  hal::Image luma({.pixelFormat = hal::PixelFormat::kGrey8, .size = rgb.format.size});
  for (int y = 0; y < luma.size().height; ++y) {
    const auto from = rgb.row(0, y);
    const auto to = luma.row(0, y);
    for (std::size_t x = 0; x < to.size(); ++x) {
      to[x] = static_cast<std::uint8_t>(0.299 * from[3 * x] + 0.587 * from[3 * x + 1] +
                                        0.114 * from[3 * x + 2] + 0.5);
    }
  }
  return luma;
}

using TrueFlow = std::function<std::optional<glm::dvec2>(glm::dvec2)>;

/// Follows features through frames; the matches of the last two.
Matched matchedBy(tracking::FeatureMethod method, const std::vector<hal::Image>& lumas,
                  const TrueFlow& flow) {
  tracking::ImageMotionEstimator estimator(
      {.features = method, .flow = false, .staticRegions = false});
  Matched found;
  for (std::size_t i = 0; i < lumas.size(); ++i) {
    const hal::ImageView view = lumas[i].view();
    const Clock::time_point start = Clock::now();
    const tracking::ImageMotion& motion =
        estimator.follow(view.planes[0], view.format.size, static_cast<std::uint64_t>(i));
    found.ms = msSince(start);
    if (i + 1 < lumas.size()) continue;
    for (const tracking::FeatureMotion& each : motion.features) {
      const Match match{glm::dvec2(each.previous), glm::dvec2(each.current)};
      found.matches.push_back(match);
      if (const auto moved = flow(match.previous)) {
        found.errors.push_back(glm::distance(match.previous + *moved, match.current));
      }
    }
  }
  return found;
}

double rightPercent(const Matched& matched) {
  const auto right =
      std::ranges::count_if(matched.errors, [](double error) { return error <= 1.0; });
  return 100.0 * static_cast<double>(right) /
         static_cast<double>(std::max<std::size_t>(1, matched.errors.size()));
}

/// The three features nearest to a place that span a triangle, and where barycentric coordinates
/// take the place (thesis §4.3.3). Nothing with fewer than three.
struct Warp {
  std::array<Match, 3> corners;
  glm::dvec2 current{0.0};
};
std::optional<Warp> warped(std::vector<Match> matches, glm::dvec2 px) {
  constexpr double kLeastArea = 4.0;  // twice the triangle's, px²
  std::ranges::sort(matches, {},
                    [&](const Match& each) { return glm::distance(each.previous, px); });
  for (std::size_t third = 2; third < std::min<std::size_t>(matches.size(), 12); ++third) {
    const Match& a = matches[0];
    const Match& b = matches[1];
    const Match& c = matches[third];
    const glm::dvec2 ab = b.previous - a.previous;
    const glm::dvec2 ac = c.previous - a.previous;
    const double area = ab.x * ac.y - ab.y * ac.x;
    if (std::abs(area) < kLeastArea) continue;
    const glm::dvec2 ap = px - a.previous;
    const double v = (ap.x * ac.y - ap.y * ac.x) / area;
    const double w = (ab.x * ap.y - ab.y * ap.x) / area;
    return Warp{{a, b, c}, a.current + v * (b.current - a.current) + w * (c.current - a.current)};
  }
  return std::nullopt;
}

/// Errors of the warp at places all over the image, px.
std::vector<double> warpErrors(const std::vector<Match>& matches, const TrueFlow& flow,
                               hal::FrameSize size) {
  constexpr double kApart = 16.0;
  std::vector<double> errors;
  for (double y = 0.5 * kApart; y < size.height; y += kApart) {
    for (double x = 0.5 * kApart; x < size.width; x += kApart) {
      const auto moved = flow({x, y});
      const auto warp = warped(matches, {x, y});
      if (moved && warp) errors.push_back(glm::distance(glm::dvec2(x, y) + *moved, warp->current));
    }
  }
  return errors;
}

cv::Point pointOf(glm::dvec2 px) {
  return {static_cast<int>(std::lround(px.x)), static_cast<int>(std::lround(px.y))};
}

/// Two frames beside each other; matched features are joined.
cv::Mat3b joined(const cv::Mat3b& first, const cv::Mat3b& second, const Matched& matched) {
  cv::Mat3b sheet = inRow({pale(first), pale(second)});
  const int shift = sheet.cols - second.cols;
  static const std::array<cv::Scalar, 6> kColours{
      cv::Scalar(190, 40, 30),  cv::Scalar(30, 110, 190), cv::Scalar(40, 140, 60),
      cv::Scalar(170, 110, 10), cv::Scalar(130, 50, 160), cv::Scalar(20, 140, 150)};
  for (std::size_t i = 0; i < matched.matches.size(); ++i) {
    const cv::Scalar& colour = kColours.at(i % kColours.size());
    const cv::Point from = pointOf(matched.matches[i].previous);
    const cv::Point to = pointOf(matched.matches[i].current) + cv::Point(shift, 0);
    cv::line(sheet, from, to, colour, 1, cv::LINE_AA);
    cv::circle(sheet, from, 3, colour, 1, cv::LINE_AA);
    cv::circle(sheet, to, 3, colour, 1, cv::LINE_AA);
  }
  return sheet;
}

/// An anchor in its triangle of features, in both frames, enlarged.
cv::Mat3b warpPicture(const cv::Mat3b& first, const cv::Mat3b& second,
                      const std::vector<Match>& matches) {
  constexpr int kFactor = 5;
  const cv::Size size(std::min(96, first.cols), std::min(72, first.rows));
  const cv::Rect part(cv::Point((first.cols - size.width) / 2, (first.rows - size.height) / 2),
                      size);
  const glm::dvec2 px(part.x + 0.5 * size.width, part.y + 0.5 * size.height);
  cv::Mat3b before = enlarged(first, part, kFactor);
  cv::Mat3b after = enlarged(second, part, kFactor);
  const auto at = [&](glm::dvec2 place) {
    return pointOf(static_cast<double>(kFactor) * (place - glm::dvec2(part.x, part.y)));
  };
  if (const std::optional<Warp> warp = warped(matches, px)) {
    const cv::Scalar blue(20, 70, 200);
    const cv::Scalar red(210, 20, 20);
    for (std::size_t i = 0; i < 3; ++i) {
      const Match& a = warp->corners.at(i);
      const Match& b = warp->corners.at((i + 1) % 3);
      cv::line(before, at(a.previous), at(b.previous), blue, 2, cv::LINE_AA);
      cv::line(after, at(a.current), at(b.current), blue, 2, cv::LINE_AA);
      cv::circle(before, at(a.previous), 5, blue, cv::FILLED, cv::LINE_AA);
      cv::circle(after, at(a.current), 5, blue, cv::FILLED, cv::LINE_AA);
    }
    cv::circle(before, at(px), 6, red, cv::FILLED, cv::LINE_AA);
    cv::circle(after, at(warp->current), 6, red, cv::FILLED, cv::LINE_AA);
  }
  return inRow({before, after});
}

// Paintings of a still picture.

/// The workbench without noise: the report's photograph.
hal::CapturedFrame photograph(const ThesisBench& bench) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = bench.size().picture,
                               .frameCount = 1,
                               .shot = hal::SyntheticShot::kStill,
                               .noiseSigma = 0.0},
                              clock);
  hal::orThrow(camera.start({}));
  hal::NextFrame next = camera.next(hal::kNoDeadline);
  hal::CapturedFrame frame = std::get<hal::CapturedFrame>(std::move(next));
  const auto owned = std::make_shared<const hal::Image>(frame.image);
  frame.image = owned->view();
  frame.lease = owned;
  return frame;
}

struct StillPainting {
  cv::Mat3b picture;
  double ms = 0.0;  // a frame, the second one: the first allocates
};

StillPainting paintedStill(ThesisBench& bench, const hal::CapturedFrame& frame,
                           const std::vector<std::pair<std::string, std::string>>& parameters,
                           const std::string& view = "") {
  Painter& painter = bench.plainPainter();
  PaintParameters set = painter.defaultParameters();
  for (const auto& [name, value] : parameters) set.style = set.style.with(name, value);
  set.view = view;
  StillPainting still;
  for (int i = 0; i < 2; ++i) {
    painter.reset();
    const Clock::time_point start = Clock::now();
    hal::orThrow(painter.paint(frame, set));
    still.picture = matrixOf(hal::orThrow(painter.snapshot()));
    still.ms = msSince(start);
  }
  return still;
}

cv::Mat3f floatOf(const cv::Mat3b& picture) {
  cv::Mat3f converted;
  picture.convertTo(converted, CV_32FC3, 1.0 / 255.0);
  return converted;
}

double meanApart(const cv::Mat3b& a, const cv::Mat3b& b) {
  cv::Mat3b apart;
  cv::absdiff(a, b, apart);
  const cv::Scalar mean = cv::mean(apart);
  return (mean[0] + mean[1] + mean[2]) / 3.0;
}

/// DEP and DET (docs/measuring.md) of one painting.
double departureOf(const cv::Mat3b& painted, const cv::Mat3b& input) {
  return 255.0 *
         std::sqrt(measure::deviation(floatOf(painted), floatOf(input)).value().value_or(0));
}
double detailOf(const cv::Mat3b& painted, const cv::Mat3b& input) {
  const auto rms = [](const cv::Mat3b& picture) {
    return std::sqrt(measure::meanSquare(measure::highPass(floatOf(picture))).value().value_or(0));
  };
  return rms(painted) / std::max(rms(input), 1e-9);
}

cv::Rect middleOf(const cv::Mat3b& picture, cv::Size size) {
  return partAround(cv::Mat1b(picture.size(), std::uint8_t{0}), size);
}

}  // namespace

ThesisFigure fieldFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const std::uint64_t first = bench.size().settle;
  const std::vector<std::string> views{"tensors", "pyramid", "regions", "layers", "skeletons"};
  std::vector<cv::Mat3b> shown;
  cv::Mat3b composed;
  bench.paint(
      {.model = FilmModel::kGearbox},
      [&](std::uint64_t frame) {
        return frame >= first && frame < first + views.size() ? views[frame - first] : "";
      },
      [&](std::uint64_t frame, Painter& painter) {
        if (frame < first || frame >= first + views.size()) return;
        if (frame == first) composed = matrixOf(hal::orThrow(painter.composedSnapshot()));
        shown.push_back(matrixOf(hal::orThrow(painter.snapshot())));
      });
  const gpu::EglContext context;
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  const hal::Image image = imageOf(composed);
  const FieldComparison found = compareField(library, image, kSigmaPx, bench.size().runs);
  figure.pictures = {
      {"The AR frame, and its tensor field: blue from edges, red filled in (16)",
       inRow({composed, shown[0]})},
      {"Four levels of the pyramid (15), and what is painted finely (red), middlingly (yellow) "
       "and broadly (blue)",
       inRow({shown[1], shown[2]})},
      {"Strokes and skeletons in their layer's colour, from coarse, blue, to fine, red (21)",
       inRow({shown[3], shown[4]})},
      {"Where the field differs from global interpolation", matrixOf(errorMap(found, image))}};
  const auto angle = [&](const std::vector<double>& apart, bool own, double part) {
    return degreesAt(found, apart, own, part);
  };
  figure.readings = {
      {"edges_median", "from eq. 12, regions with edges: median", angle(found.apartRad, true, 0.5),
       "°"},
      {"edges_95", "from eq. 12, regions with edges: 95 %", angle(found.apartRad, true, 0.95), "°"},
      {"filled_median", "from eq. 12, regions without: median", angle(found.apartRad, false, 0.5),
       "°"},
      {"holes", "regions that eq. 11 leaves without a direction (below 1/1000)", found.holesPercent,
       "%"},
      {"pyramid_ms", "our field, gradients and all levels, on the GPU in use", found.pyramidMs,
       "ms"},
      {"global_ms", "eq. 12 at the middle of each region, one core", found.globalMs, "ms"}};
  figure.measured = fmt::format(
      "Regions of 8×8 px, σ = {} px; {} edge pixels above a third of the strongest or {}, of "
      "gradients of colours. Both fields are of the same frame; the angle is that between their "
      "lines. Our "
      "field interpolates within 5×5 regions on each level, so it is local: where it differs, "
      "eq. 12 averages edges from further away.",
      kSigmaPx, found.edgePixels, marks::kMaxLeading);
  return figure;
}

ThesisFigure featureFigure(ThesisBench& bench) {
  ThesisFigure figure;
  constexpr std::uint64_t kFrames = 6;
  const std::vector<hal::CapturedFrame> frames = bench.cameraFrames(kFrames);
  hal::SteppedClock clock;
  const hal::SyntheticCamera truth({.size = bench.size().picture}, clock);
  const TrueFlow flow = [&](glm::dvec2 px) -> std::optional<glm::dvec2> {
    const hal::FlowVector moved = truth.flow(kFrames - 2, kFrames - 1, px);
    return moved.visible ? std::optional(moved.px) : std::nullopt;
  };
  std::vector<hal::Image> lumas;
  for (const hal::CapturedFrame& each : frames) lumas.push_back(lumaOf(each.image.map().view()));
  const Matched thesis = matchedBy(tracking::FeatureMethod::kHarrisSift, lumas, flow);
  const Matched ours = matchedBy(tracking::FeatureMethod::kLucasKanade, lumas, flow);
  const cv::Mat3b before = matrixOf(hal::Image(frames[kFrames - 2].image));
  const cv::Mat3b after = matrixOf(hal::Image(frames[kFrames - 1].image));
  figure.pictures = {{"Above: Harris corners matched by SIFT. Below: Lucas-Kanade",
                      inColumn({joined(before, after, thesis), joined(before, after, ours)})},
                     {"An anchor and its three features in both frames",
                      warpPicture(before, after, ours.matches)}};
  for (const auto& [key, name, matched] :
       {std::tuple("thesis", "Harris and SIFT", &thesis), {"ours", "Lucas-Kanade", &ours}}) {
    const std::vector<double> errors = warpErrors(matched->matches, flow, bench.size().picture);
    figure.readings.push_back({std::string(key) + "_matches", std::string(name) + ": matches",
                               static_cast<double>(matched->matches.size()), ""});
    figure.readings.push_back({std::string(key) + "_right",
                               std::string(name) + ": within 1 px of the true motion",
                               rightPercent(*matched), "%"});
    figure.readings.push_back({std::string(key) + "_warp_median",
                               std::string(name) + ": error of a warped anchor, median",
                               quantileOf(errors, 0.5), "px"});
    figure.readings.push_back({std::string(key) + "_warp_95",
                               std::string(name) + ": error of a warped anchor, 95 %",
                               quantileOf(errors, 0.95), "px"});
    figure.readings.push_back(
        {std::string(key) + "_ms", std::string(name) + ": time of a frame", matched->ms, "ms"});
  }
  const MeasuredFilm& film = bench.measured({.model = FilmModel::kGearbox});
  if (film.report.inside && film.report.inside->drift) {
    figure.readings.push_back({"anchors_95", "the program's anchors, all sources: drift, 95 %",
                               film.report.inside->drift->percentile95, "px"});
  }
  figure.measured =
      "The true motion is known from the workbench's geometry. Warped anchors stand 16 px apart "
      "all over the frame. The program's own anchors choose among surfaces, planes, the dominant "
      "motion, features and dense flow, by predicted error (decisions 0013 and 0014).";
  return figure;
}

ThesisFigure strokeFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const hal::CapturedFrame frame = photograph(bench);
  const StillPainting thesis = paintedStill(bench, frame, {{"quads", "thesis"}});
  const StillPainting ours = paintedStill(bench, frame, {});
  const StillPainting skeletons = paintedStill(bench, frame, {}, "skeletons");
  const cv::Rect part = middleOf(ours.picture, {104, 80});
  figure.pictures.push_back(
      {"Skeletons; 4 (n + 2) quads a stroke; as few as it bends",
       inRow({enlarged(skeletons.picture, part, 3), enlarged(thesis.picture, part, 3),
              enlarged(ours.picture, part, 3)})});
  std::vector<cv::Mat3b> brushes;
  double least = 255.0;
  for (const char* brush : {"round", "flat", "dry", "knife", "marker", "pencil"}) {
    const cv::Mat3b painted =
        paintedStill(bench, frame, {{"brush", brush}, {"layers", "2"}, {"stroke_size", "8"}})
            .picture;
    if (!brushes.empty()) {
      least = std::min(least, meanApart(enlarged(painted, part, 3), brushes.back()));
    }
    brushes.push_back(enlarged(painted, part, 3));
  }
  figure.pictures.push_back({"Round, flat, dry; knife, marker, pencil",
                             inColumn({inRow({brushes[0], brushes[1], brushes[2]}),
                                       inRow({brushes[3], brushes[4], brushes[5]})})});
  figure.readings = {
      {"quads_apart", "paintings with either number of quads differ by",
       meanApart(thesis.picture, ours.picture), "levels"},
      {"quads_thesis_ms", "a frame with the thesis's quads", thesis.ms, "ms"},
      {"quads_ours_ms", "a frame with few quads", ours.ms, "ms"},
      {"brushes_apart", "the two most alike of the brushes shown after each other differ by", least,
       "levels"}};
  figure.measured =
      "One frame each, from an empty canvas; times include tracking and reading the picture. "
      "Differences are means over all pixels and channels.";
  return figure;
}

ThesisFigure photographFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const hal::CapturedFrame frame = photograph(bench);
  const StillPainting ours = paintedStill(bench, frame, {});
  const hal::Image image(frame.image);
  // As wide as the painter's own.
  const double scale = std::sqrt(static_cast<double>(image.size().pixels()) / 307200.0);
  measure::StraightStrokeOptions widths;
  widths.finestPixels = std::max(3.0, 4.0 * scale);
  const measure::StraightStrokePainting straight = measure::paintWithStraightStrokes(image, widths);
  const cv::Mat3b input = matrixOf(image);
  const cv::Mat3b baseline = matrixOf(straight.picture);
  const cv::Rect part = middleOf(input, {104, 80});
  figure.pictures = {
      {"The picture; this program's painting; straight strokes",
       inColumn({input, ours.picture, baseline})},
      {"The same from near", inRow({enlarged(input, part, 3), enlarged(ours.picture, part, 3),
                                    enlarged(baseline, part, 3)})}};
  figure.readings = {
      {"dep_ours", "ours: distance from the picture, after a tone curve (DEP)",
       departureOf(ours.picture, input), "levels"},
      {"dep_straight", "straight strokes: the same", departureOf(baseline, input), "levels"},
      {"det_ours", "ours: detail kept (DET)", detailOf(ours.picture, input), ""},
      {"det_straight", "straight strokes: detail kept", detailOf(baseline, input), ""},
      {"strokes_straight", "straight strokes: how many", static_cast<double>(straight.strokes), ""},
      {"ms_ours", "ours: a frame, on the GPU in use", ours.ms, "ms"},
      {"ms_straight_field", "straight strokes: their field, one core", straight.fieldMs, "ms"},
      {"ms_straight_draw", "straight strokes: drawing, one core", straight.drawMs, "ms"}};
  figure.measured =
      "DEP and DET as in docs/measuring.md: a painting should depart from its picture and keep its "
      "detail (DET about 1).";
  return figure;
}

ThesisFigure blendingFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const hal::CapturedFrame frame = photograph(bench);
  const cv::Mat3f exact = floatOf(matrixOf(hal::Image(frame.image)));
  constexpr int kSettle = 12;
  constexpr double kNoiseLevels = 2.0;
  std::vector<cv::Mat3b> rows;
  for (const auto& [key, name, memory] :
       {std::tuple("short", "memory 0.0111 s (weight 0.05)", "0.0111"),
        {"long", "memory 0.65 s (weight 0.95)", "0.65"}}) {
    Painter& painter = bench.plainPainter();
    painter.reset();
    PaintParameters set = painter.defaultParameters();
    set.style = set.style.with("memory", memory);
    std::vector<cv::Mat3b> skeletons;
    for (int i = 0; i < kSettle + 2; ++i) {
      const auto noisy = std::make_shared<const hal::Image>(
          measure::withSensorNoise(exact, kNoiseLevels, static_cast<std::uint64_t>(i)));
      hal::CapturedFrame next = frame;
      next.image = noisy->view();
      next.lease = noisy;
      next.sequence = static_cast<std::uint64_t>(i);
      next.captureTime = hal::TimePoint(hal::Duration(33'333'333) * i);
      set.view = i >= kSettle ? "skeletons" : "";
      hal::orThrow(painter.paint(next, set));
      if (i >= kSettle) skeletons.push_back(matrixOf(hal::orThrow(painter.snapshot())));
    }
    cv::Mat3b changed = pale(skeletons[1]);
    cv::Mat3b apart;
    cv::absdiff(skeletons[0], skeletons[1], apart);
    double count = 0.0;
    for (int y = 0; y < apart.rows; ++y) {
      for (int x = 0; x < apart.cols; ++x) {
        const cv::Vec3b& by = apart(y, x);
        if (std::max({by[0], by[1], by[2]}) <= 24) continue;
        changed(y, x) = {200, 20, 20};
        count += 1.0;
      }
    }
    rows.push_back(inRow({skeletons[1], changed}));
    figure.readings.push_back({std::string("changed_") + key,
                               std::string(name) + ": pixels of the skeletons that changed",
                               100.0 * count / static_cast<double>(apart.total()), "%"});
  }
  figure.pictures = {{"Skeletons, and where they differ from the frame before", inColumn(rows)}};
  figure.measured = fmt::format(
      "σ = {} levels of noise, the frames {} and {} of a standing camera; pixels that differ by "
      "more than 24 levels. The memory of the field of directions is shortened alike.",
      kNoiseLevels, kSettle, kSettle + 1);
  return figure;
}

}  // namespace pleinair::app

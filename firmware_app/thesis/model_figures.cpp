// Figures 29, 30, 32 to 42: models.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "firmware_app/thesis/thesis_drawing.h"
#include "firmware_app/thesis/thesis_figures.h"
#include "hal/error.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/scene/models/limits.h"

namespace pleinair::app {
namespace {

using measure::Region;
using measure::Subject;

const cv::Size kCrop(120, 90);
constexpr int kCropFactor = 4;

/// The sentence that says how the figures of a film were measured.
std::string howMeasured(const ThesisBench& bench) {
  return fmt::format(
      "Over {} frames at {}x{} of a film whose true motion is known: the hand-held camera's, and "
      "that of each point of the model as it was posed (docs/measuring.md).",
      bench.size().frames, bench.size().picture.width, bench.size().picture.height);
}

void addIf(ThesisFigure& figure, const std::string& key, const std::string& text,
           const std::optional<double>& value, const std::string& unit) {
  if (value) figure.readings.push_back({key, text, *value, unit});
}

const measure::RegionSummary& onModels(const measure::Report& report) {
  static const measure::RegionSummary kNone;
  return report.models ? report.models->regions[Region::kVirtual][Subject::kPainting] : kNone;
}

/// nHW2, POP and S10 on the model.
void addCoherence(ThesisFigure& figure, const std::string& key, const std::string& text,
                  const measure::Report& report) {
  const measure::RegionSummary& values = onModels(report);
  addIf(figure, key + "_nhw2", text + ": nHW2 on the model (0: carried, 1: unrelated)", values.nHw2,
        "");
  addIf(figure, key + "_pop", text + ": POP on the model", values.popPercent, "%");
  addIf(figure, key + "_s10", text + ": S10 on the model, marks found ten frames later",
        values.s10Percent, "%");
}

/// Marks on the model, and how far they are from where the surface goes.
void addSlip(ThesisFigure& figure, const std::string& key, const std::string& text,
             const measure::Report& report) {
  if (!report.models || !report.models->anchors) return;
  const measure::ModelAnchorSummary& anchors = *report.models->anchors;
  figure.readings.push_back(
      {key + "_anchors", text + ": anchors that stay in sight", anchors.anchors, ""});
  figure.readings.push_back(
      {key + "_turnover", text + ": born or gone a frame, of these", anchors.turnoverPercent, "%"});
  if (anchors.slip) {
    figure.readings.push_back(
        {key + "_slip", text + ": slip a frame, median", anchors.slip->median, "px"});
    figure.readings.push_back(
        {key + "_slip95", text + ": slip a frame, 95 %", anchors.slip->percentile95, "px"});
  }
  if (anchors.longSlip) {
    figure.readings.push_back({key + "_slip10", text + ": slip over ten frames, 95 %",
                               anchors.longSlip->percentile95, "px"});
  }
}

std::vector<cv::Mat3b> outputsOf(const MeasuredFilm& film) {
  std::vector<cv::Mat3b> pictures;
  for (const FilmFrame& frame : film.frames) pictures.push_back(frame.output);
  return pictures;
}

/// The same part of the model, enlarged, in three frames that follow each other.
cv::Mat3b zoomedRow(const MeasuredFilm& film) {
  std::vector<cv::Mat3b> parts;
  for (const FilmFrame& frame : film.frames) {
    parts.push_back(enlarged(frame.output, partAround(frame.models, kCrop), kCropFactor / 2));
  }
  return inRow(parts);
}

/// Anchors and skeletons of the model from near, and paintings, at four moments.
struct Views {
  std::vector<cv::Mat3b> anchors, skeletons, paintings;
};

cv::Mat1b maskOf(const scene::SurfaceSnapshot& surfaces) {
  cv::Mat1b mask(surfaces.size().height, surfaces.size().width);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      mask(y, x) = surfaces.id(x, y) >> scene::kTriangleBits == 1U ? 255 : 0;
    }
  }
  return mask;
}

Views viewsOf(ThesisBench& bench, FilmModel model) {
  Views views;
  const std::uint64_t settle = bench.size().settle;
  const std::uint64_t apart = (bench.size().frames - 1) / 3;
  // Each moment is of three frames that follow each other.
  const auto phase = [=](std::uint64_t frame) -> std::uint64_t {
    return frame < settle ? 3 : std::min<std::uint64_t>((frame - settle) % apart, 3);
  };
  bench.paint(
      {.model = model},
      [&](std::uint64_t frame) -> std::string {
        return phase(frame) == 1 ? "anchors" : phase(frame) == 2 ? "skeletons" : "";
      },
      [&](std::uint64_t frame, Painter& painter) {
        if (phase(frame) == 3 || views.skeletons.size() == 4) return;
        cv::Mat3b shown = matrixOf(hal::orThrow(painter.snapshot()));
        if (phase(frame) != 0) {
          const cv::Size half(shown.cols / 2, shown.rows / 2);
          shown = enlarged(shown, partAround(maskOf(hal::orThrow(painter.surfaces())), half), 2);
        }
        (phase(frame) == 0   ? views.paintings
         : phase(frame) == 1 ? views.anchors
                             : views.skeletons)
            .push_back(shown);
      });
  for (std::vector<cv::Mat3b>* each : {&views.paintings, &views.anchors, &views.skeletons}) {
    each->resize(std::min<std::size_t>(each->size(), 4));
  }
  return views;
}

/// Two in a row.
cv::Mat3b sheetOf(const std::vector<cv::Mat3b>& pictures) {
  std::vector<cv::Mat3b> rows;
  for (std::size_t i = 0; i + 1 < pictures.size(); i += 2) {
    rows.push_back(inRow({pictures[i], pictures[i + 1]}));
  }
  return rows.empty() ? pictures.front() : inColumn(rows);
}

ThesisFigure modelFigure(ThesisBench& bench, FilmModel model, const std::string& key,
                         const std::string& text) {
  ThesisFigure figure;
  const Views views = viewsOf(bench, model);
  figure.pictures = {
      {"Anchors of all layers, on the model and beside it, red ones are young; four moments",
       sheetOf(views.anchors)},
      {"Skeletons in their layer's colour, a frame later", sheetOf(views.skeletons)},
      {"The paintings", sheetOf(views.paintings)}};
  addSlip(figure, key, text, bench.measured({.model = model}).report);
  figure.measured = howMeasured(bench) +
                    " Slip is the distance of an anchor from where its point of the surface goes.";
  return figure;
}

/// Root mean square of the painting's high pass, in levels, on models.
double reliefOf(const FilmFrame& frame) {
  cv::Mat3f picture;
  frame.output.convertTo(picture, CV_32FC3, 1.0 / 255.0);
  const cv::Mat1f grey = measure::greyOf(measure::highPass(picture));
  double sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      if (frame.models(y, x) == 0) continue;
      sum += double{grey(y, x)} * double{grey(y, x)};
      count += 1.0;
    }
  }
  return count > 0.0 ? 255.0 * std::sqrt(sum / count) : 0.0;
}

/// How far the painting's colours are from the picture's, both smoothed, within 5 px on both sides
/// of models' outlines: levels.
double bleedingOf(const FilmFrame& frame) {
  constexpr int kReach = 11;
  cv::Mat1b inner;
  cv::Mat1b outer;
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, {kReach, kReach});
  cv::erode(frame.models, inner, disc);
  cv::dilate(frame.models, outer, disc);
  cv::Mat3f painted;
  cv::Mat3f seen;
  frame.output.convertTo(painted, CV_32FC3);
  frame.input.convertTo(seen, CV_32FC3);
  cv::GaussianBlur(painted, painted, {}, 1.5);
  cv::GaussianBlur(seen, seen, {}, 1.5);
  cv::Mat3f apart;
  cv::absdiff(painted, seen, apart);
  const cv::Scalar mean = cv::mean(apart, outer & ~inner);
  return (mean[0] + mean[1] + mean[2]) / 3.0;
}

template <class Value>
double meanOver(const MeasuredFilm& film, const Value& valueOf) {
  double sum = 0.0;
  for (const FilmFrame& frame : film.frames) sum += valueOf(frame);
  return sum / static_cast<double>(std::max<std::size_t>(1, film.frames.size()));
}

/// Left and right of one film painted in two ways: two whole frames each, then enlarged parts.
void addComparison(ThesisFigure& figure, const MeasuredFilm& left, const std::string& leftName,
                   const MeasuredFilm& right, const std::string& rightName) {
  const std::vector<cv::Mat3b> a = outputsOf(left);
  const std::vector<cv::Mat3b> b = outputsOf(right);
  const std::size_t last = a.size() - 1;
  figure.pictures.push_back(
      {fmt::format("Left: {}. Right: {}. The first and the last measured frame", leftName,
                   rightName),
       inColumn({inRow({a.front(), b.front()}), inRow({a[last], b[last]})})});
  figure.pictures.push_back({fmt::format("The model from near at four moments. Above: {}. Below: "
                                         "{}",
                                         leftName, rightName),
                             inColumn({zoomedRow(left), zoomedRow(right)})});
}

/// One way of painting a film.
struct Arm {
  std::string key;   // of its readings
  std::string name;  // for people
  FilmRequest request;
};

/// The same film painted in two ways: pictures side by side, and coherence on the model.
struct Arms {
  const MeasuredFilm& first;
  const MeasuredFilm& second;
};

Arms compared(ThesisFigure& figure, ThesisBench& bench, const Arm& first, const Arm& second) {
  const Arms arms{bench.measured(first.request), bench.measured(second.request)};
  addComparison(figure, arms.first, first.name, arms.second, second.name);
  addCoherence(figure, first.key, first.name, arms.first.report);
  addCoherence(figure, second.key, second.name, arms.second.report);
  return arms;
}

/// A value of both arms, as means over the shown frames.
void addMeans(ThesisFigure& figure, const Arms& arms, const std::string& key,
              const std::string& text, double (*valueOf)(const FilmFrame&)) {
  figure.readings.push_back(
      {key + "_off", "without: " + text, meanOver(arms.first, valueOf), "levels"});
  figure.readings.push_back(
      {key + "_on", "with: " + text, meanOver(arms.second, valueOf), "levels"});
}

ThesisFigure spacesFigure(ThesisBench& bench, FilmModel model) {
  ThesisFigure figure;
  const Arm image{"image_space", "image space", {.model = model, .isImageSpace = true}};
  const Arm own{"model_space", "model space", {.model = model}};
  const Arms arms = compared(figure, bench, image, own);
  addSlip(figure, image.key, image.name, arms.first.report);
  addSlip(figure, own.key, own.name, arms.second.report);
  figure.measured =
      howMeasured(bench) +
      " Both paint the very same film. In image space, the models are put into the pictures "
      "first, and the painter and its tracker see a plain video.";
  return figure;
}

}  // namespace

ThesisFigure staticModelFigure(ThesisBench& bench) {
  return modelFigure(bench, FilmModel::kGearbox, "static", "static model");
}

ThesisFigure skinnedModelFigure(ThesisBench& bench) {
  return modelFigure(bench, FilmModel::kTube, "skinned", "skinned model");
}

ThesisFigure morphingModelFigure(ThesisBench& bench) {
  return modelFigure(bench, FilmModel::kBall, "morphing", "morphing model");
}

ThesisFigure staticSpacesFigure(ThesisBench& bench) {
  return spacesFigure(bench, FilmModel::kGearbox);
}

ThesisFigure animatedSpacesFigure(ThesisBench& bench) {
  return spacesFigure(bench, FilmModel::kTube);
}

ThesisFigure memoryFigure(ThesisBench& bench) {
  ThesisFigure figure;
  compared(figure, bench,
           {"weight_005",
            "weight 0.05",
            {.model = FilmModel::kGearbox, .parameters = {{"memory", "0.0111"}}}},
           {"weight_095", "weight 0.95", {.model = FilmModel::kGearbox}});
  figure.measured = howMeasured(bench) + " Anchors are carried in the same way in both.";
  return figure;
}

ThesisFigure clipFigure(ThesisBench& bench) {
  ThesisFigure figure;
  const Arms arms = compared(figure, bench,
                             {"clip_off",
                              "without clipping",
                              {.model = FilmModel::kTube, .parameters = {{"clip", "false"}}}},
                             {"clip_on", "with clipping", {.model = FilmModel::kTube}});
  addMeans(figure, arms, "bleeding", "colours off at the outline", bleedingOf);
  const auto seam = [](const MeasuredFilm& film) {
    return film.report.models
               ? film.report.models->regions[Region::kSeam][Subject::kPainting].popPercent
               : std::nullopt;
  };
  addIf(figure, "seam_pop_off", "without: POP within 8 px of the outline", seam(arms.first), "%");
  addIf(figure, "seam_pop_on", "with: POP within 8 px of the outline", seam(arms.second), "%");
  figure.measured =
      howMeasured(bench) +
      " Colours off at the outline: mean difference of painting and picture, both smoothed by "
      "1.5 px, within 5 px on both sides of the model's outline. Part of it is the look's own: "
      "oil is warmer and more saturated than the picture.";
  return figure;
}

ThesisFigure bumpFigure(ThesisBench& bench) {
  // Thick paint, as impasto's: oil's is too thin for its relief to be told apart.
  const std::vector<std::pair<std::string, std::string>> thick{
      {"relief", "2.6"}, {"brush", "round"}, {"gloss", "0.12"}};
  auto flat = thick;
  flat.emplace_back("bump", "off");
  ThesisFigure figure;
  const Arms arms =
      compared(figure, bench,
               {"bump_off", "texture only", {.model = FilmModel::kGearbox, .parameters = flat}},
               {"bump_on", "bump mapping", {.model = FilmModel::kGearbox, .parameters = thick}});
  addMeans(figure, arms, "fine_contrast", "fine contrast on the model", reliefOf);
  figure.measured =
      "Fine contrast: root mean square of the luma that is finer than a Gaussian of 6 px. "
      "Relief must not cost coherence: " +
      howMeasured(bench);
  return figure;
}

}  // namespace pleinair::app

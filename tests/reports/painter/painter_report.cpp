// Prints the painter's tables of docs/measured.md as Markdown.
// `painter_report fields FOLDER [PICTURE ...]`: the tensor pyramid compared with the global
// radial-basis interpolation; writes error maps into FOLDER; uses the shared data by default.
// `painter_report table1`: the thesis's table 1 and the same for pleinair; run nothing else
// meanwhile.
// `painter_report parts PHOTOGRAPH [WIDTHxHEIGHT [FRAMES]]`: the effect of each part of its
// coherence, on moving images; half an hour at 640x480 and 30 frames.
// `painter_report lives FOLDER PHOTOGRAPH`: the counterpart of the thesis's figure 26, as a PNG in
// FOLDER.
// `painter_report hidden PHOTOGRAPH ...`: how many strokes of a painting at rest are invisible.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"
#include "hal/media/picture_file.h"
#include "pipeline/engine/painter.h"
#include "pipeline/gpu/egl_context.h"
#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/styles/registry.h"
#include "tests/reports/painter/coherence_parts.h"
#include "tests/reports/painter/field_comparison.h"
#include "tests/reports/painter/hidden_strokes.h"
#include "tests/reports/painter/living_strokes.h"

namespace pleinair {
namespace {

constexpr double kSigmaPx = 8.0;  // for eq. 12: the width of the pyramid's finest regions
constexpr int kFrames = 16;
constexpr int kRounds = 7;

double degreesAt(std::vector<double> apartRad, double part) {
  if (apartRad.empty()) return 0.0;
  std::ranges::sort(apartRad);
  const auto last = static_cast<double>(apartRad.size() - 1);
  return apartRad[static_cast<std::size_t>(part * last)] * 180.0 / std::numbers::pi;
}

std::vector<std::filesystem::path> sharedPictures() {
  std::vector<std::filesystem::path> found;
  const std::filesystem::path folder =
      std::filesystem::path(PLEINAIR_SHARED_DATA) / "photos" / "cc0_pd_skimage";
  if (!std::filesystem::exists(folder)) return found;
  for (const auto& each : std::filesystem::directory_iterator(folder)) {
    const std::string extension = each.path().extension().string();
    if (extension == ".png" || extension == ".jpg") found.push_back(each.path());
  }
  std::ranges::sort(found);
  return found;
}

void compareFields(const std::filesystem::path& folder,
                   const std::vector<std::filesystem::path>& pictures) {
  const gpu::EglContext context;
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  fmt::print(
      "Tensor pyramid (GPU) beside global radial-basis interpolation (eq. 12, sigma {} px, at the\n"
      "middle of each 8x8 region). Angles in degrees, median / 95 %; where regions have edges of\n"
      "their own, and where both fill in. The thesis's pyramid and eq. 12 on one core.\n\n",
      kSigmaPx);
  fmt::print(
      "| picture | size | edge px | with edges | filled in | pyramid, GPU | pyramid, CPU | "
      "eq. 12, CPU |\n|---|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& path : pictures) {
    const hal::Image image = hal::orThrow(hal::readPictureRgb(path));
    const marks::FieldComparison found = marks::compareField(library, image, kSigmaPx);
    std::vector<double> own;
    std::vector<double> filled;
    for (std::size_t i = 0; i < found.apartRad.size(); ++i) {
      (found.hasEdges[i] ? own : filled).push_back(found.apartRad[i]);
    }
    fmt::print(
        "| {} | {}x{} | {} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | {:.1f} ms | {:.1f} ms | "
        "{:.0f} ms |\n",
        path.stem().string(), image.size().width, image.size().height, found.edgePixels,
        degreesAt(own, 0.5), degreesAt(own, 0.95), degreesAt(filled, 0.5), degreesAt(filled, 0.95),
        found.pyramidMs, found.oracleMs, found.globalMs);
    std::fflush(stdout);
    const hal::Image map = marks::errorMap(found, image);
    hal::orThrow(hal::writePng(folder / (path.stem().string() + "_field_error.png"), map.view()));
  }
}

/// The thesis's four stages (table 1).
enum Stage : std::size_t { kTensor, kFeatures, kWarping, kPainting, kStages };

/// Whether a pass is one of those, by the begin of its name.
bool beginsWithOneOf(std::string_view pass, std::initializer_list<std::string_view> names) {
  return std::ranges::any_of(names, [&](std::string_view name) { return pass.starts_with(name); });
}

Stage stageOf(const std::string& pass) {
  if (beginsWithOneOf(pass, {"marks: gradient", "marks: edge_", "marks: tensor_"})) return kTensor;
  if (pass == "follow picture") return kFeatures;
  if (beginsWithOneOf(pass, {"marks: feature_layers", "marks: motion_field", "marks: anchor_"}))
    return kWarping;
  return kPainting;
}

std::vector<hal::CapturedFrame> workbench(hal::FrameSize size) {
  hal::SteppedClock clock;
  hal::SyntheticCamera camera({.size = size, .frameCount = kFrames}, clock);
  hal::orThrow(camera.start({}));
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < kFrames; ++i) {
    hal::NextFrame next = camera.next(hal::kNoDeadline);
    frames.push_back(std::get<hal::CapturedFrame>(std::move(next)));
  }
  return frames;
}

/// Paints the workbench's frames forwards and backwards, repeatedly.
class Easel {
 public:
  Easel(hal::FrameSize size, gpu::PassTiming timing)
      : frames_(workbench(size)),
        painter_({.pictureSize = size,
                  .scene = {},
                  .style = "painterly",
                  .tracksTags = false,
                  .passTiming = timing}),
        parameters_(painter_.defaultParameters()) {
    round();
  }

  /// ms per frame.
  double round() {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < kFrames; ++i) {
      const std::size_t at = isBack_ ? kFrames - 1 - i : i;
      hal::CapturedFrame frame = frames_[at];
      frame.sequence = number_;
      frame.captureTime =
          hal::TimePoint(hal::Duration(33'333'333) * static_cast<std::int64_t>(number_++));
      hal::orThrow(painter_.paint(frame, parameters_));
    }
    hal::orThrow(painter_.snapshot());  // waits for the GPU
    isBack_ = !isBack_;
    const auto end = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(end - start).count() / kFrames;
  }

  /// Totals since the start.
  std::array<double, kStages> stages() const {
    std::array<double, kStages> sums{};
    for (const gpu::PassTime& each : painter_.passTimes()) {
      sums.at(stageOf(each.pass)) += std::chrono::duration<double, std::milli>(each.total).count();
    }
    return sums;
  }

 private:
  std::vector<hal::CapturedFrame> frames_;
  Painter painter_;
  PaintParameters parameters_;
  std::uint64_t number_ = 0;
  bool isBack_ = false;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void printTable1() {
  struct Row {
    hal::FrameSize size;
    std::array<int, kStages> thesis{};
    int total = 0;
  };
  constexpr std::array<Row, 2> kRows{
      {{{1440, 1050}, {75, 420, 215, 30}, 740}, {{1024, 768}, {50, 173, 125, 27}, 375}}};
  fmt::print(
      "\nThesis table 1 (Core2Duo 2 GHz, ATI 5730) beside ours, ms a frame, medians of {} rounds "
      "of\n"
      "{} frames of the workbench. Stages wait for the GPU at each pass, the whole does not.\n\n",
      kRounds, kFrames);
  fmt::print(
      "| size | | tensor field | features | warping | painting | whole |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Row& row : kRows) {
    std::array<std::vector<double>, kStages> stages;
    {
      Easel easel(row.size, gpu::PassTiming::kFences);
      for (int i = 0; i < kRounds; ++i) {
        const std::array<double, kStages> before = easel.stages();
        easel.round();
        const std::array<double, kStages> after = easel.stages();
        for (std::size_t k = 0; k < kStages; ++k) {
          stages.at(k).push_back((after.at(k) - before.at(k)) / kFrames);
        }
      }
    }
    Easel easel(row.size, gpu::PassTiming::kOff);
    std::vector<double> whole;
    whole.reserve(kRounds);
    for (int i = 0; i < kRounds; ++i) whole.push_back(easel.round());
    fmt::print("| {}x{} | thesis | {} | {} | {} | {} | {} |\n", row.size.width, row.size.height,
               row.thesis[0], row.thesis[1], row.thesis[2], row.thesis[3], row.total);
    fmt::print("| | ours | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", median(stages[0]),
               median(stages[1]), median(stages[2]), median(stages[3]), median(whole));
    std::fflush(stdout);
  }
}

using Arguments = std::vector<std::string>;

void reportFields(const Arguments& arguments) {
  std::vector<std::filesystem::path> pictures(arguments.begin() + 1, arguments.end());
  compareFields(arguments[0], pictures.empty() ? sharedPictures() : pictures);
}

void reportParts(const Arguments& arguments) {
  hal::FrameSize size{640, 480};
  MeasuredLength length;
  if (arguments.size() > 1) {
    const std::size_t by = arguments[1].find('x');
    if (by == std::string::npos) throw std::invalid_argument("a size is WIDTHxHEIGHT");
    size = {std::stoi(arguments[1]), std::stoi(arguments[1].substr(by + 1))};
  }
  if (arguments.size() > 2) length.frames = std::stoull(arguments[2]);
  printCoherenceParts(arguments[0], size, length);
}

gpu::ShaderLibrary allShaders() {
  gpu::ShaderLibrary library;
  library.add(gpu::gpuShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  styles::addStyleShaders(library);
  return library;
}

void reportLives(const Arguments& arguments) {
  const gpu::EglContext context;
  const gpu::ShaderLibrary library = allShaders();
  const std::filesystem::path file = std::filesystem::path(arguments[0]) / "living_strokes.png";
  hal::orThrow(hal::writePng(file, livingStrokes(library, arguments[1]).view()));
}

void reportHidden(const Arguments& photographs) {
  const gpu::EglContext context;
  const gpu::ShaderLibrary library = allShaders();
  fmt::print(
      "Strokes at rest, 640x480, of each layer from coarse to fine; and the part of them that "
      "later ones hide.\n\n| picture | layers | in all |\n|---|---|---|\n");
  for (const std::string& path : photographs) {
    const auto input = hal::orThrow(measure::openPhotograph(path, {.noiseLevels = 0, .frames = 1}));
    const hal::CapturedFrame frame = *hal::orThrow(input->next());
    LayerUse all;
    std::string layers;
    for (const LayerUse& each : strokesInUse(library, hal::Image(frame.image))) {
      layers += fmt::format("{}{}: {:.0f} %", layers.empty() ? "" : ", ", each.strokes,
                            100.0 * static_cast<double>(each.hidden) /
                                static_cast<double>(std::max<std::size_t>(1, each.strokes)));
      all.strokes += each.strokes;
      all.hidden += each.hidden;
    }
    fmt::print("| {} | {} | {}: {:.1f} % |\n", std::filesystem::path(path).stem().string(), layers,
               all.strokes,
               100.0 * static_cast<double>(all.hidden) / static_cast<double>(all.strokes));
    std::fflush(stdout);
  }
}

struct Section {
  const char* name;
  std::size_t leastArguments;
  std::size_t mostArguments;
  std::function<void(const Arguments&)> report;
  const char* usage;
};

const std::array<Section, 5>& sections() {
  static const std::array<Section, 5> kSections{{
      {"fields", 1, 1000, reportFields, "fields FOLDER [PICTURE ...]"},
      {"table1", 0, 0, [](const Arguments&) { printTable1(); }, "table1"},
      {"parts", 1, 3, reportParts, "parts PHOTOGRAPH [WIDTHxHEIGHT [FRAMES]]"},
      {"lives", 2, 2, reportLives, "lives FOLDER PHOTOGRAPH"},
      {"hidden", 1, 1000, reportHidden, "hidden PHOTOGRAPH ..."},
  }};
  return kSections;
}

int run(const Arguments& given) {
  const Arguments arguments(given.begin() + (given.empty() ? 0 : 1), given.end());
  for (const Section& each : sections()) {
    if (given.empty() || given[0] != each.name || arguments.size() < each.leastArguments ||
        arguments.size() > each.mostArguments) {
      continue;
    }
    each.report(arguments);
    return 0;
  }
  for (const Section& each : sections()) std::fprintf(stderr, "painter_report %s\n", each.usage);
  return 2;
}

}  // namespace
}  // namespace pleinair

int main(int argc, char** argv) {
  try {
    return pleinair::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "painter_report: %s\n", error.what());
    return 1;
  }
}

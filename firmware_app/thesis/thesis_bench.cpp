#include "firmware_app/thesis/thesis_bench.h"

#include <algorithm>

#include <fmt/format.h>

#include "firmware_app/offline/measured_engine.h"
#include "firmware_app/scene/workbench_scene.h"
#include "hal/error.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/scene/description/scene_file.h"
#include "pipeline/styles/registry.h"

namespace pleinair::app {
namespace {

using hal::orThrow;

constexpr const char* kStyle = "painterly";
constexpr std::size_t kShownFrames = 4;

const char* nameOf(FilmModel model) {
  switch (model) {
    case FilmModel::kNone:
      return "workbench";
    case FilmModel::kGearbox:
      return "gearbox";
    case FilmModel::kTube:
      return "tube";
    case FilmModel::kBall:
      return "ball";
  }
  return "";
}

/// The film's [[model]] in a scene.
std::string tableOf(FilmModel model) {
  if (model == FilmModel::kNone) return "";
  const char* const keys = model == FilmModel::kBall   ? "diameter_m = 0.32"
                           : model == FilmModel::kTube ? "length_m = 0.5"
                                                       : "length_m = 0.5\nspeed_rpm = 0\n"
                                                         "rotation_deg = [0, 0, 12]";
  return fmt::format("\n[[model]]\nsource = \"builtin:{}\"\nattach = \"tag:0\"\n{}\n",
                     nameOf(model), keys);
}

hal::SyntheticOptions filmOf(const ThesisSize& size,
                             hal::SyntheticShot shot = hal::SyntheticShot::kWalkaround) {
  return {.size = size.picture, .frameCount = size.settle + size.frames, .shot = shot};
}

scene::Scene sceneOf(FilmModel model, const ThesisSize& size) {
  if (model == FilmModel::kNone) return {};
  hal::SteppedClock clock;
  const hal::SyntheticCamera camera(filmOf(size), clock);
  return scene::parseScene(workbenchSetting(camera.truth(0), size.picture) + tableOf(model),
                           "the film's scene", ".");
}

PaintParameters parametersOf(const Painter& painter, const FilmRequest& request) {
  PaintParameters parameters = painter.defaultParameters();
  for (const auto& [name, value] : request.parameters) {
    parameters.style = parameters.style.with(name, value);
  }
  return parameters;
}

std::string nameOf(const FilmRequest& request) {
  std::string name = nameOf(request.model);
  if (request.isImageSpace) name += ", image space";
  for (const auto& [key, value] : request.parameters) name += fmt::format(", {} = {}", key, value);
  return name;
}

/// Keeps some of the frames that another one paints.
class KeepingPainter final : public measure::MeasuredPainter {
 public:
  KeepingPainter(measure::MeasuredPainter& inner, const ThesisSize& size)
      : inner_(inner), size_(size) {}

  hal::Result<measure::PaintedFrame> paint(const hal::CapturedFrame& frame) override {
    hal::Result<measure::PaintedFrame> painted = inner_.paint(frame);
    if (painted && isShown(number_)) {
      frames_.push_back({.input = matrixOf(painted->input),
                         .output = matrixOf(painted->output),
                         .models = painted->models ? painted->models->mask() : cv::Mat1b(),
                         .anchors = painted->anchors});
    }
    ++number_;
    return painted;
  }
  void reset() override { inner_.reset(); }
  std::vector<FilmFrame> take() { return std::move(frames_); }

 private:
  bool isShown(std::uint64_t number) const {
    if (number < size_.settle) return false;
    for (std::size_t i = 0; i < kShownFrames; ++i) {
      if (number - size_.settle == i * (size_.frames - 1) / (kShownFrames - 1)) return true;
    }
    return false;
  }

  measure::MeasuredPainter& inner_;
  ThesisSize size_;
  std::uint64_t number_ = 0;
  std::vector<FilmFrame> frames_;
};

}  // namespace

ThesisSize quickThesisSize() {
  // Smaller frames would show tags too small to be found.
  return {.picture = {320, 240}, .settle = 3, .frames = 11, .runs = 1, .isQuick = true};
}

ThesisBench::ThesisBench(ThesisSize size, std::function<bool()> goesOn)
    : size_(size), goesOn_(std::move(goesOn)) {}

ThesisBench::~ThesisBench() = default;

void ThesisBench::throwIfInterrupted() const {
  if (!goesOn_()) throw ThesisInterrupted{};
}

Painter& ThesisBench::painterOf(FilmModel model, bool isComposer) {
  std::unique_ptr<Painter>& painter = painters_[{model, isComposer}];
  if (!painter) {
    const bool hasModel = model != FilmModel::kNone;
    painter = std::make_unique<Painter>(PainterOptions{
        .pictureSize = size_.picture,
        .scene = sceneOf(model, size_),
        .style = isComposer ? "none" : kStyle,
        .tracksTags = hasModel,
        .expectedFormat =
            hal::FrameFormat{.pixelFormat = hal::PixelFormat::kRgb8, .size = size_.picture},
        .readsSurfaces = hasModel});
  }
  return *painter;
}

Painter& ThesisBench::plainPainter() {
  return painterOf(FilmModel::kNone, false);
}

const MeasuredFilm& ThesisBench::measured(const FilmRequest& request) {
  if (const auto known = films_.find(request); known != films_.end()) return known->second;
  Painter* const composer = request.isImageSpace ? &painterOf(request.model, true) : nullptr;
  Painter& painter = composer != nullptr ? plainPainter() : painterOf(request.model, false);
  const auto input = orThrow(measure::openWorkbench(filmOf(size_, request.shot)));
  MeasuredEngine engine(painter, parametersOf(painter, request), size_.picture,
                        {.readsModels = request.model != FilmModel::kNone, .composer = composer});
  KeepingPainter keeping(engine, size_);
  keeping.reset();
  std::optional<measure::Report> report =
      orThrow(measure::measure(*input, keeping,
                               {.style = kStyle,
                                .coherence = styles::styleKind(kStyle).coherence,
                                .settings = nameOf(request),
                                .frames = size_.frames,
                                .settle = size_.settle,
                                .stillFrames = 0,
                                .goesOn = goesOn_}));
  if (!report) throw ThesisInterrupted{};
  for (const measure::Verdict& control : report->controls) {
    if (control.state != measure::Verdict::State::kFailed) continue;
    failedControls_.push_back(
        fmt::format("{}: {}: {}", nameOf(request), control.what, control.found));
  }
  std::vector<FilmFrame> frames = keeping.take();
  const bool isSeen = std::ranges::all_of(
      frames, [](const FilmFrame& each) { return cv::countNonZero(each.models) > 0; });
  if (request.model != FilmModel::kNone && !isSeen) {
    throw hal::Failure({.kind = hal::ErrorKind::kInternal,
                        .subject = nameOf(request),
                        .problem = "the model is not seen in all frames of the film",
                        .remedy = "report this with the size of the films"});
  }
  return films_.emplace(request, MeasuredFilm{std::move(*report), std::move(frames)}).first->second;
}

void ThesisBench::paint(const FilmRequest& request,
                        const std::function<std::string(std::uint64_t)>& viewOf,
                        const std::function<void(std::uint64_t, Painter&)>& each) {
  Painter& painter = painterOf(request.model, false);
  painter.reset();
  PaintParameters parameters = parametersOf(painter, request);
  const auto input = orThrow(measure::openWorkbench(filmOf(size_, request.shot)));
  for (std::uint64_t i = 0; i < size_.settle + size_.frames; ++i) {
    throwIfInterrupted();
    const std::optional<hal::CapturedFrame> frame = orThrow(input->next());
    if (!frame) return;
    parameters.view = viewOf(i);
    orThrow(painter.paint(*frame, parameters));
    each(i, painter);
  }
}

std::vector<hal::CapturedFrame> ThesisBench::cameraFrames(std::uint64_t count) {
  std::vector<hal::CapturedFrame> frames;
  const auto input = orThrow(measure::openWorkbench(filmOf(size_)));
  while (frames.size() < count) {
    throwIfInterrupted();
    const std::optional<hal::CapturedFrame> frame = orThrow(input->next());
    if (!frame) return frames;
    // The camera's buffers are few: a copy of its own.
    const auto owned = std::make_shared<const hal::Image>(frame->image);
    hal::CapturedFrame kept = *frame;
    kept.image = owned->view();
    kept.lease = owned;
    frames.push_back(std::move(kept));
  }
  return frames;
}

cv::Mat3b matrixOf(const hal::Image& rgb) {
  cv::Mat3b matrix(rgb.size().height, rgb.size().width);
  for (int y = 0; y < matrix.rows; ++y) {
    const auto row = rgb.view().row(0, y);
    std::copy_n(row.data(), row.size(), matrix.ptr<std::uint8_t>(y));
  }
  return matrix;
}

hal::Image imageOf(const cv::Mat3b& rgb) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = {rgb.cols, rgb.rows}});
  for (int y = 0; y < rgb.rows; ++y) {
    const auto row = image.row(0, y);
    std::copy_n(rgb.ptr<std::uint8_t>(y), row.size(), row.data());
  }
  return image;
}

}  // namespace pleinair::app

#include "pipeline/paint_chain.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "config/suggestion.h"
#include "hal/error.h"
#include "pipeline/present/present_shaders.h"
#include "pipeline/styles/style_registry.h"

namespace pleinair {
namespace {

constexpr std::string_view kCameraView = "camera";
constexpr std::string_view kArView = "ar";

gpu::ShaderLibrary makeLibrary(const PainterOptions& options) {
  gpu::ShaderLibrary library(options.shaderDirectory);
  library.add(gpu::presentShaders());
  library.add(gpu::sceneShaders());
  styles::addStyleShaders(library);
  return library;
}

tracking::Tracker makeTracker(const scene::Scene& scene, hal::FrameSize frame) {
  if (scene.camera) tracking::requireSize(*scene.camera, frame, "calibration of the scene");
  std::optional<tracking::CameraModel> camera = scene.camera;
  if (!camera && !scene.tags.empty()) camera = scene::assumedCamera(frame);
  tracking::TrackerOptions options;
  options.detector.family = scene.tagFamily;
  return {camera, scene.tags, options};
}

}  // namespace

PaintChain::PaintChain(const PainterOptions& options, const gpu::ContextInfo& context)
    : pictureSize_(options.pictureSize),
      scene_(options.scene),
      tracksTags_(options.tracksTags),
      library_(makeLibrary(options)),
      timer_(options.passTiming, &context),
      uploader_(library_),
      renderer_(library_, options.scene),
      style_(styles::makeStyle(options.style, library_)) {
  warmUp();
}

/// A grey frame through the whole chain: every program is compiled, every texture allocated, and
/// each state drawn once (GPU rules, rule 14).
void PaintChain::warmUp() {
  const hal::Image grey({.pixelFormat = hal::PixelFormat::kGrey8, .size = pictureSize_});
  const gpu::Texture& camera = uploader_.upload(grey.view(), pictureSize_);
  renderer_.warmUp(pictureSize_);
  const scene::ArFrame& frame = renderer_.compose(camera, scene::assumedCamera(pictureSize_),
                                                  scene::PoseSet{}, 0, hal::TimePoint{}, timer_);
  style_->paint(frame, {}, timer_);
  style_->reset();
}

PaintParameters PaintChain::defaultParameters() const {
  return {.style = style_->parameters(), .view = {}};
}

std::vector<PainterView> PaintChain::views() const {
  std::vector<PainterView> views{
      {std::string(kCameraView), "what the camera shows, at the picture's size"},
      {std::string(kArView), "the camera's picture with the models in it, before the style"}};
  for (const styles::ViewInfo& view : style_->views()) {
    views.push_back({std::string(view.name), std::string(view.help)});
  }
  return views;
}

Picture PaintChain::paint(const hal::CapturedFrame& frame, const PaintParameters& parameters) {
  tracking::TrackingResult tracked = track(frame);
  {
    const auto scope = timer_.measure("camera picture");
    camera_ = &uploader_.upload(frame.image, pictureSize_);
  }
  sightings_.clear();
  for (const tracking::TrackedTag& tag : tracked.tags) {
    if (tag.cameraFromTag) sightings_.push_back({tag.id, *tag.cameraFromTag});
  }
  const scene::ArFrame& arFrame = renderer_.compose(
      *camera_, *pictureCamera_, {.cameraFromWorld = tracked.cameraFromWorld, .tags = sightings_},
      frame.sequence, frame.captureTime, timer_);
  picture_ = &paintView(arFrame, parameters);
  submitToReaders(frame);
  return {.texture = picture_->name(),
          .size = picture_->size(),
          .sequence = frame.sequence,
          .captureTime = frame.captureTime,
          .tracking = std::move(tracked)};
}

tracking::TrackingResult PaintChain::track(const hal::CapturedFrame& frame) {
  const hal::FrameSize size = frame.image.format.size;
  if (!tracker_ || trackedSize_ != size) {
    tracker_.emplace(makeTracker(scene_, size));
    trackedSize_ = size;
    pictureCamera_ = scene::fittedCamera(
        scene_.camera ? *scene_.camera : scene::assumedCamera(size), pictureSize_);
  }
  if (!tracksTags_) return {};
  return tracker_->track(frame.image, frame.captureTime);
}

const gpu::Texture& PaintChain::paintView(const scene::ArFrame& frame,
                                          const PaintParameters& parameters) {
  const std::string& view = parameters.view;
  const bool isOurs = view == kCameraView || view == kArView;
  if (!isOurs) requireView(view);
  style_->setParameters(parameters.style);
  // The style's state advances the same whatever is looked at.
  const gpu::Texture& painted = style_->paint(frame, isOurs ? std::string_view{} : view, timer_);
  if (view == kCameraView) return *camera_;
  return view == kArView ? *frame.colour : painted;
}

void PaintChain::requireView(const std::string& view) const {
  if (view.empty()) return;
  std::vector<std::string> names;
  for (const PainterView& each : views()) names.push_back(each.name);
  if (std::ranges::find(names, view) != names.end()) return;
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                     .subject = "--view",
                                     .problem = config::unknownText("view", view, names)});
}

int PaintChain::openReader(const hal::FrameFormat& format) {
  readers_.push_back(std::make_unique<Reader>(present::PictureReader(library_, format)));
  return static_cast<int>(readers_.size()) - 1;
}

void PaintChain::submitToReaders(const hal::CapturedFrame& frame) {
  const auto scope = timer_.measure("read back");
  for (const auto& reader : readers_) {
    if (!reader->ring.hasRoom()) {
      ++reader->skipped;
      continue;
    }
    reader->ring.submit(*picture_);
    reader->underWay.push_back({frame.sequence, frame.captureTime});
  }
}

bool PaintChain::take(int number, ReadPicture& picture, bool wait) {
  Reader& reader = at(number);
  if (!reader.ring.take(picture.image, wait)) return false;
  picture.sequence = reader.underWay.front().sequence;
  picture.captureTime = reader.underWay.front().captureTime;
  reader.underWay.erase(reader.underWay.begin());
  return true;
}

hal::Image PaintChain::still() const {
  return read(*picture_);
}

hal::Image PaintChain::cameraStill() const {
  return read(*camera_);
}

hal::Image PaintChain::read(const gpu::Texture& texture) const {
  present::PictureReader reader(
      library_, {.pixelFormat = hal::PixelFormat::kRgb8, .size = texture.size()}, 1);
  reader.submit(texture);
  hal::Image image;
  reader.take(image, true);
  return image;
}

void PaintChain::reset() {
  style_->reset();
  if (tracker_) tracker_->reset();
}

std::vector<gpu::PassTime> PaintChain::passTimes() const {
  return {timer_.times().begin(), timer_.times().end()};
}

}  // namespace pleinair

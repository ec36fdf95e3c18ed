#include "pipeline/paint_chain.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "config/suggestion.h"
#include "hal/error.h"
#include "pipeline/gpu/cover_fit.h"
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

/// The context, if it takes pictures of this size: asked before anything is allocated.
const gpu::ContextInfo& checked(const gpu::ContextInfo& context, hal::FrameSize pictureSize) {
  hal::orThrow(gpu::checkDeviceLimit(context, pictureSize, "picture size"));
  return context;
}

bool isOurs(std::string_view view) {
  return view == kCameraView || view == kArView;
}

}  // namespace

PaintChain::PaintChain(const PainterOptions& options, const gpu::ContextInfo& context)
    : context_(checked(context, options.pictureSize)),
      pictureSize_(options.pictureSize),
      scene_(options.scene),
      tracksTags_(options.tracksTags),
      library_(makeLibrary(options)),
      timer_(options.passTiming, &context),
      uploader_(library_),
      renderer_(library_, options.scene),
      style_(styles::makeStyle(options.style, library_)) {
  hal::orThrow(tracking::checkTagFamily(scene_.tagFamily));
  warmUp(options.expectedFormat);
}

/// A blank frame through the whole chain, untimed: all that frames of the expected format need is
/// compiled, allocated and drawn once (GPU rules, rule 14). Conversions of other layouts are linked
/// by now, but a driver may finish them at their first frame. Readers warm up when they are opened.
void PaintChain::warmUp(const std::optional<hal::FrameFormat>& expected) {
  const hal::Image blank(expected.value_or(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = pictureSize_}));
  hal::orThrow(gpu::checkDeviceLimit(context_, blank.size(), "frame size"));
  gpu::PassTimer untimed;
  const gpu::Texture& camera = uploader_.upload(blank.view(), pictureSize_);
  renderer_.warmUp(pictureSize_);
  const scene::ArFrame& frame = renderer_.compose(camera, scene::assumedCamera(pictureSize_),
                                                  scene::PoseSet{}, 0, hal::TimePoint{}, untimed);
  style_->paint(frame, {}, untimed);
  style_->reset();
}

PaintParameters PaintChain::defaultParameters() const {
  return {.style = style_->parameters(), .view = {}};
}

std::vector<PainterView> viewsOf(std::string_view style) {
  std::vector<PainterView> views{
      {std::string(kCameraView), "what the camera shows, at the picture's size"},
      {std::string(kArView), "the camera's picture with the models in it, before the style"}};
  for (const styles::ViewInfo& view : styles::styleInfo(style).views) {
    views.push_back({std::string(view.name), std::string(view.help)});
  }
  return views;
}

std::vector<PainterView> PaintChain::views() const {
  return viewsOf(style_->name());
}

std::vector<PainterLook> PaintChain::looks() const {
  std::vector<PainterLook> looks;
  for (const styles::Look& look : styles::styleInfo(style_->name()).looks) {
    looks.push_back({std::string(look.name), std::string(look.help)});
  }
  return looks;
}

config::ParameterValues PaintChain::lookParameters(std::string_view look) const {
  return styles::styleInfo(style_->name()).parametersOf(look);
}

hal::Result<void> PaintChain::checkView(const std::string& view) const {
  if (view.empty() || isOurs(view)) return {};
  const auto ofStyle = style_->views();
  if (std::ranges::find(ofStyle, view, &styles::ViewInfo::name) != ofStyle.end()) return {};
  std::vector<std::string> names;
  for (const PainterView& each : views()) names.push_back(each.name);
  return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                   .subject = "view \"" + view + "\"",
                                   .problem = config::unknownText("view", view, names),
                                   .remedy = "choose one of: " + config::listText(names)});
}

/// Makes ready for frames of this size; nothing changes where the scene's calibration is not.
hal::Result<void> PaintChain::adaptTo(hal::FrameSize frameSize) {
  if (frameSize_ == frameSize) return {};
  if (scene_.camera) {
    if (auto fits = tracking::checkSize(*scene_.camera, frameSize, "calibration of the scene");
        !fits) {
      return fits;
    }
  }
  const tracking::CameraModel camera =
      scene_.camera ? *scene_.camera : scene::assumedCamera(frameSize);
  if (tracksTags_) {
    tracking::TrackerOptions options;
    options.detector.family = scene_.tagFamily;
    tracker_.emplace(camera, scene_.tags, options);
  }
  pictureCamera_ = scene::fittedCamera(camera, pictureSize_);
  frameSize_ = frameSize;
  return {};
}

hal::Result<Picture> PaintChain::paint(const hal::CapturedFrame& frame,
                                       const PaintParameters& parameters) {
  try {
    return paintChecked(frame, parameters);
  } catch (const hal::StartupError& error) {  // no memory for frames of a new size or layout
    return tl::unexpected(error.error());
  }
}

hal::Result<Picture> PaintChain::paintChecked(const hal::CapturedFrame& frame,
                                              const PaintParameters& parameters) {
  if (auto known = checkView(parameters.view); !known) {
    return tl::unexpected(std::move(known.error()));
  }
  if (auto fits = gpu::checkDeviceLimit(context_, frame.image.format.size, "frame"); !fits) {
    return tl::unexpected(std::move(fits.error()));
  }
  if (auto adapted = adaptTo(frame.image.format.size); !adapted) {
    return tl::unexpected(std::move(adapted.error()));
  }
  tracking::TrackingResult tracked;
  if (tracker_) tracked = tracker_->track(frame.image, frame.captureTime);
  picture_ = &paintView(compose(frame, tracked), parameters);
  submitToReaders(frame);
  glFlush();  // the GPU works on while the next frame is tracked
  return Picture{.texture = picture_->name(),
                 .size = picture_->size(),
                 .sequence = frame.sequence,
                 .captureTime = frame.captureTime,
                 .tracking = tracked};
}

scene::ArFrame PaintChain::compose(const hal::CapturedFrame& frame,
                                   const tracking::TrackingResult& tracked) {
  {
    const auto scope = timer_.measure("camera picture");
    camera_ = &uploader_.upload(frame.image, pictureSize_);
  }
  sightings_.clear();
  for (const tracking::TrackedTag& tag : tracked.tags) {
    if (tag.cameraFromTag) sightings_.push_back({tag.id, *tag.cameraFromTag});
  }
  scene::ArFrame composed = renderer_.compose(
      *camera_, *pictureCamera_, {.cameraFromWorld = tracked.cameraFromWorld, .tags = sightings_},
      frame.sequence, frame.captureTime, timer_);
  if (style_->usesCanvas()) composed.canvasFromPicture = followCanvas(frame.image);
  return composed;
}

/// Motion is followed in the captured frame; the canvas has the picture's pixels.
tracking::PlaneSimilarity PaintChain::followCanvas(const hal::ImageView& image) {
  const gpu::CoverFit fit = gpu::coverFit(image.format.size, pictureSize_);
  const tracking::PlaneSimilarity frameFromPicture{{fit.scale.x, 0.0}, fit.origin};
  return frameFromPicture.inverse() * motion_.follow(luma_.convert(image), image.format.size) *
         frameFromPicture;
}

const gpu::Texture& PaintChain::paintView(const scene::ArFrame& frame,
                                          const PaintParameters& parameters) {
  const std::string_view view = parameters.view;
  style_->setParameters(parameters.style);
  // The style's state advances the same whatever is looked at.
  const gpu::Texture& painted =
      style_->paint(frame, isOurs(view) ? std::string_view{} : view, timer_);
  if (view == kCameraView) return *camera_;
  return view == kArView ? *frame.colour : painted;
}

int PaintChain::openReader(const hal::FrameFormat& format) {
  hal::orThrow(gpu::checkDeviceLimit(context_, present::PictureReader::packedSize(format),
                                     "picture to be read"));
  auto reader = std::make_unique<Reader>(present::PictureReader(library_, format));
  reader->ring.warmUp(pictureSize_);
  readers_.push_back(std::move(reader));
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

hal::Image PaintChain::still() {
  assert(picture_ != nullptr);
  return read(*picture_);
}

hal::Image PaintChain::cameraStill() {
  assert(camera_ != nullptr);
  return read(*camera_);
}

hal::Image PaintChain::read(const gpu::Texture& texture) {
  const hal::FrameFormat format{.pixelFormat = hal::PixelFormat::kRgb8, .size = texture.size()};
  if (!stills_ || stills_->format() != format) stills_.emplace(library_, format, 1);
  stills_->submit(texture);
  hal::Image image;
  stills_->take(image, true);
  return image;
}

void PaintChain::reset() {
  style_->reset();
  motion_.reset();
  if (tracker_) tracker_->reset();
}

std::vector<gpu::PassTime> PaintChain::passTimes() const {
  return {timer_.times().begin(), timer_.times().end()};
}

}  // namespace pleinair

#include "pipeline/engine/frame_pipeline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <span>
#include <utility>

#include "config/suggestion.h"
#include "hal/error.h"
#include "pipeline/engine/debug_views.h"
#include "pipeline/engine/quality_levels.h"
#include "pipeline/gpu/images/aspect_fill.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/overlay/overlay_shaders.h"
#include "pipeline/present/present_shaders.h"
#include "pipeline/styles/registry.h"

namespace pleinair {
namespace {

gpu::ShaderLibrary makeLibrary(const PainterOptions& options, const gpu::ContextInfo& context) {
  gpu::ShaderLibrary library(options.shaderDirectory);
  library.add(gpu::presentShaders());
  library.add(gpu::sceneShaders());
  library.add(gpu::marksShaders());
  library.add(gpu::overlayShaders());
  styles::addStyleShaders(library);
  library.setCancellation(options.isCancelled);
  library.setPassForm(options.passForm.value_or(gpu::fasterPassForm(context)));
  library.setListDispatch(options.listDispatch.value_or(gpu::fasterListDispatch(context)));
  return library;
}

/// Gives the context. Throws if it does not support this size, before anything is allocated.
const gpu::ContextInfo& checked(const gpu::ContextInfo& context, hal::FrameSize pictureSize) {
  hal::orThrow(gpu::checkDeviceLimit(context, pictureSize, "picture size"));
  return context;
}

/// A software GPU does not hang, so it gets more time before it counts as lost.
gpu::GpuTestHook hookOf(const PainterOptions& options, const gpu::ContextInfo& context) {
  gpu::GpuTestHook testHook = options.testHook;
  if (context.isSoftware && testHook.patience == gpu::GpuTestHook{}.patience)
    testHook.patience = std::chrono::minutes(1);
  return testHook;
}

/// Unset if no model is lit by an estimate from the camera's image.
std::optional<scene::LightEstimator> makeLightEstimator(const PainterOptions& options) {
  const scene::Scene& scene = options.scene;
  if (!options.tracksTags || !scene.light.isEstimated || scene.models.empty()) return std::nullopt;
  std::vector<std::optional<int>> places;
  for (const scene::SceneModel& model : scene.models) places.push_back(model.tagId);
  std::optional<glm::dvec3> towardKey;
  const bool isAttached = scene.light.frame == scene::Light::Frame::kAttached;
  if (scene.light.hasDirection && isAttached) towardKey = scene.light.towardLight;
  return scene::LightEstimator(scene.tags, scene.tagFamily, places, towardKey);
}

}  // namespace

ContextScope::ContextScope(const PainterGl& gl, gpu::ResetMonitor* monitor) {
  const bool isLost = monitor != nullptr && monitor->loss();
  if (!gl.own) {
    if (!isLost) hostState_.emplace();
    return;
  }
  if (gl.own->isCurrent()) return;
  previous_.emplace();
  if (gl.own->makeCurrent()) return;
  assert(monitor != nullptr);
  monitor->note(gpu::gpuLost("its context cannot be made current", GL_NO_ERROR));
}

FramePipeline::FramePipeline(const PainterOptions& options, PainterGl gl)
    : gl_(std::move(gl)),
      testHook_(hookOf(options, checked(gl_.info, options.pictureSize))),
      resetMonitor_(testHook_),
      pictureSize_(options.pictureSize),
      scene_(options.scene),
      tracksTags_(options.tracksTags),
      readsSurfaces_(options.readsSurfaces),
      library_(makeLibrary(options, gl_.info)),
      timer_(options.passTiming, &gl_.info),
      frames_(library_, gl_.info, testHook_),
      luma_(library_, gl_.info, testHook_),
      renderer_(library_, options.scene),
      bufferViewer_(library_),
      style_(styles::makeStyle(options.style, library_,
                               options.scene.models.empty() ? styles::SceneContents::kCameraOnly
                                                            : styles::SceneContents::kModels)),
      defaults_(style_->parameters()),
      imageMotion_({.isMounted = options.isCameraMounted}),
      light_(makeLightEstimator(options)) {
  hal::orThrow(tracking::checkTagFamily(scene_.tagFamily));
  if (options.overlay) {
    overlay_.emplace(library_, scene_, options.machine, pictureSize_, options.doubtfulTags);
  }
  if (style_->kind().needs.faces) faces_.emplace();
  for (const QualityPlan& plan : qualityPlans()) {
    if (levels_.empty() || options.qualityLevels) levels_.push_back({sizeAt(pictureSize_, plan)});
  }
  warmUp(options.expectedFormat.value_or(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = pictureSize_}));
  library_.setTimer(&timer_);
  library_.setCancellation(nullptr);
}

/// Paints a blank frame at each level, untimed, so that every program for the expected format is
/// compiled and drawn once and every buffer is allocated (docs/gpu.md, rule 14). Conversions of
/// other layouts are linked, but a driver may finish them at their first frame. Read-backs warm up
/// when they are opened.
void FramePipeline::warmUp(const hal::FrameFormat& expected) {
  hal::orThrow(gpu::checkDeviceLimit(gl_.info, expected.size, "frame size"));
  const hal::Image blank(expected);
  for (const Level& level : levels_) {
    library_.throwIfCancelled();
    warmUp(level, blank);
  }
  style_->reset();
  renderer_.reset();  // the blank frames are no history
}

void FramePipeline::warmUp(const Level& level, const hal::Image& blank) {
  const gpu::Texture& camera =
      frames_.uploader().upload(blank.view(), level.size, fitTo(level, blank.size()));
  renderer_.warmUp(level.size);
  // As every frame, so that a style makes what it needs for the scene's models.
  scene::ArFrame frame =
      renderer_.compose(camera, scene::assumedCamera(level.size), scene::PoseSet{}, 0,
                        hal::TimePoint{}, {.surfaces = style_->needs().surfaces});
  frame.fullSize = pictureSize_;
  style_->paint(frame, {});
}

hal::Result<void> FramePipeline::checkQuality(std::size_t quality) const {
  if (quality < levels_.size()) return {};
  std::vector<std::string> numbers;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    numbers.push_back(std::to_string(i) + " (" + std::string(qualityPlans()[i].name) + ")");
  }
  const bool wasLeftOut = quality < qualityPlans().size();
  return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                                   .subject = "quality " + std::to_string(quality),
                                   .problem = wasLeftOut
                                                  ? "this painter was made without quality levels"
                                                  : "there is no such level",
                                   .remedy = "choose one of: " + config::listText(numbers)});
}

/// Prepares for frames of this size. An error, if the scene's calibration is for another size,
/// changes nothing.
hal::Result<void> FramePipeline::adaptTo(hal::FrameSize frameSize) {
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
  const tracking::CameraModel fitted = scene::fittedCamera(camera, pictureSize_);
  fullCamera_ = fitted;
  for (Level& level : levels_) {
    level.camera = fitted.resampled(pixelsOfFull(level), glm::dvec2(0.0), level.size);
  }
  frameSize_ = frameSize;
  return {};
}

/// Px of a level's picture for each px of the full picture.
glm::dvec2 FramePipeline::pixelsOfFull(const Level& level) const {
  return glm::dvec2(level.size.width, level.size.height) /
         glm::dvec2(pictureSize_.width, pictureSize_.height);
}

/// All levels show the same part of a frame, to the fraction of a pixel.
gpu::AspectFill FramePipeline::fitTo(const Level& level, hal::FrameSize frameSize) const {
  return gpu::aspectFill(frameSize, pictureSize_).withPixels(glm::dvec2(1.0), pixelsOfFull(level));
}

hal::Result<Picture> FramePipeline::paint(const hal::CapturedFrame& frame,
                                          const PaintParameters& parameters) {
  if (auto valid = resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  try {
    hal::Result<Picture> painted = paintChecked(frame, parameters);
    if (!painted) forgetSurfaces();
    return painted;
  } catch (const hal::Failure& error) {  // not enough memory for a new size or layout
    forgetSurfaces();
    return tl::unexpected(orLoss(error.error()));
  }
}

/// The picture for which they were given was not painted.
void FramePipeline::forgetSurfaces() {
  for (auto& [number, readback] : readbacks_) readback.next.reset();
}

hal::Error FramePipeline::orLoss(const hal::Error& error) {
  if (error.kind == hal::ErrorKind::kDeviceLost) resetMonitor_.note(error);
  const auto valid = resetMonitor_.check();
  return valid ? error : valid.error();
}

/// Checks that the frame can be painted, and prepares for its size.
hal::Result<void> FramePipeline::checkFrame(const hal::CapturedFrame& frame,
                                            const PaintParameters& parameters) {
  if (auto known = checkDebugView(style_->kind().name, parameters.view); !known) return known;
  if (auto known = checkQuality(parameters.quality); !known) return known;
  if (auto fits = gpu::checkDeviceLimit(gl_.info, frame.image.format.size, "frame"); !fits) {
    return fits;
  }
  if (auto ready = style_->prepare(parameters.style); !ready) return ready;
  return adaptTo(frame.image.format.size);
}

hal::Result<Picture> FramePipeline::paintChecked(const hal::CapturedFrame& frame,
                                                 const PaintParameters& parameters) {
  if (auto valid = checkFrame(frame, parameters); !valid) {
    return tl::unexpected(std::move(valid.error()));
  }
  style_->setParameters(parameters.style);
  timer_.beginFrame();
  tracking::TrackingResult tracked;
  const scene::ArFrameNeeds needs = needsOf(parameters.view);
  const Level& level = levels_[parameters.quality];
  {
    const auto scope = timer_.measure("camera picture");
    camera_ = &frames_.show(frame, level.size, fitTo(level, frame.image.format.size));
  }
  const std::optional<hal::FrameMapping> mapped = takeLuma(frame, needs);
  const tracking::ImageMotion* const motion = measureMotion(frame.sequence, needs);
  if (motion != nullptr && motion->isCut) forgetPast();
  if (tracker_) tracked = tracker_->track(luma_.luma(), frame.captureTime);
  takeOverlay(parameters);
  const scene::ArFrame composed = compose(frame, tracked, level, needs, motion);
  composed_ = composed.colour;
  picture_ = &paintView(composed, parameters);
  const bool hasOverlay = overlay_ && overlay_->hasContent() && parameters.view.empty();
  if (hasOverlay) drawOverlay(composed, tracked);
  submitReadbacks(frame);
  glFlush();  // the GPU works on while the next frame is tracked
  return Picture{.texture = picture_->name(),
                 .size = picture_->size(),
                 .sequence = frame.sequence,
                 .captureTime = frame.captureTime,
                 .tracking = tracked,
                 .quality = parameters.quality,
                 .overlay = hasOverlay ? std::optional(overlay_->state()) : std::nullopt};
}

/// Takes another overlay before the models are drawn, because it says which parts are there.
void FramePipeline::takeOverlay(const PaintParameters& parameters) {
  if (!overlay_ || !overlay_->take(parameters.overlay)) return;
  if (overlay_->machine()) renderer_.hideParts(*overlay_->machine(), overlay_->hiddenParts());
}

/// Whether a tag was seen in this frame that places the machine: its own, or one of the world.
bool FramePipeline::isMachineSeen(const tracking::TrackingResult& tracked) const {
  if (!overlay_->machine()) return false;
  const std::optional<int>& id = scene_.models[*overlay_->machine()].tagId;
  const bool isOwnSeen =
      id && std::ranges::any_of(tracked.tags, [&](const auto& tag) {
        return tag.id == *id && tag.source == tracking::PoseSource::kSeen && tag.cameraFromTag;
      });
  if (isOwnSeen) return true;
  const bool isInWorld = !id || scene_.findTag(*id)->worldFromTag;
  return isInWorld && tracked.cameraFromWorld && tracked.worldSource == tracking::PoseSource::kSeen;
}

void FramePipeline::drawOverlay(const scene::ArFrame& frame,
                                const tracking::TrackingResult& tracked) {
  const auto scope = timer_.measure("overlay");
  const std::optional<std::size_t> machine = overlay_->machine();
  std::array<int, overlay::OtherMachine::kMostNeighbours> unknown{};
  std::size_t count = 0;
  for (const tracking::TrackedTag& tag : tracked.tags) {
    if (count < unknown.size() && scene_.findTag(tag.id) == nullptr) unknown.at(count++) = tag.id;
  }
  picture_ = &overlay_->draw({.painted = picture_,
                              .ar = &frame,
                              .camera = &*fullCamera_,
                              .machine = machine ? renderer_.placeOf(*machine) : std::nullopt,
                              .isMachineSeen = isMachineSeen(tracked),
                              .unknownTags = std::span(unknown).first(count),
                              .tracked = &tracked});
}

/// Luma for the trackers, if any is at work. Tags are found in the whole frame.
std::optional<hal::FrameMapping> FramePipeline::takeLuma(const hal::CapturedFrame& frame,
                                                         scene::ArFrameNeeds needs) {
  if (tracker_ || needs.canvas || needs.measuredMotion) {
    return luma_.take(frame, frames_, tracker_.has_value());
  }
  luma_.skip();
  return std::nullopt;
}

scene::ArFrameNeeds FramePipeline::needsOf(const std::string& view) const {
  const scene::BufferView* buffer = scene::findBufferView(view);
  scene::ArFrameNeeds needs = style_->needs();
  needs.surfaces =
      needs.surfaces || readsSurfaces_ || (buffer != nullptr && buffer->needs.surfaces);
  return needs;
}

scene::ArFrame FramePipeline::compose(const hal::CapturedFrame& frame,
                                      const tracking::TrackingResult& tracked, const Level& level,
                                      scene::ArFrameNeeds needs,
                                      const tracking::ImageMotion* motion) {
  sightings_.clear();
  for (const tracking::TrackedTag& tag : tracked.tags) {
    if (tag.cameraFromTag) sightings_.push_back({tag.id, *tag.cameraFromTag, tag.covariance});
  }
  std::span<const scene::PlaceLighting> lights;
  if (light_) {
    light_->follow(frame.image.map().view(), tracked, frame.captureTime);
    lights = light_->lights();
  }
  scene::ArFrame composed = renderer_.compose(*camera_, *level.camera,
                                              {.cameraFromWorld = tracked.cameraFromWorld,
                                               .worldCovariance = tracked.worldCovariance,
                                               .tags = sightings_},
                                              frame.sequence, frame.captureTime, needs, lights);
  composed.fullSize = pictureSize_;
  if (motion != nullptr) addMotion(*motion, needs, composed);
  if (motion != nullptr && needs.segments) {
    addSegments(frame.image.map().view(), *motion, composed);
  } else {
    segmenter_.reset();
  }
  if (motion != nullptr && needs.faces) {
    addFaces(frame.captureTime, motion->isCut, composed);
  } else if (faces_) {
    faces_->reset();
  }
  return composed;
}

/// Measures motion in the captured frame; null if the style needs none.
const tracking::ImageMotion* FramePipeline::measureMotion(std::uint64_t sequence,
                                                          scene::ArFrameNeeds needs) {
  if (!needs.canvas && !needs.measuredMotion) return nullptr;
  const auto scope = timer_.measure("follow picture");
  return &imageMotion_.follow(luma_.luma(), sequence);
}

/// Adds the motion of the camera image, and the canvas' motion in px of the full picture.
void FramePipeline::addMotion(const tracking::ImageMotion& motion, scene::ArFrameNeeds needs,
                              scene::ArFrame& composed) {
  const gpu::AspectFill fit = gpu::aspectFill(motion.frameSize, pictureSize_);
  if (needs.measuredMotion) {
    composed.measuredMotion = scene::MeasuredMotion{
        .motion = &motion, .frameScale = fit.scale, .frameOrigin = fit.origin};
  }
  if (!needs.canvas) return;
  const tracking::PlaneSimilarity frameFromPicture{{fit.scale.x, 0.0}, fit.origin};
  const tracking::PlaneSimilarity& moved = motion_.follow(motion);
  composed.canvasFromPicture = frameFromPicture.inverse() * moved * frameFromPicture;
}

/// Adds the segments of the camera image.
void FramePipeline::addSegments(const hal::ImageView& image, const tracking::ImageMotion& motion,
                                scene::ArFrame& composed) {
  const auto scope = timer_.measure("segment picture");
  const gpu::AspectFill fit = gpu::aspectFill(image.format.size, pictureSize_);
  composed.measuredSegments = scene::MeasuredSegments{.segments = &segmenter_.follow(image, motion),
                                                      .frameScale = fit.scale,
                                                      .frameOrigin = fit.origin};
}

/// Adds the faces in the camera image.
void FramePipeline::addFaces(hal::TimePoint captureTime, bool isCut, scene::ArFrame& composed) {
  const auto scope = timer_.measure("find faces");
  const gpu::AspectFill fit = gpu::aspectFill(luma_.luma().size(), pictureSize_);
  composed.measuredFaces =
      scene::MeasuredFaces{.faces = faces_->follow(luma_.luma(), captureTime, isCut),
                           .frameScale = fit.scale,
                           .frameOrigin = fit.origin};
}

/// Discards all that earlier frames have left, but for the estimator of image motion, which
/// discards its own at a cut.
void FramePipeline::forgetPast() {
  style_->reset();
  renderer_.reset();
  motion_.reset();
  if (light_) light_->reset();
  if (tracker_) tracker_->reset();
  if (overlay_) overlay_->reset();
}

const gpu::Texture& FramePipeline::paintView(const scene::ArFrame& frame,
                                             const PaintParameters& parameters) {
  const std::string_view view = parameters.view;
  // The style paints for every view, so that its history does not depend on the view.
  const gpu::Texture& painted =
      style_->paint(frame, isEngineView(view) ? std::string_view{} : view);
  if (view == kCameraView) return *camera_;
  if (const scene::BufferView* buffer = scene::findBufferView(view)) {
    return bufferViewer_.show(*buffer, frame);
  }
  return view == kArView ? *frame.colour : painted;
}

/// Submits the picture to each read-back that has room; the others skip it.
void FramePipeline::submitReadbacks(const hal::CapturedFrame& frame) {
  const auto scope = timer_.measure("read back");
  for (auto& [id, readback] : readbacks_) {
    readback.submit(*picture_, pictureSize_,
                    {frame.sequence, frame.captureTime, paintings_, std::nullopt});
  }
  ++paintings_;
}

/// Copies a read-back's oldest output frame with `copy`, Readback::poll() or Readback::wait().
hal::Answer FramePipeline::copyOldest(int number, OutputFrame& frame,
                                      hal::Answer (present::Readback::*copy)(hal::Image&),
                                      bool waits) {
  if (resetMonitor_.loss()) return tl::unexpected(*resetMonitor_.loss());
  frames_.releaseRead();
  OpenReadback& readback = readbacks_.at(number);
  const hal::Answer copied =
      readback.take(frame, copy, waits ? testHook_.patience : hal::Duration::zero());
  if (copied.hasError()) return tl::unexpected(orLoss(copied.error()));
  if (!copied.isYes()) return false;
  frames_.releaseRead();
  frame.sequence = readback.inFlight.front().sequence;
  frame.captureTime = readback.inFlight.front().captureTime;
  readback.inFlight.erase(readback.inFlight.begin());
  return true;
}

hal::Result<hal::Image> FramePipeline::read(const gpu::Texture* texture) {
  if (auto valid = resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  assert(texture != nullptr);
  try {
    const hal::FrameFormat format{.pixelFormat = hal::PixelFormat::kRgb8, .size = pictureSize_};
    if (!snapshots_) snapshots_.emplace(library_, format, 1, testHook_);
    snapshots_->submit(*texture, pictureSize_);
    hal::Image image;
    hal::orThrow(snapshots_->wait(image));
    return image;
  } catch (const hal::Failure& error) {
    return tl::unexpected(orLoss(error.error()));
  }
}

}  // namespace pleinair

#include "firmware_app/live/screens/waiting_state.h"

namespace pleinair::app {
namespace {

bool hasEnded(const runtime::CaptureStage::Status& camera) {
  return camera.hasEnded || camera.state == hal::CameraState::kEnded;
}

Awaited awaitedBy(const LiveProgress& progress) {
  const runtime::CaptureStage::Status& camera = progress.camera;
  if (hasEnded(camera)) return Awaited::kNothing;
  if (!camera.format) return Awaited::kCamera;
  if (!progress.hasBegun) return Awaited::kPainter;
  if (camera.state != hal::CameraState::kStreaming) return Awaited::kCameraAgain;
  if (progress.hasPainter) return Awaited::kNothing;
  return progress.isRenewing ? Awaited::kPainter : Awaited::kGpu;
}

std::string nameOf(const runtime::CaptureStage::Status& camera, const std::string& choice) {
  if (!camera.camera) return choice;
  const hal::CameraIdentity& identity = *camera.camera;
  return identity.description.empty() ? identity.id : identity.description;
}

/// The camera that is waited for, or why there is none.
std::string absenceOf(const runtime::CaptureStage::Status& camera, const std::string& choice) {
  if (!camera.cause) return nameOf(camera, choice);
  const hal::Error& cause = *camera.cause;
  return cause.subject.empty() ? cause.problem : cause.subject + ": " + cause.problem;
}

}  // namespace

void WaitingState::update(const LiveProgress& progress, hal::TimePoint now) {
  const Awaited next = awaitedBy(progress);
  const runtime::CaptureStage::Status& camera = progress.camera;
  const bool hasChanged = next != awaited_ || progress.painted != painted_;
  if (hasChanged) arrived_ = camera.arrived;
  const bool isTriggered = camera.format && camera.format->isTriggered;
  if (hasChanged || (isTriggered && camera.arrived == arrived_)) since_ = now;
  awaited_ = next;
  painted_ = progress.painted;
  isOver_ = hasEnded(progress.camera);
}

Awaited WaitingState::awaited(hal::TimePoint now) const {
  const bool isTooSlow = awaited_ == Awaited::kNothing && !isOver_ && now - since_ > kTooSlow;
  return isTooSlow ? Awaited::kPace : awaited_;
}

present::WaitingText waitingText(Awaited awaited, const runtime::CaptureStage::Status& camera,
                                 const std::string& choice) {
  switch (awaited) {
    case Awaited::kNothing:
      break;
    case Awaited::kCamera:
      return {.title = "Waiting for the camera", .detail = absenceOf(camera, choice)};
    case Awaited::kPainter:
      return {.title = "Preparing to paint", .detail = nameOf(camera, choice)};
    case Awaited::kCameraAgain:
      return {.title = "Waiting for the camera to come back", .detail = nameOf(camera, choice)};
    case Awaited::kGpu:
      return {.title = "Waiting for the graphics processor",
              .detail = "it was lost and is started again"};
    case Awaited::kPace:
      return {.title = "The next painting takes a while",
              .detail = "the computer is too slow for this style or size"};
  }
  return {};
}

}  // namespace pleinair::app

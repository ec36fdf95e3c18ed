#include "hal/cameras/v4l2/v4l2_camera.h"

#include <cassert>
#include <utility>

#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/session.h"

namespace pleinair::hal::v4l2 {

V4l2Camera::V4l2Camera(std::string id, System system, Clock& clock)
    : system_(system),
      clock_(clock),
      identity_{.backend = "v4l2", .id = id, .description = "V4L2 camera " + id} {}

V4l2Camera::~V4l2Camera() = default;

CameraIdentity V4l2Camera::identity() const {
  return identity_;
}

Result<StreamFormat> V4l2Camera::start(const StreamRequest& request) {
  stop();
  const Result<std::string> node = findNode(system_, identity_.id);
  if (!node) return tl::unexpected(node.error());
  Result<Device> device = Device::open(system_.calls, *node);
  if (!device) return tl::unexpected(std::move(device.error()));
  identity_.description = device->capability().card + " at " + *node;
  auto session = std::make_unique<Session>(*std::move(device), request, clock_);
  Result<StreamFormat> format = session->begin();
  if (format) session_ = std::move(session);
  return format;
}

NextFrame V4l2Camera::next(TimePoint deadline) {
  assert(session_ != nullptr && "next() of a camera that does not stream");
  return session_->next(deadline);
}

void V4l2Camera::stop() {
  session_.reset();
}

}  // namespace pleinair::hal::v4l2

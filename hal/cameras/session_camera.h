#pragma once

#include <cassert>
#include <memory>
#include <string>
#include <utility>

#include "hal/camera.h"
#include "hal/printable.h"

namespace pleinair::hal {

/// A camera from start() to stop(), on one thread; its frames may be dropped on any. The destructor
/// ends it.
class CameraSession {
 public:
  virtual ~CameraSession() = default;
  CameraSession() = default;
  CameraSession(const CameraSession&) = delete;
  CameraSession& operator=(const CameraSession&) = delete;

  /// What the device calls itself.
  virtual std::string description() const = 0;
  /// Sets up and starts; once. Errors: as Camera::start().
  virtual Result<StreamFormat> begin(const StreamRequest& request) = 0;
  /// As Camera::next().
  virtual NextFrame next(TimePoint deadline) = 0;
};

/// A camera whose device a library opens by name, anew at each start.
class SessionCamera : public Camera {
 public:
  CameraIdentity identity() const final { return identity_; }

  Result<StreamFormat> start(const StreamRequest& request) final {
    stop();
    Result<std::unique_ptr<CameraSession>> session = open();
    if (!session) return tl::unexpected(named(std::move(session.error()), identity_));
    identity_.description = printable((*session)->description());
    Result<StreamFormat> format = (*session)->begin(request);
    if (!format) return tl::unexpected(named(std::move(format.error()), identity_));
    session_ = *std::move(session);
    return format;
  }
  NextFrame next(TimePoint deadline) final {
    assert(session_ != nullptr && "next() of a camera that does not stream");
    return session_->next(deadline);
  }
  void stop() final { session_.reset(); }

  /// The error with "BACKEND:ID" as its subject, unless it has one.
  static Error named(Error error, const CameraIdentity& camera) {
    if (error.subject.empty()) error.subject = camera.backend + ":" + camera.id;
    return error;
  }

 protected:
  explicit SessionCamera(CameraIdentity identity) : identity_(std::move(identity)) {}

  /// Opens the device. Errors: as Camera::start().
  virtual Result<std::unique_ptr<CameraSession>> open() = 0;

 private:
  CameraIdentity identity_;
  std::unique_ptr<CameraSession> session_;  ///< while streaming
};

}  // namespace pleinair::hal

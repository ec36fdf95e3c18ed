#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/cameras/libcamera/lc_version.h"
#include "hal/error.h"

namespace pleinair::hal::libcamera {

/// One manager a process, which is all that libcamera allows; it goes with its last user.
class Manager {
 public:
  /// Any thread. Errors: those of libcamera's start.
  static Result<std::shared_ptr<Manager>> shared();
  Manager() = default;
  ~Manager() { cameras_.stop(); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  std::vector<std::shared_ptr<lc::Camera>> cameras() const { return cameras_.cameras(); }
  std::shared_ptr<lc::Camera> get(const std::string& id) { return cameras_.get(id); }

 private:
  lc::CameraManager cameras_;
};

/// The sensor's name; may be empty.
std::string modelOf(const lc::Camera& camera);

}  // namespace pleinair::hal::libcamera

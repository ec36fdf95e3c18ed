#include "hal/cameras/libcamera/lc_manager.h"

#include <cstdlib>
#include <mutex>

#include <libcamera/property_ids.h>

namespace pleinair::hal::libcamera {
namespace {

// libcamera reads the variable when it first logs; it would log lines at every start. Whoever sets
// it sees them.
[[maybe_unused]] const int kIsQuiet =
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before main(), there is one thread
    setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);

}  // namespace

Result<std::shared_ptr<Manager>> Manager::shared() {
  static std::mutex mutex;
  static std::weak_ptr<Manager> current;
  const std::scoped_lock lock(mutex);
  if (auto manager = current.lock()) return manager;
  auto manager = std::make_shared<Manager>();
  if (const int answer = manager->cameras_.start(); answer < 0) {
    return tl::unexpected(errnoError("libcamera", "cannot start", -answer));
  }
  current = manager;
  return manager;
}

std::string modelOf(const lc::Camera& camera) {
  const auto model = camera.properties().get(lc::properties::Model);
  return model ? std::string(*model) : std::string();
}

}  // namespace pleinair::hal::libcamera

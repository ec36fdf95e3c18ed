#include "hal/cameras/synthetic/synthetic_backend.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace pleinair::hal {
namespace {

CameraDescription descriptionOf(std::string_view shot, const SyntheticOptions& options) {
  return {.identity = {.backend = "synthetic",
                       .id = std::string(shot),
                       .description = "simulated camera before a workbench"},
          .serial = {},
          .node = {},
          .modes = {{.layout = "RGB3", .size = options.size, .periods = {options.framePeriod}}},
          .problem = {}};
}

/// A shot that there is not.
class NoShot final : public Camera {
 public:
  explicit NoShot(Error error) : error_(std::move(error)) {}

  CameraIdentity identity() const override {
    return {.backend = "synthetic", .id = error_.subject, .description = error_.problem};
  }
  Result<StreamFormat> start(const StreamRequest&) override { return tl::unexpected(error_); }
  NextFrame next(TimePoint) override { return error_; }
  void stop() override {}

 private:
  Error error_;
};

}  // namespace

Result<std::vector<CameraDescription>> SyntheticBackend::list() {
  std::vector<CameraDescription> cameras;
  const std::string_view first = toString(options_.shot);
  for (const std::string_view shot : syntheticShots()) {
    cameras.push_back(descriptionOf(shot, options_));
    if (shot == first) std::rotate(cameras.begin(), std::prev(cameras.end()), cameras.end());
  }
  return cameras;
}

std::unique_ptr<Camera> SyntheticBackend::make(const std::string& id, Clock& clock) {
  const std::optional<SyntheticShot> shot = syntheticShotNamed(id);
  if (!shot) {
    return std::make_unique<NoShot>(
        Error{.kind = ErrorKind::kInvalidArgument,
              .subject = "synthetic:" + id,
              .problem = "the synthetic camera has no shot \"" + id + "\"",
              .remedy = "allowed: " + syntheticShotNames()});
  }
  SyntheticOptions options = options_;
  options.shot = *shot;
  return std::make_unique<SyntheticCamera>(options, clock);
}

}  // namespace pleinair::hal

#include "hal/cameras/synthetic/open_synthetic.h"

#include <string>

namespace pleinair::hal {

Result<std::optional<SyntheticShot>> syntheticShotOf(std::string_view camera,
                                                     std::string_view subject) {
  constexpr std::string_view kName = "synthetic";
  if (camera == kName) return SyntheticShot::kWalkaround;
  if (!camera.starts_with(std::string(kName) + ":")) return std::nullopt;
  const std::string_view name = camera.substr(kName.size() + 1);
  const std::optional<SyntheticShot> shot = syntheticShotNamed(name);
  if (shot) return shot;
  return tl::unexpected(
      Error{.kind = ErrorKind::kInvalidArgument,
            .subject = std::string(subject),
            .problem = "the synthetic camera has no shot \"" + std::string(name) + "\"",
            .remedy = "allowed: " + syntheticShotNames()});
}

}  // namespace pleinair::hal

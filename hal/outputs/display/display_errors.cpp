#include "hal/outputs/display/display_errors.h"

#include <utility>

#include "hal/outputs/display/card_users.h"

namespace pleinair::hal::display {

Error noCard(std::string subject) {
  return {.kind = ErrorKind::kNotFound,
          .subject = std::move(subject),
          .problem = "there is no graphics card (/dev/dri/card*)",
          .remedy = "load its driver; `pleinair doctor` says more"};
}

Error notMaster(const std::string& node, std::string subject) {
  const std::string users = usersText(node);
  return {.kind = ErrorKind::kBusy,
          .subject = std::move(subject),
          .problem = "another program shows pictures there" + (users.empty() ? "" : ": " + users),
          .remedy = "end it, or use a window on its desktop"};
}

}  // namespace pleinair::hal::display

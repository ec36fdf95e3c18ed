#include "firmware_app/config/reload.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration_sections.h"
#include "firmware_app/config/configured_parts.h"
#include "hal/error.h"

namespace pleinair::app {
namespace {

/// Keys that choose among the parameters of the style, and what of it is shown.
bool isOfStyle(const std::string& key) {
  return key == "painting.look" || key == "painting.view" || key.starts_with("style.");
}

/// `next`, but what needs a start has the value of `started`, and is named in `later`.
config::ParameterValues liveValues(const config::ParameterValues& started,
                                   config::ParameterValues next, const std::string& section,
                                   std::vector<std::string>& later) {
  const auto descriptors = started.list().descriptors();
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    const bool isLive = descriptors[i].takesEffect == config::TakesEffect::kLive;
    if (isLive || next.at(i) == started.at(i)) continue;
    later.push_back(section + "." + descriptors[i].name);
    next = next.with(i, started.at(i), started.origin(descriptors[i].name));
  }
  return next;
}

}  // namespace

Reload reloaded(const ConfigurationRequest& request, const Configuration& started,
                const PaintingOptions& painting) {
  const Configuration next(request);
  return next.attributing([&] {
    const PaintingOptions checked = configuredPainting(next, painting);
    Reload reload{.painting = painting, .later = {}};
    for (const std::string& key : next.keysUnlike(started)) {
      // A profile has its effect through other keys.
      if (key != "profile" && !isOfStyle(key)) reload.later.push_back(key);
    }
    if (std::ranges::find(reload.later, kStyleKey) != reload.later.end()) return reload;
    startParameters(checked);  // refuses an unknown view
    reload.painting.view = checked.view;
    reload.painting.parameters = liveValues(started.styleParameters(), next.styleParameters(),
                                            "style." + started.painting().style, reload.later);
    return reload;
  });
}

ReloadOutcome outcomeOf(const std::function<Reload()>& read) {
  std::string problem;
  try {
    Reload next = read();
    startParameters(next.painting);
    const std::string later =
        next.later.empty() ? ""
                           : fmt::format("; at the next start: {}", fmt::join(next.later, ", "));
    return {.painting = std::move(next.painting),
            .notice = "the configuration was read again" + later};
  } catch (const hal::Failure& error) {
    problem = error.what();
  } catch (const config::ConfigError& error) {
    problem = error.what();
  }
  return {.painting = {}, .notice = "the last configuration stays in force: " + problem};
}

}  // namespace pleinair::app

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "firmware_app/offline/painting.h"

namespace pleinair::app {

/// A configuration that was read again while painting goes on.
struct Reload {
  PaintingOptions painting;  ///< those in force, with new parameters, look and view of the style
  std::vector<std::string> later;  ///< keys whose new values take effect at the next start
};

/// Reads the configuration again. `started` is the one that the program started with, `painting`
/// what it made of it. Throws as Configuration and configuredPainting().
Reload reloaded(const ConfigurationRequest& request, const Configuration& started,
                const PaintingOptions& painting);

/// The outcome of a reload, as people are told.
struct ReloadOutcome {
  std::optional<PaintingOptions> painting;  ///< nothing: the last ones stay in force
  std::string notice;
};

/// Calls `read`, which may throw as reloaded() does, and checks what the painting starts with.
ReloadOutcome outcomeOf(const std::function<Reload()>& read);

}  // namespace pleinair::app

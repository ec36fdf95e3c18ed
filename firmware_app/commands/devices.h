#pragma once

namespace pleinair::app {

struct DevicesOptions {
  bool json = false;
};

/// Prints the cameras and outputs that are there, with ids and formats: `pleinair devices`.
int listDevices(const DevicesOptions& options);

}  // namespace pleinair::app
